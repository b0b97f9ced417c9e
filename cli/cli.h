// cli.h -- what the verbs of the program share: options described once, messages, exit codes.
#ifndef PLS_CLI_CLI_H
#define PLS_CLI_CLI_H

#include <particls/particls.h>

/// Exit codes of the program.
enum {
    CLI_DONE = 0,
    CLI_FAILED = 1, ///< the run failed (physics, I/O, interrupted)
    CLI_USAGE = 2   ///< wrong usage or a wrong scene
};

/// One option. Tables end with a null name.
typedef struct cli_option
{
    const char *name;     ///< long form, without dashes
    char letter;          ///< short form, 0: none
    const char *argument; ///< "DIR", null when it takes none
    const char *meaning;  ///< with the default
} cli_option;

/// One verb: all that its --help prints, and its function. `argv[0]` is the verb.
typedef struct cli_verb
{
    const char *name;
    const char *arguments; ///< "SCENE"
    const char *summary;   ///< one line
    const char *about;     ///< a paragraph
    const char *example;
    const cli_option *options;
    int (*function)(int argc, char **argv);
} cli_verb;

extern const cli_verb cli_run, cli_resume, cli_check, cli_info, cli_render, cli_schema, cli_plugin;

/// What cli_next_option returns besides the index of an option.
enum {
    CLI_NO_MORE = -1, ///< the other arguments are argv[optind]...
    CLI_HELP = -2,    ///< help was asked for and printed
    CLI_WRONG = -3    ///< the mistake was told
};

/// Read the next option of the verb; `*value` is its argument.
int cli_next_option(const cli_verb *verb, int argc, char **argv, const char **value);

void cli_print_help(const cli_verb *verb);

/// "particls run: ..." to the standard error; returns CLI_USAGE.
int cli_wrong_usage(const cli_verb *verb, const char *format, ...) __attribute__((format(printf, 2, 3)));
/// The library's last message to the standard error; returns `code`.
int cli_failed(int code);

/// Of a failure: CLI_USAGE where the user can mend the scene or the command, else CLI_FAILED.
int cli_code_of(pls_status status);

/// The one argument that is not an option; null when there is none or more, which is then told. `what` names it.
const char *cli_only_argument(const cli_verb *verb, int argc, char **argv, const char *what);

/// Use as many threads as `text` says. False when it is no such number, which is then told.
bool cli_set_threads(const cli_verb *verb, const char *text);

/// Read a time; false when it is none, which is then told.
bool cli_read_time(const cli_verb *verb, const char *option, const char *text, double *time);

/// "1.2 GB"
const char *cli_bytes(char text[32], double bytes);
/// "1:02:03" or "4.2 s"
const char *cli_duration(char text[32], double seconds);

#endif
