// schema.c -- particls schema: the form of scene files, for editors and for the docs.

#include "cli.h"

#include <getopt.h>
#include <stdio.h>

enum { REFERENCE, FIELDS };

static const cli_option options[] = {
    [REFERENCE] = {"reference", 'r', NULL, "print the reference page docs/scene.md instead"},
    [FIELDS] = {"fields", 'f', NULL, "print the tables of fields docs/fields.md instead"},
    {0},
};

static const char *const type_names[] = {
    [PLS_F64] = "float64", [PLS_F32] = "float32", [PLS_U32] = "uint32", [PLS_U16] = "uint16", [PLS_U8] = "uint8"};

static void print_fields_of(pls_table_kind table)
{
    size_t count;
    const pls_field *field = pls_fields(table, &count);
    printf("\n## %s\n\n| field | type | unit | kept | frames | meaning |\n|---|---|---|---|---|---|\n", pls_table_name(table));
    for (size_t k = 0; k < count; ++k)
    {
        printf("| `%s` | %s", field[k].name, type_names[field[k].type]);
        if (field[k].components > 1) printf(" x %d", field[k].components);
        printf(" | %s | %s | %s | %s |\n", field[k].unit, field[k].flags & PLS_FIELD_PERSISTS ? "yes" : "no",
               field[k].flags & PLS_FIELD_FRAME    ? "yes"
               : field[k].flags & PLS_FIELD_BONDED ? "with bonds"
                                                   : "",
               field[k].meaning);
    }
}

static bool print_fields(void)
{
    printf("# Fields\n\n"
           "This page is made by the program (`particls schema --fields`) from the tables that checkpoints, frames and observers use.\n\n"
           "*kept*: lives from step to step, so it is in checkpoints and in the state hash. *frames*: written to frames without being "
           "asked for; other body\n"
           "fields are named in `fields` of a frames observer. Particle observers take the names of body fields as `quantities`.\n");
    for (int table = 0; table < PLS_TABLE_COUNT; ++table) print_fields_of((pls_table_kind)table);
    return fflush(stdout) == 0 && !ferror(stdout);
}

static bool print_text(char *text)
{
    bool written = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    pls_scene_free_text(text);
    return written;
}

static int run(int argc, char **argv)
{
    bool reference = false, fields = false;
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_schema, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
        if (option == REFERENCE) reference = true;
        if (option == FIELDS) fields = true;
    }
    if (optind < argc) return cli_wrong_usage(&cli_schema, "no argument is expected, but there is '%s'", argv[optind]);
    if (reference && fields) return cli_wrong_usage(&cli_schema, "--reference and --fields exclude each other");
    char *text = NULL;
    if (!fields && (reference ? pls_scene_reference(&text) : pls_scene_json_schema(&text)) != PLS_OK) return cli_failed(CLI_FAILED);
    if (fields ? print_fields() : print_text(text)) return CLI_DONE;
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
