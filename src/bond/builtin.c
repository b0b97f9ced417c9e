// builtin.c -- the list of built-in bond laws; a new law adds one line.

#include "bond/builtin.h"

const pls_bond_ops *const *pls_builtin_bonds(void)
{
    static const pls_bond_ops *const laws[] = {&pls_linear_solid_bonds, &pls_bond_based_bonds, &pls_elastic_plastic_bonds,
                                               &pls_viscoelastic_bonds, &pls_beam_bonds,       NULL};
    return laws;
}

static pls_status refuse(const pls_bond_ops *ops, const char *why)
{
    return pls_fail(PLS_INVALID_ARGUMENT, "the bond law '%s' %s (see particls/bond.h)", ops->name ? ops->name : "?", why);
}

pls_status pls_bond_ops_check(const pls_bond_ops *ops)
{
    const bool remembers = ops->memories != 0 || ops->point_memories != 0;
    if (!ops->name) return refuse(ops, "has no name");
    if (ops->pair && (ops->linear || ops->pull))
        return refuse(ops, "is a pair law (`pair`) and one of families (`linear`, `pull`): be one of them");
    if (ops->pair && (!ops->prepare || !ops->stiffness)) return refuse(ops, "is a pair law and lacks `prepare` or `stiffness`");
    if (!ops->pair && !ops->linear)
        return refuse(ops, "has neither `linear` nor `pair`; laws with `pull` need `linear`, too, which says their stiffness");
    if (ops->pull && !ops->prepare) return refuse(ops, "has `pull` and lacks `prepare`");
    if (ops->pull && ops->pairwise) return refuse(ops, "has `pull` and is `pairwise`, which linear laws alone can be");
    if (!ops->pull && (ops->advance || remembers)) return refuse(ops, "remembers or advances something and lacks `pull`");
    if (remembers && !ops->advance) return refuse(ops, "remembers something and lacks `advance`, which alone may change it");
    if (ops->memories < 0 || ops->memories > PLS_BOND_MAX_MEMORY || ops->point_memories < 0 || ops->point_memories > PLS_BOND_MAX_MEMORY)
        return pls_fail(PLS_INVALID_ARGUMENT, "the bond law '%s' remembers %d numbers per bond and %d per point; at most %d are possible",
                        ops->name, ops->memories, ops->point_memories, PLS_BOND_MAX_MEMORY);
    return PLS_OK;
}
