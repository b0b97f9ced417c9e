// builtin.h -- the built-in contact laws, one file each.
#ifndef PLS_LAW_BUILTIN_H
#define PLS_LAW_BUILTIN_H

#include <particls/law.h>

extern const pls_law_ops pls_elastic_law, pls_viscoelastic_law, pls_hertz_mindlin_law;

#endif
