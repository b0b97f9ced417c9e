// main.c -- the program: a table of verbs.

#include "cli.h"

#include "base/registry.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

static const cli_verb *const verbs[] = {&cli_run, &cli_resume, &cli_check, &cli_info, &cli_render, &cli_schema, &cli_plugin};

enum { VERB_COUNT = sizeof verbs / sizeof verbs[0] };

static void print_usage(FILE *stream)
{
    fprintf(stream, "particls %s -- particle simulation with signed distance functions\n\nusage: particls VERB [OPTIONS] ...\n\n",
            PLS_VERSION_TEXT);
    for (int k = 0; k < VERB_COUNT; ++k)
    {
        char call[64];
        snprintf(call, sizeof call, "%s %s", verbs[k]->name, verbs[k]->arguments);
        fprintf(stream, "  %-18s %s\n", call, verbs[k]->summary);
    }
    fprintf(stream, "  %-18s %s\n  %-18s %s\n", "version", "print the version", "help [VERB]", "print this, or the help of a verb");
    fprintf(stream, "\nEvery verb has --help. Exit status: 0 done, 1 the run failed, 2 wrong usage or a wrong scene.\n");
}

static const cli_verb *find_verb(const char *name)
{
    for (int k = 0; k < VERB_COUNT; ++k)
    {
        if (strcmp(verbs[k]->name, name) == 0) return verbs[k];
    }
    return NULL;
}

static int fail_verb(const char *name)
{
    const char *names[VERB_COUNT + 2] = {[VERB_COUNT] = "version", [VERB_COUNT + 1] = "help"};
    for (int k = 0; k < VERB_COUNT; ++k) names[k] = verbs[k]->name;
    const char *near = pls_nearest_word(name, names, VERB_COUNT + 2);
    fprintf(stderr, "particls: there is no verb '%s'", name);
    if (near)
        fprintf(stderr, "; did you mean '%s'?\n", near);
    else
        fprintf(stderr, "; particls --help lists them\n");
    return CLI_USAGE;
}

static int print_help(int argc, char **argv)
{
    if (argc < 3)
    {
        print_usage(stdout);
        return CLI_DONE;
    }
    const cli_verb *verb = find_verb(argv[2]);
    if (!verb) return fail_verb(argv[2]);
    cli_print_help(verb);
    return CLI_DONE;
}

static bool is_one_of(const char *text, const char *a, const char *b, const char *c)
{
    return strcmp(text, a) == 0 || strcmp(text, b) == 0 || strcmp(text, c) == 0;
}

int main(int argc, char **argv)
{
    // A file size limit and a closed pipe then are failures of a write, which are handled, and not the end of the program.
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    if (argc < 2)
    {
        print_usage(stderr);
        return CLI_USAGE;
    }
    if (is_one_of(argv[1], "help", "--help", "-h")) return print_help(argc, argv);
    if (is_one_of(argv[1], "version", "--version", "-V"))
    {
        printf("particls %s\n", PLS_VERSION_TEXT);
        return CLI_DONE;
    }
    const cli_verb *verb = find_verb(argv[1]);
    return verb ? verb->function(argc - 1, argv + 1) : fail_verb(argv[1]);
}
