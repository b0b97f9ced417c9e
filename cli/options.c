// options.c -- reading options with getopt_long from a verb's table, its help, and small conversions.

#include "cli.h"

#include "base/registry.h"
#include "base/text.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_OPTIONS = 40,
    FIRST_VALUE = 256 ///< what getopt_long returns for option 0; beyond all characters
};

/// A verb's table, with --help, in the form of getopt_long.
typedef struct option_table
{
    struct option option[MAX_OPTIONS + 2];
    char letters[2 * MAX_OPTIONS + 4];
    int count;
} option_table;

static void make_table(const cli_verb *verb, option_table *table)
{
    *table = (option_table){0};
    char *letter = table->letters;
    *letter++ = ':'; // tell a missing argument from an unknown option
    for (const cli_option *o = verb->options; o->name && table->count < MAX_OPTIONS; ++o)
    {
        table->option[table->count] =
            (struct option){o->name, o->argument ? required_argument : no_argument, NULL, FIRST_VALUE + table->count};
        ++table->count;
        if (!o->letter) continue;
        *letter++ = o->letter;
        if (o->argument) *letter++ = ':';
    }
    *letter++ = 'h';
    table->option[table->count] = (struct option){"help", no_argument, NULL, 'h'};
}

static int index_of_letter(const cli_verb *verb, int letter)
{
    for (int k = 0; verb->options[k].name; ++k)
    {
        if (verb->options[k].letter == letter) return k;
    }
    return CLI_WRONG;
}

static int fail_unknown(const cli_verb *verb, const option_table *table, const char *word)
{
    const char *names[MAX_OPTIONS + 1];
    for (int k = 0; k <= table->count; ++k) names[k] = table->option[k].name;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, "="), word);
    const char *bare = name + strspn(name, "-");
    const char *near = strncmp(word, "--", 2) == 0 ? pls_nearest_word(bare, names, (size_t)table->count + 1) : NULL;
    if (near)
        cli_wrong_usage(verb, "there is no option '%s'; did you mean '--%s'?", name, near);
    else
        cli_wrong_usage(verb, "there is no option '%s'", name);
    return CLI_WRONG;
}

int cli_next_option(const cli_verb *verb, int argc, char **argv, const char **value)
{
    option_table table;
    make_table(verb, &table);
    opterr = 0;
    int before = optind;
    int found = getopt_long(argc, argv, table.letters, table.option, NULL);
    *value = optarg;
    if (found == -1) return CLI_NO_MORE;
    if (found == 'h')
    {
        cli_print_help(verb);
        return CLI_HELP;
    }
    if (found == ':')
    {
        cli_wrong_usage(verb, "the option '%s' needs an argument", argv[optind - 1]);
        return CLI_WRONG;
    }
    if (found == '?')
    {
        char letter[3] = {'-', (char)optopt, '\0'};
        bool short_form = optopt > 0 && optopt < FIRST_VALUE;
        return fail_unknown(verb, &table, short_form ? letter : argv[optind > before ? optind - 1 : optind]);
    }
    return found >= FIRST_VALUE ? found - FIRST_VALUE : index_of_letter(verb, found);
}

void cli_print_help(const cli_verb *verb)
{
    printf("usage: particls %s %s%s%s\n\n%s\n", verb->name, verb->arguments, *verb->arguments ? " " : "", "[OPTIONS]", verb->about);
    printf("\noptions:\n");
    for (const cli_option *o = verb->options; o->name; ++o)
    {
        char form[64];
        char letter[8] = "    ";
        if (o->letter) snprintf(letter, sizeof letter, "-%c, ", o->letter);
        snprintf(form, sizeof form, "%s--%s%s%s", letter, o->name, o->argument ? " " : "", o->argument ? o->argument : "");
        printf("  %-24s %s\n", form, o->meaning);
    }
    printf("  %-24s %s\n\nexample:\n%s\n", "-h, --help", "print this", verb->example);
}

int cli_wrong_usage(const cli_verb *verb, const char *format, ...)
{
    fprintf(stderr, "particls %s: ", verb->name);
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, "\nparticls %s --help says how it is used\n", verb->name);
    return CLI_USAGE;
}

int cli_failed(int code)
{
    fprintf(stderr, "particls: %s\n", pls_last_message());
    return code;
}

/// Failures that are the user's to mend in the scene or the command.
static bool is_wrong_input(pls_status status)
{
    switch (status)
    {
        case PLS_IO:
        case PLS_DISK_FULL:
        case PLS_OUT_OF_MEMORY:
        case PLS_CORRUPT:
        case PLS_VERSION:
        case PLS_INTERRUPTED: return false;
        default: return true;
    }
}

int cli_code_of(pls_status status) { return status == PLS_OK ? CLI_DONE : is_wrong_input(status) ? CLI_USAGE : CLI_FAILED; }

const char *cli_only_argument(const cli_verb *verb, int argc, char **argv, const char *what)
{
    if (argc - optind == 1) return argv[optind];
    if (argc == optind)
        cli_wrong_usage(verb, "%s is missing", what);
    else
        cli_wrong_usage(verb, "one %s is expected, but '%s' follows '%s'", what, argv[optind + 1], argv[optind]);
    return NULL;
}

bool cli_set_threads(const cli_verb *verb, const char *text)
{
    char *end;
    long threads = strtol(text, &end, 10);
    if (end == text || *end || threads < 1 || threads > 4096)
    {
        cli_wrong_usage(verb, "--threads takes a number from 1 to 4096, not '%s'", text);
        return false;
    }
    if (pls_set_threads((int)threads) == PLS_OK) return true;
    cli_failed(CLI_USAGE);
    return false;
}

bool cli_read_time(const cli_verb *verb, const char *option, const char *text, double *time)
{
    if (pls_parse_double(text, time) && isfinite(*time) && *time >= 0) return true;
    cli_wrong_usage(verb, "%s takes a time in seconds, not '%s'", option, text);
    return false;
}

const char *cli_bytes(char text[32], double bytes)
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 4; ++unit) bytes /= 1000;
    snprintf(text, 32, unit == 0 ? "%.0f %s" : "%.3g %s", bytes, units[unit]);
    return text;
}

const char *cli_duration(char text[32], double seconds)
{
    if (seconds < 60)
    {
        snprintf(text, 32, "%.3g s", seconds);
        return text;
    }
    double minutes = floor(fmin(seconds, 1e12) / 60);
    double hours = floor(minutes / 60);
    int rest = (int)(fmin(seconds, 1e12) - 60 * minutes);
    if (hours > 0)
        snprintf(text, 32, "%.0f:%02d:%02d h", hours, (int)(minutes - 60 * hours), rest);
    else
        snprintf(text, 32, "%.0f:%02d min", minutes, rest);
    return text;
}
