// whole_rates.c -- the largest eigenvalues of stiffness and damping of all contacts together, by Lanczos iteration.
//
// Contacts are kept as floats, half the memory of doubles: that changes eigenvalues by 1e-7, and 3 % are added.

#include "step/whole_rates.h"

#include "base/alloc.h"
#include "base/random.h"
#include "math/lanczos.h"
#include "step/bonds.h"

static const double margin = 1.03; ///< Lanczos values come from below

/// Stiffness in [0], damping in [1].
typedef struct packed_contact
{
    uint32_t i, j;
    float n[3];
    float arm_i[3], arm_j[3]; ///< contact point from the centres
    float root_i, root_j;     ///< roots of inverse masses, 0 where no force moves it
    float normal[2], tangential[2];
} packed_contact;

typedef struct whole
{
    packed_contact *packed;
    size_t contacts, rows;
    double (*root)[6];       ///< per row: root of the inverse inertia, 0 where no force moves it
    double (*missing)[2][2]; ///< per row, for stiffness and damping: what contacts still to come add to translation and rotation
    bool damping;            ///< which of the two is multiplied by
    int dimension;
} whole;

static void whole_free(whole *w)
{
    pls_release(&w->packed);
    pls_release(&w->root);
    pls_release(&w->missing);
}

static packed_contact pack(const pls_bodies *b, const pls_contact_rate *t)
{
    double root_i = sqrt(b->load[t->i].inv_mass), root_j = t->held ? 0.0 : sqrt(b->load[t->j].inv_mass);
    return (packed_contact){.i = t->i,
                            .j = t->j,
                            .n = {(float)t->n.x, (float)t->n.y, (float)t->n.z},
                            .arm_i = {(float)t->arm_i.x, (float)t->arm_i.y, (float)t->arm_i.z},
                            .arm_j = {(float)t->arm_j.x, (float)t->arm_j.y, (float)t->arm_j.z},
                            .root_i = (float)root_i,
                            .root_j = (float)root_j,
                            .normal = {(float)t->k.kn, (float)t->k.cn},
                            .tangential = {(float)t->k.kt, (float)t->k.ct}};
}

/// A contact in `count` pieces.
static void add(whole *w, const pls_bodies *b, const pls_contact_rate *t, int count, int *contacts)
{
    if (b->load[t->i].inv_mass == 0.0 && b->load[t->j].inv_mass == 0.0) return; // neither moves
    for (int k = 0; k < count; ++k) w->packed[w->contacts++] = pack(b, &t[k]);
    ++contacts[t->i];
    ++contacts[t->j];
}

static pls_status whole_make(const pls_world *world, int coordination, whole *w)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    int *contacts = NULL;
    w->rows = b->count;
    w->dimension = world->def.dimension;
    size_t touching = pls_pair_list_touching(list) + PLS_SOLID_RATES * pls_solid_list_touching(&world->solids);
    PLS_TRY(pls_allocate(&w->packed, touching, sizeof *w->packed, "contacts of the stable step"));
    PLS_TRY(pls_allocate(&w->root, w->rows, sizeof *w->root, "the stable step"));
    PLS_TRY(pls_allocate(&w->missing, w->rows, sizeof *w->missing, "the stable step"));
    PLS_TRY(pls_allocate(&contacts, w->rows, sizeof *contacts, "the stable step"));
    for (size_t c = 0; c < list->count; ++c)
    {
        if (!pls_pair_touches(list, c)) continue;
        pls_contact_rate t = pls_contact_rate_of(world, c);
        add(w, b, &t, 1, contacts);
    }
    for (size_t c = 0; c < world->solids.count; ++c)
    {
        if (world->solids.memory[c].touches != PLS_SOLID_TOUCHES) continue;
        pls_contact_rate t[PLS_SOLID_RATES];
        const int pieces = pls_solid_rates_of(world, c, t);
        add(w, b, t, pieces, contacts);
    }
    for (uint32_t row = 0; row < w->rows; ++row)
    {
        if (b->load[row].inv_mass == 0.0) continue;
        pls_root_inverse_inertia(world, row, w->root[row]);
        pls_body_rates missing = {.contacts = contacts[row]};
        pls_add_missing_contacts(world, row, coordination, &missing);
        w->missing[row][0][0] = missing.stiffness[0] + pls_bonds_rate(world, b->kind[row].number, false);
        w->missing[row][0][1] = missing.stiffness[35] + pls_bonds_rate(world, b->kind[row].number, true);
        w->missing[row][1][0] = missing.damping[0];
        w->missing[row][1][1] = missing.damping[35];
    }
    pls_release(&contacts);
    return PLS_OK;
}

