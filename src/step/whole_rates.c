// whole_rates.c -- the largest eigenvalues of stiffness and damping of all contacts together, by Lanczos iteration.
//
// Contacts are kept as floats, half the memory of doubles: that changes eigenvalues by 1e-7, and 3 % are added.

#include "step/whole_rates.h"

#include "base/alloc.h"
#include "base/random.h"
#include "math/lanczos.h"

static const double margin = 1.03; ///< Lanczos values come from below

/// Stiffness in [0], damping in [1].
typedef struct packed_contact
{
    uint32_t i, j;
    float n[3];
    float lever_i, lever_j; ///< times the roots of inverse moments
    float root_i, root_j;   ///< roots of inverse masses, 0 where no force moves it
    float normal[2], tangential[2];
} packed_contact;

typedef struct whole
{
    packed_contact *packed;
    size_t contacts, rows;
    double (*missing)[2][2]; ///< per row, for stiffness and damping: what contacts still to come add to translation and rotation
    bool damping;            ///< which of the two is multiplied by
    int dimension;
} whole;

static void whole_free(whole *w)
{
    pls_release(&w->packed);
    pls_release(&w->missing);
}

static packed_contact pack(const pls_world *world, size_t candidate)
{
    const pls_bodies *b = &world->bodies;
    pls_contact_rate t = pls_contact_rate_of(world, candidate);
    double root_i = sqrt(b->load[t.i].inv_mass), root_j = t.held ? 0.0 : sqrt(b->load[t.j].inv_mass);
    double turn_i = root_i > 0.0 ? 1.0 / sqrt(pls_smallest_moment(&b->mass[t.i], world->def.dimension)) : 0.0;
    double turn_j = root_j > 0.0 ? 1.0 / sqrt(pls_smallest_moment(&b->mass[t.j], world->def.dimension)) : 0.0;
    return (packed_contact){.i = t.i,
                            .j = t.j,
                            .n = {(float)t.n.x, (float)t.n.y, (float)t.n.z},
                            .lever_i = (float)(t.lever_i * turn_i),
                            .lever_j = (float)(t.lever_j * turn_j),
                            .root_i = (float)root_i,
                            .root_j = (float)root_j,
                            .normal = {(float)t.k.kn, (float)t.k.cn},
                            .tangential = {(float)t.k.kt, (float)t.k.ct}};
}

static pls_status whole_make(const pls_world *world, int coordination, whole *w)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    int *contacts = NULL;
    w->rows = b->count;
    w->dimension = world->def.dimension;
    PLS_TRY(pls_allocate(&w->packed, pls_pair_list_touching(list), sizeof *w->packed, "contacts of the stable step"));
    PLS_TRY(pls_allocate(&w->missing, w->rows, sizeof *w->missing, "the stable step"));
    PLS_TRY(pls_allocate(&contacts, w->rows, sizeof *contacts, "the stable step"));
    for (size_t c = 0; c < list->count; ++c)
    {
        if (!pls_pair_touches(list, c)) continue;
        if (b->load[list->row_i[c]].inv_mass == 0.0 && b->load[list->row_j[c]].inv_mass == 0.0) continue; // neither moves
        w->packed[w->contacts++] = pack(world, c);
        ++contacts[list->row_i[c]];
        ++contacts[list->row_j[c]];
    }
    for (uint32_t row = 0; row < w->rows; ++row)
    {
        if (b->load[row].inv_mass == 0.0) continue;
        pls_body_rates missing = {.contacts = contacts[row]};
        pls_add_missing_contacts(world, row, coordination, &missing);
        w->missing[row][0][0] = missing.stiffness[0];
        w->missing[row][0][1] = missing.stiffness[35];
        w->missing[row][1][0] = missing.damping[0];
        w->missing[row][1][1] = missing.damping[35];
    }
    pls_release(&contacts);
    return PLS_OK;
}

static pls_vec3 vec_at(const double *x) { return pls_vec(x[0], x[1], x[2]); }

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
        double mi = (double)t->root_i, mj = (double)t->root_j, ri = (double)t->lever_i, rj = (double)t->lever_j;
        pls_vec3 n = pls_vec((double)t->n[0], (double)t->n[1], (double)t->n[2]);
        pls_vec3 turn = pls_add(pls_scale(vec_at(x + i + 3), ri), pls_scale(vec_at(x + j + 3), rj));
        pls_vec3 u = pls_sub(pls_scale(vec_at(x + i), mi), pls_scale(vec_at(x + j), mj));
        u = pls_add(u, pls_cross(turn, n));
        pls_vec3 f = pls_add(pls_scale(u, kt), pls_scale(n, (kn - kt) * pls_dot(u, n))), torque = pls_cross(n, f);
        if (w->dimension == 2) f.z = torque.x = torque.y = 0.0;
        add_at(y + i, f, mi);
        add_at(y + i + 3, torque, ri);
        add_at(y + j, f, -mj);
        add_at(y + j + 3, torque, rj);
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
