// plugin.c -- particls plugin: how to compile one's own law, shape, force or observer.

#include "cli.h"

#include <particls/types.h>

#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CFLAGS };

static const cli_option options[] = {
    [CFLAGS] = {"cflags", 0, NULL, "print the options for the compiler"},
    {0},
};

/// Where the public headers are, seen from the folder of the program: when installed, and in build trees.
static const char *const places[] = {"../include", "../../include", "../../../include"};
enum { PLACES = sizeof places / sizeof places[0], API_NOT_TOLD = -1 };

/// The folder of the program itself, links followed; false when the system does not say.
static bool find_program(char folder[PATH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (length <= 0) return false;
    folder[length] = '\0';
    char *slash = strrchr(folder, '/');
    if (slash) *slash = '\0';
    return slash != NULL;
}

/// The API that the headers in a folder are of.
static int api_of(const char *folder)
{
    char path[PATH_MAX + 64], line[256];
    int api = API_NOT_TOLD;
    snprintf(path, sizeof path, "%s/particls/types.h", folder);
    FILE *file = fopen(path, "r");
    while (file && api == API_NOT_TOLD && fgets(line, sizeof line, file))
        if (sscanf(line, "#define PLS_API_VERSION %d", &api) != 1) api = API_NOT_TOLD;
    if (file) fclose(file);
    return api;
}

/// Without the dots where the folder is there, else as it was sought.
static void tell_place(const char *program, const char *place, char folder[2 * PATH_MAX])
{
    char sought[2 * PATH_MAX], found[PATH_MAX];
    snprintf(sought, sizeof sought, "%s/%s", program, place);
    snprintf(folder, 2 * PATH_MAX, "%s", realpath(sought, found) ? found : sought);
}

static int no_headers(const char *program)
{
    fprintf(stderr, "particls: the headers for plugins are not where this program, in %s, looks for them:\n", program);
    for (size_t k = 0; k < PLACES; ++k)
    {
        char folder[2 * PATH_MAX];
        tell_place(program, places[k], folder);
        const int api = api_of(folder);
        if (api == API_NOT_TOLD)
            fprintf(stderr, "  %s: there is no particls/types.h that tells an API\n", folder);
        else
            fprintf(stderr, "  %s: headers of API %d, the program has %d\n", folder, api, PLS_API_VERSION);
    }
    fprintf(stderr,
            "A copy of the program does not find them. Run it from its build tree or from where `make install PREFIX=...` put it, through "
            "PATH or a symbolic link\n");
    return CLI_FAILED;
}

static int print_cflags(void)
{
    char program[PATH_MAX], folder[2 * PATH_MAX] = "";
    if (!find_program(program))
    {
        fprintf(stderr,
                "particls: the headers for plugins are sought from the program's folder, which /proc/self/exe does not tell here\n");
        return CLI_FAILED;
    }
    bool found = false;
    for (size_t k = 0; k < PLACES && !found; ++k)
    {
        tell_place(program, places[k], folder);
        found = api_of(folder) == PLS_API_VERSION;
    }
    if (!found) return no_headers(program);
    if (strpbrk(folder, " \t\n*?["))
    {
        fprintf(stderr, "particls: the headers for plugins are in '%s', a name that a shell would take apart. Compile with\n  %s -I'%s'\n",
                folder, PLS_PLUGIN_FLAGS, folder);
        return CLI_FAILED;
    }
    // -ffp-contract=off and the like: without them results depend on the machine
    printf("%s -I%s\n", PLS_PLUGIN_FLAGS, folder);
    return CLI_DONE;
}

static int run(int argc, char **argv)
{
    bool cflags = false;
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_plugin, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
        if (option == CFLAGS) cflags = true;
    }
    if (optind < argc) return cli_wrong_usage(&cli_plugin, "no argument is expected, but there is '%s'", argv[optind]);
    return cflags ? print_cflags() : cli_wrong_usage(&cli_plugin, "say what to print: --cflags");
}

const cli_verb cli_plugin = {
    .name = "plugin",
    .arguments = "",
    .summary = "print how to compile a plugin",
    .about = "A plugin is a shared object with one's own contact laws, shapes, forces and observers, named in a scene by\n"
             "`plugins: [./my_plugin.so]`. `particls info my_plugin.so` says what it holds.",
    .example = "  cc $(particls plugin --cflags) my_plugin.c -o my_plugin.so",
    .options = options,
    .function = run,
};
