// test_wall_facets.c -- which pieces of a wall hang together: a block, a floor, three sheets on one edge, a way in the plane.
#include "shape/wall_facets.h"
#include "support/near.h"
#include "support/verify.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/// Triangles by numbers of corners.
static void make(const pls_vec3 *x, const int (*triangle)[3], size_t count, pls_vec3 (*corner)[3], pls_facet *out)
{
    for (size_t t = 0; t < count; ++t)
        for (int k = 0; k < 3; ++k) corner[t][k] = x[triangle[t][k]];
    MUST(pls_wall_facets(corner, count, 3, out));
}

static int side_to(const pls_facet *f, uint32_t number)
{
    for (int k = 0; k < 3; ++k)
        if (f->neighbour[k] == number) return k;
    return -1;
}

/// A cube of 12 triangles that go round in all senses: normals end on one side, six patches, ridges of a right angle from outside.
static void a_block(void **state)
{
    (void)state;
    static const pls_vec3 x[8] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    static const int triangle[12][3] = {{0, 2, 1}, {0, 2, 3}, {4, 5, 6}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                        {1, 2, 6}, {1, 5, 6}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    pls_vec3 corner[12][3];
    pls_facet f[12];
    make(x, triangle, 12, corner, f);
    const double out = pls_dot(f[0].normal, corner[0][0]) > 0.0 ? 1.0 : -1.0;
    for (uint32_t t = 0; t < 12; ++t)
    {
        assert_int_equal(f[t].number, t);
        assert_near(pls_dot(f[t].normal, corner[t][0]), out, 1e-15);
        assert_vec_near(pls_unit(pls_cross(pls_sub(corner[t][1], corner[t][0]), pls_sub(corner[t][2], corner[t][0]))), f[t].normal, 1e-15);
        int level = 0;
        for (int k = 0; k < 3; ++k)
        {
            assert_true(f[t].neighbour[k] < 12);
            const pls_facet *g = &f[f[t].neighbour[k]];
            assert_true(side_to(g, t) >= 0);
            assert_int_equal(f[t].level[k], g->patch == f[t].patch);
            level += f[t].level[k];
            assert_near(f[t].bend[k], f[t].level[k] ? 0.0 : out * M_PI_2, 1e-15);
            // Outwards, in the plane that halves the angle: as far from the one plane as from the other.
            const pls_vec3 from = pls_sub(corner[t][(k + 2) % 3], corner[t][k]);
            assert_true(pls_dot(f[t].side[k], from) < 0.0);
            assert_near(pls_dot(f[t].side[k], pls_add(f[t].normal, g->normal)), 0.0, 1e-15);
            assert_vec_near(f[t].side_normal[k], pls_unit(pls_add(f[t].normal, g->normal)), 1e-15);
            // By angles: the corner's three faces count the same, cut or not.
            assert_vec_near(f[t].corner_normal[k], pls_scale(corner[t][k], out / sqrt(3.0)), 1e-15);
            assert_near(f[t].corner_level[k], 1.0 / sqrt(3.0), 1e-15);
            assert_int_equal(f[t].corner_form[k], (int)out);
        }
        assert_int_equal(level, 1);
    }
}

/// Level to 15 degrees is one patch, more is not, and free sides are told.
static void a_floor(void **state)
{
    (void)state;
    for (int steep = 0; steep < 2; ++steep)
    {
        const double up = tan((steep ? 16.0 : 14.0) / 180.0 * M_PI);
        const pls_vec3 x[6] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, up}, {-1, 1, 0}, {0, 1, 0}, {1, 1, up}};
        static const int triangle[4][3] = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {5, 4, 1}};
        pls_vec3 corner[4][3];
        pls_facet f[4];
        make(x, triangle, 4, corner, f);
        assert_int_equal(f[0].patch, f[1].patch);
        assert_int_equal(f[2].patch, f[3].patch);
        assert_int_equal(f[0].patch == f[2].patch, !steep);
        const int k = side_to(&f[0], 3);
        assert_true(k >= 0);
        assert_near(f[0].bend[k], -atan(up), 1e-12); // towards +z, where the normal points
        int free = 0;
        for (int t = 0; t < 4; ++t)
            for (int j = 0; j < 3; ++j) free += f[t].neighbour[j] == PLS_NO_FACET;
        assert_int_equal(free, 6);
    }
}

/// A sheet that stands on a floor: the floor goes on, the sheet leans on it.
static void three_at_one_edge(void **state)
{
    (void)state;
    static const pls_vec3 x[5] = {{0, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}, {1, 0.5, 0}, {0, 0.5, 1}};
    static const int triangle[3][3] = {{0, 1, 4}, {0, 1, 2}, {0, 1, 3}};
    pls_vec3 corner[3][3];
    pls_facet f[3];
    make(x, triangle, 3, corner, f);
    assert_true(side_to(&f[1], 2) >= 0 && side_to(&f[2], 1) >= 0);
    assert_near(pls_dot(f[1].normal, f[2].normal), 1.0, 1e-15); // turned over to agree
    assert_int_equal(f[1].patch, f[2].patch);
    assert_true(f[0].patch != f[1].patch);
    const int k = side_to(&f[0], 1) >= 0 ? side_to(&f[0], 1) : side_to(&f[0], 2);
    assert_true(k >= 0);
    assert_near(fabs(f[0].bend[k]), M_PI_2, 1e-15);
}

/// Segments: a valley of a right angle, seen from its normals' side, and two ends.
static void a_way(void **state)
{
    (void)state;
    pls_vec3 corner[2][3] = {{{1, 1, 0}, {0, 0, 0}}, {{-1, 1, 0}, {0, 0, 0}}}; // the second one runs against the first
    pls_facet f[2];
    MUST(pls_wall_facets(corner, 2, 2, f));
    assert_vec_near(corner[1][0], pls_vec(0, 0, 0), 0.0); // it was turned
    assert_int_equal(f[0].neighbour[1], 1);
    assert_int_equal(f[1].neighbour[0], 0);
    assert_int_equal(f[0].neighbour[0], PLS_NO_FACET);
    const double towards = pls_dot(f[0].normal, pls_vec(0, 1, 0)) > 0.0 ? 1.0 : -1.0;
    assert_near(f[0].bend[1], -towards * M_PI_2, 1e-15);
    assert_near(f[1].bend[0], f[0].bend[1], 1e-15);
    assert_vec_near(f[0].side[1], pls_vec(-1, 0, 0), 1e-15);
    assert_vec_near(f[0].side[0], pls_scale(pls_vec(1, 1, 0), M_SQRT1_2), 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_block), cmocka_unit_test(a_floor), cmocka_unit_test(three_at_one_edge),
                                       cmocka_unit_test(a_way)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
