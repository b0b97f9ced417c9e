// info.h -- parts of particls info.
#ifndef PLS_CLI_INFO_H
#define PLS_CLI_INFO_H

#include "cli.h"

enum { INFO_LINE_SIZE = 400 };

/// A series at a glance; long lines are cut.
typedef struct info_series
{
    size_t rows;
    char first[INFO_LINE_SIZE], last[INFO_LINE_SIZE];
} info_series;

/// False when the file cannot be read; the library's message says why.
bool info_read_series(const char *path, info_series *series);

bool info_has_suffix(const char *name, const char *suffix);

/// Print; return the exit code.
int info_describe_checkpoint(const char *path);
int info_describe_run(const char *directory);

#endif
