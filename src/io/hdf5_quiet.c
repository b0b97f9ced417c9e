// hdf5_quiet.c -- HDF5 keeps a stack of errors; the innermost one says what happened, with the errno of the system as text.

#include "io/hdf5_quiet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

pls_hdf5_quiet pls_hdf5_begin(void)
{
    pls_hdf5_quiet quiet = {0};
    H5Eget_auto2(H5E_DEFAULT, &quiet.function, &quiet.context);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return quiet;
}

void pls_hdf5_end(const pls_hdf5_quiet *quiet) { H5Eset_auto2(H5E_DEFAULT, quiet->function, quiet->context); }

typedef struct reason
{
    char text[160]; ///< of the innermost error
    int error;      ///< errno, 0 when unknown
} reason;

static herr_t look_at_error(unsigned depth, const H5E_error2_t *error, void *context)
{
    (void)depth;
    reason *found = context;
    if (!error->desc) return 0;
    const char *number = strstr(error->desc, "errno = ");
    if (number) found->error = atoi(number + strlen("errno = "));
    snprintf(found->text, sizeof found->text, "%s", error->desc);
    return 0;
}

pls_status pls_hdf5_fail(pls_status status, const char *what, const char *path)
{
    reason found = {0};
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, look_at_error, &found); // ends with the innermost
    H5Eclear2(H5E_DEFAULT);
    return pls_fail(status, "cannot %s \"%s\": %s", what, path,
                    found.error     ? strerror(found.error)
                    : found.text[0] ? found.text
                                    : "HDF5 gives no reason");
}
