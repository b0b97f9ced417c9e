// prove.c -- the long verification campaign: runs every case of tests/verify in its long form, prints Markdown tables, writes curves for plots.
//
//     prove DIR [NAME ...]     curves go to DIR/<case>.tsv; with names only those cases
//
// Exit status 1 when a row is out of tolerance.
#include "verify/cases.h"

#include <particls/threads.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool wanted(const char *name, int count, char **names)
{
    for (int k = 0; k < count; ++k)
        if (strcmp(name, names[k]) == 0) return true;
    return count == 0;
}

static void print_rows(const verify_sheet *sheet)
{
    printf("| what | measured | reference | error | allowed | |\n|---|---:|---:|---:|---:|---|\n");
    for (int k = 0; k < sheet->row_count; ++k)
    {
        const verify_row *row = &sheet->rows[k];
        double error = row->kind == VERIFY_BELOW ? fabs(row->measured) : fabs(row->measured - row->reference);
        if (row->kind == VERIFY_RELATIVE) error /= fabs(row->reference);
        printf("| %s | %.9g | ", row->claim, row->measured);
        if (row->kind == VERIFY_BELOW)
            printf("| ");
        else
            printf("%.9g | ", row->reference);
        printf("%.1e%s | %.1e | %s |\n", error, row->kind == VERIFY_RELATIVE ? " rel." : "", row->tolerance,
               row->passed ? "yes" : "**no**");
    }
    printf("\n");
}

/// Curves one after the other, two blank lines between them: gnuplot's `index`.
static bool write_curves(const verify_sheet *sheet, const char *folder, const char *name)
{
    char path[1024];
    if (sheet->point_count == 0) return true;
    snprintf(path, sizeof path, "%s/%s.tsv", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
    {
        fprintf(stderr, "prove: cannot write %s\n", path);
        return false;
    }
    const char *curve = NULL;
    for (int k = 0; k < sheet->point_count; ++k)
    {
        const verify_point *point = &sheet->points[k];
        if (!curve || strcmp(curve, point->curve) != 0) fprintf(file, "%s# %s: x measured reference\n", curve ? "\n\n" : "", point->curve);
        curve = point->curve;
        fprintf(file, "%.10g\t%.10g\t%.10g\n", point->x, point->measured, point->reference);
    }
    return fclose(file) == 0;
}

int main(int argc, char **argv)
{
    if (argc < 2)
    {
        fprintf(stderr, "usage: prove DIR [NAME ...]\n");
        return 2;
    }
    verify_sheet *sheet = malloc(sizeof *sheet);
    int rows = 0, failed = 0;
    if (!sheet || pls_set_threads(1) != PLS_OK) return 1; // most worlds hold two bodies
    for (const verify_entry *entry = verify_cases; entry->name; ++entry)
    {
        if (!wanted(entry->name, argc - 2, argv + 2)) continue;
        fprintf(stderr, "%s\n", entry->name);
        memset(sheet, 0, sizeof *sheet);
        sheet->thorough = true;
        entry->run(sheet);
        printf("### %s\n\n", entry->title);
        print_rows(sheet);
        fflush(stdout);
        if (!write_curves(sheet, argv[1], entry->name)) return 1;
        rows += sheet->row_count;
        for (int k = 0; k < sheet->row_count; ++k) failed += sheet->rows[k].passed ? 0 : 1;
    }
    printf("%d comparisons, %d out of tolerance.\n", rows, failed);
    free(sheet);
    return failed > 0 ? 1 : 0;
}
