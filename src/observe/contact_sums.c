// contact_sums.c -- sums over the contacts of a collection: stress, fabric, tangent operator, coordination, stored energy.

#include "observe/sums.h"

#include "base/alloc.h"
#include "base/parallel.h"

/// The sums are all doubles, so that they add up as an array.
enum { SUMS = sizeof(pls_contact_sums) / sizeof(double) };

static void combine(pls_contact_sums *to, const pls_contact_sums *from)
{
    double *a = (double *)to;
    const double *b = (const double *)from;
    for (int k = 0; k < SUMS; ++k) a[k] += b[k];
}

/// P1 eq. 24 with each contact once. The force is the one on i and the branch points from i to j, so pressing gives negative normal stress.
static void add_stress(const double d[3], const double force[3], double stress[9])
{
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j) stress[3 * i + j] += d[i] * force[j];
    }
}

/// P1 eq. 29. The tangents t1, t2 with n are an orthonormal basis, so t1 (x) t1 + t2 (x) t2 = I - n (x) n, whatever tangents one takes
/// (in the plane of a 2D world: the one tangent there is).
static void add_tangent(const double n[3], const double d[3], const pls_contact_stiffness *k, int dimension, double tangent[81])
{
    for (int i = 0; i < dimension; ++i)
    {
        for (int m = 0; m < dimension; ++m)
        {
            double stiffness = k->kn * n[i] * n[m] + k->kt * ((i == m ? 1 : 0) - n[i] * n[m]);
            for (int j = 0; j < dimension; ++j)
            {
                for (int l = 0; l < dimension; ++l) tangent[27 * i + 9 * j + 3 * m + l] += stiffness * d[j] * d[l];
            }
        }
    }
}

static void add_contact(const pls_selection *selection, const pls_contact_entry *contact, bool with_tangent, pls_contact_sums *sums)
{
    bool has_i = pls_selection_has_body(selection, contact->row_i);
    bool has_j = pls_selection_has_body(selection, contact->row_j);
    double share = 0.5 * ((has_i ? 1 : 0) + (has_j ? 1 : 0));
    sums->normal += share * contact->energy_normal;
    sums->shear += share * contact->energy_shear;
    sums->ends += (has_i ? 1 : 0) + (has_j && !contact->wall ? 1 : 0);
    if (!pls_selection_has_contact(selection, contact)) return;

    const double n[3] = {contact->normal.x, contact->normal.y, contact->normal.z};
    const double d[3] = {contact->branch.x, contact->branch.y, contact->branch.z};
    const double force[3] = {contact->force.x, contact->force.y, contact->force.z};
    sums->contacts += 1;
    add_stress(d, force, sums->stress);
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j) sums->fabric[3 * i + j] += n[i] * n[j];
    }
    if (with_tangent) add_tangent(n, d, &contact->stiffness, selection->around.domain->dimension, sums->tangent);
}

pls_status pls_sum_contacts(const pls_selection *selection, const pls_contact_view *view, bool with_tangent, pls_contact_sums *sums)
{
    const size_t blocks = pls_block_count(view->count, PLS_BLOCK);
    pls_contact_sums *part = NULL;
    *sums = (pls_contact_sums){0};
    PLS_TRY(pls_allocate(&part, blocks, sizeof *part, "sums over blocks of contacts"));
#pragma omp parallel for schedule(static)
    for (size_t block = 0; block < blocks; ++block)
    {
        for (size_t k = block * PLS_BLOCK; k < pls_block_end(block, PLS_BLOCK, view->count); ++k)
        {
            add_contact(selection, &view->entry[k], with_tangent, &part[block]);
        }
    }
    for (size_t block = 0; block < blocks; ++block) combine(sums, &part[block]);
    pls_release(&part);
    return PLS_OK;
}
