// plugin.c -- particls plugin: how to compile one's own law, shape, force or observer.

#include "cli.h"

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

/// Find the headers; false when they are not there.
static bool find_headers(char folder[PATH_MAX])
{
    char program[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) return false;
    program[length] = '\0';
    char *slash = strrchr(program, '/');
    if (!slash) return false;
    *slash = '\0';
    for (size_t k = 0; k < sizeof places / sizeof places[0]; ++k)
    {
        char header[2 * PATH_MAX];
        char candidate[PATH_MAX + 32];
        snprintf(candidate, sizeof candidate, "%s/%s", program, places[k]);
        snprintf(header, sizeof header, "%s/particls/plugin.h", candidate);
        if (access(header, R_OK) == 0 && realpath(candidate, folder)) return true;
    }
    return false;
}

static int print_cflags(void)
{
    char folder[PATH_MAX];
    if (!find_headers(folder))
    {
        fprintf(stderr, "particls: the headers of particls are not installed beside the program: install particls with its headers\n");
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