static pls_vec3 vec_at(const double *x) { return pls_vec(x[0], x[1], x[2]); }

static pls_vec3 vec_of(const float *a) { return pls_vec((double)a[0], (double)a[1], (double)a[2]); }

static void add_at(double *y, pls_vec3 a, double s) { y[0] += s * a.x, y[1] += s * a.y, y[2] += s * a.z; }

/// y = M^-1/2 A M^-1/2 x, A the stiffness or the damping of all contacts.
static void multiply(const void *context, const double *x, double *y)
{
    const whole *w = context;
    for (size_t row = 0; row < w->rows; ++row)
        for (size_t a = 0; a < 6; ++a) y[6 * row + a] = w->missing[row][w->damping][a >= 3] * x[6 * row + a];
    for (size_t m = 0; m < w->contacts; ++m)
    {
        const packed_contact *t = &w->packed[m];
        const size_t i = 6 * (size_t)t->i, j = 6 * (size_t)t->j;
        double kn = (double)t->normal[w->damping], kt = (double)t->tangential[w->damping];
        double mi = (double)t->root_i, mj = (double)t->root_j;
        pls_vec3 n = vec_of(t->n), arm_i = vec_of(t->arm_i), arm_j = vec_of(t->arm_j);
        pls_vec3 u = pls_sub(pls_scale(vec_at(x + i), mi), pls_scale(vec_at(x + j), mj));
        u = pls_add(u, pls_cross(pls_symmetric_multiply(w->root[t->i], vec_at(x + i + 3)), arm_i));
        if (mj > 0.0) u = pls_sub(u, pls_cross(pls_symmetric_multiply(w->root[t->j], vec_at(x + j + 3)), arm_j));
        pls_vec3 f = pls_add(pls_scale(u, kt), pls_scale(n, (kn - kt) * pls_dot(u, n)));
        if (w->dimension == 2) f.z = 0.0;
        add_at(y + i, f, mi);
        add_at(y + i + 3, pls_symmetric_multiply(w->root[t->i], pls_cross(arm_i, f)), 1.0);
        add_at(y + j, f, -mj);
        if (mj > 0.0) add_at(y + j + 3, pls_symmetric_multiply(w->root[t->j], pls_cross(arm_j, f)), -1.0);
    }
}

static pls_status largest(whole *w, const pls_bodies *b, bool damping, double *x, double *out)
{
    w->damping = damping;
    for (size_t row = 0; row < w->rows; ++row)
    {
        pls_random random = pls_random_stream(0, b->kind[row].number, PLS_FOR_USER);
        for (size_t a = 0; a < 6; ++a)
        {
            bool moves = b->load[row].inv_mass > 0.0 && (w->dimension == 3 || a < 2 || a == 5);
            x[6 * row + a] = moves ? pls_random_uniform(&random) - 0.5 : 0.0;
        }
    }
    PLS_TRY(pls_lanczos_largest(multiply, w, 6 * w->rows, x, out));
    *out *= margin;
    return PLS_OK;
}

pls_status pls_whole_rates(const pls_world *world, int coordination, double *stiffness, double *damping)
{
    whole w = {0};
    double *x = NULL;
    pls_status status = whole_make(world, coordination, &w);
    if (status == PLS_OK) status = pls_allocate(&x, 6 * w.rows, sizeof *x, "the stable step");
    if (status == PLS_OK) status = largest(&w, &world->bodies, false, x, stiffness);
    if (status == PLS_OK) status = largest(&w, &world->bodies, true, x, damping);
    pls_release(&x);
    whole_free(&w);
    return status;
}
