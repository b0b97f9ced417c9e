// schema.c -- particls schema: the form of scene files, for editors and for the docs.

#include "cli.h"

#include <getopt.h>
#include <stdio.h>

enum { REFERENCE };

static const cli_option options[] = {
    [REFERENCE] = {"reference", 'r', NULL, "print the reference page docs/scene.md instead"},
    {0},
};

static int run(int argc, char **argv)
{
    bool reference = false;
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_schema, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
        if (option == REFERENCE) reference = true;
    }
    if (optind < argc) return cli_wrong_usage(&cli_schema, "no argument is expected, but there is '%s'", argv[optind]);
    char *text = NULL;
    if ((reference ? pls_scene_reference(&text) : pls_scene_json_schema(&text)) != PLS_OK) return cli_failed(CLI_FAILED);
    bool written = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    pls_scene_free_text(text);
    if (written) return CLI_DONE;
    perror("particls schema");
    return CLI_FAILED;
}

const cli_verb cli_schema = {
    .name = "schema",
    .arguments = "",
    .summary = "print the JSON Schema of scene files",
    .about = "Prints the JSON Schema (draft 2020-12) of scene files; editors complete and check scenes with it.",
    .example = "  particls schema > scene.schema.json",
    .options = options,
    .function = run,
};
