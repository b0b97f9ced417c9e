// builtin.c -- the list of built-in laws; a new law adds one line.

#include "law/builtin.h"

#include <particls/world.h>

const pls_law_ops *const *pls_builtin_laws(void)
{
    static const pls_law_ops *const laws[] = {&pls_elastic_law, &pls_viscoelastic_law, &pls_hertz_mindlin_law, NULL};
    return laws;
}
