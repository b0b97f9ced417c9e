// Every pair of shapes against slow oracles, on random poses and along tumbling trajectories, in short (`make prove`: in full), and what pairs do at their limits.

#include "support/values_alone.h"
#include "support/narrow_oracle.h"

#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const pls_narrow_options by_depth = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};

static bool is_slow(const char *name) { return strstr(name, "sdf-only") || strstr(name, "superquadric"); }

/// Pairs that need many SDF calls per query get fewer of them.
static void every_pair(int dimension)
{
    for (int b = 0; narrow_shape(dimension, b); ++b)
        for (int a = 0; a <= b; ++a)
        {
            const bool plane = !narrow_shape(dimension, b + 1);
            if (plane && a == b) continue;
            const bool slow = is_slow(narrow_name(dimension, a)) || is_slow(narrow_name(dimension, b));
            narrow_tally t = {0};
            narrow_random(dimension, a, b, slow ? 20 : 100, 1, 3, &t);
            narrow_tumble(dimension, a, b, 2, slow ? 60 : 200, slow ? 6 : 10, 1, 4, &t);
            if (t.wrong || t.not_finite || t.counts.failures)
                fail_msg("%s - %s in %dD: %llu of %llu wrong, by up to %.2e, %llu not finite, %llu failures", narrow_name(dimension, a),
                         narrow_name(dimension, b), dimension, (unsigned long long)t.wrong, (unsigned long long)t.checked, t.depth,
                         (unsigned long long)t.not_finite, (unsigned long long)t.counts.failures);
            assert_true(t.points < 2e-6);
        }
    narrow_free_shapes();
}

static void every_pair_in_space(void **state) { (void)state, every_pair(3); }
static void every_pair_in_the_plane(void **state) { (void)state, every_pair(2); }

/// Poses that `make prove` met. Their digits are all needed: the solvers came to other simplices from others.
static void poses_that_were_wrong(void **state)
{
    (void)state;
    enum { BOX = 1, CYLINDER = 4, POLYHEDRON = 8, PRISM = 9, ROUNDED_CYLINDER = 11 };
    const struct
    {
        int a, b;
        pls_posed pose[2];
    } met[] = {
        // two minima as deep to 1e-5 of the depth, the lesser one proved by cones of less than 1e-8 rad
        {BOX,
         CYLINDER,
         {{.position = {0.84766385628125018, 0.37201406870584364, 0.90361106215322906},
           .x = {-0.49792135846342211, 0.78595720583154849, -0.36653184225576602},
           .y = {0.69609997746221652, 0.11014421582352618, -0.70944560968246351},
           .z = {-0.51722252673587454, -0.60839092886242607, -0.60194795083534625},
           .scale = 0.92405686126646602},
          {.position = {-0.013206851904145722, 0.41616219321626613, 0.055699403483352672},
           .x = {-0.61803060176393343, 0.77940353268275653, 0.10280227879259396},
           .y = {0.61746337032710097, 0.56218614360306474, -0.55016881613284085},
           .z = {-0.48659753553384155, -0.27654452296574905, -0.82870137276949096},
           .scale = 0.9372896139826008}}},
        // edges of the polyhedron that meet, each with its own minimum at the rim, as deep to 3e-4, 8e-6 and 6e-5 of the depth
        {CYLINDER,
         POLYHEDRON,
         {{.position = {0.50813290317671156, 0.43578143955188586, 0.89950767979425539},
           .x = {-0.74195281908909783, 0.44737939798822557, 0.4993572754065308},
           .y = {0.51477197025049781, -0.097061924112025855, 0.85181500428913104},
           .z = {0.42955306178650571, 0.88906167229465272, -0.15828300593075117},
           .scale = 0.81630492261424958},
          {.position = {0.79890127017581714, -0.43434597460385149, 1.5471068566117097},
           .x = {0.57745645576594584, 0.81528607946555054, -0.043042424698481796},
           .y = {-0.17901444416439882, 0.075003297615604758, -0.98098335058618447},
           .z = {-0.79655374613063223, 0.57418038452778708, 0.18925912276236279},
           .scale = 1.0283620633777655}}},
        {CYLINDER,
         POLYHEDRON,
         {{.position = {0.11887491954072726, 0.15293662655289031, 0.50953654283356709},
           .x = {0.33438148708757498, 0.59078638993032151, -0.73427546776819386},
           .y = {-0.94145032822667363, 0.24505126438974556, -0.2315624263624721},
           .z = {0.04313120187277697, 0.76871406861985103, 0.63813664691108651},
           .scale = 1.040739694568424},
          {.position = {-0.078517141923902078, 0.40723724533906047, 1.9304354966195354},
           .x = {-0.40703733834853084, 0.2142715782651673, -0.88792358676740757},
           .y = {-0.5478870661193046, 0.72053035307783253, 0.4250362020730879},
           .z = {0.73084907331768867, 0.65948745328572278, -0.17588613074767268},
           .scale = 1.2454711640961436}}},
        {CYLINDER,
         POLYHEDRON,
         {{.position = {0.56613260465716719, 0.59446178169990738, 0.22970045974606745},
           .x = {-0.38739576445344914, 0.84645782253817514, 0.36528574615971365},
           .y = {-0.086895155004166724, 0.3609361334322595, -0.92853343484215567},
           .z = {-0.91780921422718853, -0.39145148134462499, -0.066272045635918042},
           .scale = 1.0212820147532118},
          {.position = {0.28492593607238298, -0.38199792481648764, 1.08486883972431},
           .x = {-0.32652987697968849, 0.91799957006451893, 0.22506672077627876},
           .y = {0.60039129451001494, 0.38535736664751996, -0.70073532339042044},
           .z = {-0.73000584443976713, -0.093682919104002282, -0.67698964375530513},
           .scale = 1.2279495945356524}}},
        // a simplex too thin to get on: taken for a gap
        {CYLINDER,
         PRISM,
         {{.position = {0.22366504871493986, 0.24740009324231649, 0.11435007949959386},
           .x = {-0.79768614003778859, -0.35315677306952753, -0.488852856825785},
           .y = {0.17085405630854311, 0.64505438828761519, -0.74479106304641407},
           .z = {0.57836468895890458, -0.67763200174284033, -0.45421267791582021},
           .scale = 1.255797255525626},
          {.position = {0.43104573331380114, -0.84094787897016876, 0.88317059519564556},
           .x = {0.57349814658986054, 0.68296434973994369, -0.4523931617987732},
           .y = {0.47794112779734921, -0.72745195036002253, -0.49232706433548656},
           .z = {-0.66533612123331543, 0.066131360954514329, -0.74360909682474441},
           .scale = 0.82688483485257014}}},
        // an edge 2e-5 rad off the end that it goes along, which it touches at the rim
        {PRISM,
         ROUNDED_CYLINDER,
         {{.position = {0.75895786015843669, 0.46569449445319105, 0.18392284465323699},
           .x = {-0.94308620472648896, -0.17716088955436435, 0.28142926227898457},
           .y = {0.22757419150070771, -0.96090248394364064, 0.1577225529648221},
           .z = {0.24248380939226932, 0.21279200070314722, 0.94653112290054442},
           .scale = 1.3895109280227969},
          {.position = {0.38210967301843418, -0.38935552176671806, -0.11678614930736952},
           .x = {-0.87400248092020738, -0.061185796610700005, -0.48205389910095797},
           .y = {-0.48207575186597107, 0.23374368863645867, 0.8443736480288101},
           .z = {0.06101338220571953, 0.97037115904984328, -0.23378875267232702},
           .scale = 0.77741268791822427}}},
        // the same, without rounding, where the points have to lie over each other
        {BOX,
         CYLINDER,
         {{.position = {0.60458685330296991, 0.77980859468451469, 0.090832691357679574},
           .x = {0.021759918070931361, 0.61329551468669452, 0.78955374587847327},
           .y = {0.43569658686837226, 0.70498389024692454, -0.55961254335795863},
           .z = {-0.89983053413228709, 0.35618299532332359, -0.25187037079757491},
           .scale = 0.73214454691020736},
          {.position = {0.12507882154480299, 2.1132044578901441, 0.22837304134875139},
           .x = {0.47282280297291401, -0.46025986125262058, 0.75139833451276394},
           .y = {0.84733026135786615, 0.0034834913837411552, -0.53105488744101592},
           .z = {0.24180575918709507, 0.88777740757889201, 0.39163918268791054},
           .scale = 1.3208814298460378}}},
    };
    narrow_tally t = {0};
    for (size_t k = 0; k < sizeof met / sizeof *met; ++k) narrow_once(3, met[k].a, met[k].b, met[k].pose, &t);
    assert_int_equal(t.checked, sizeof met / sizeof *met);
    assert_int_equal(t.wrong + t.not_finite + t.counts.failures, 0);
    narrow_free_shapes();
}

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    if (pls_shape_make(ops, dimension, &input, "a shape", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static pls_touch ask(const pls_posed *a, const pls_posed *b, pls_pair_state *state)
{
    pls_narrow_counts counts = {0};
    pls_touch t;
    pls_narrow_phase(a, b, &by_depth, state, &t, &counts);
    return t;
}

static void expect_finite(const pls_touch *t)
{
    const double all[] = {t->delta, t->normal.x, t->normal.y, t->normal.z, t->point.x, t->point.y, t->point.z};
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k) assert_true(isfinite(all[k]));
    assert_true(fabs(pls_length(t->normal) - 1.0) < 1e-12);
}

/// One body in the middle of the other, turned alike: no direction is preferred, gradients vanish, simplices are flat.
static void bodies_with_one_centre(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int a = 0; narrow_shape(dimension, a + 1); ++a)
            for (int b = a; narrow_shape(dimension, b + 1); ++b)
            {
                const pls_vec3 at = pls_vec(0.1, 0.2, dimension == 2 ? 0.0 : 0.3);
                const pls_posed pa = pls_pose(narrow_shape(dimension, a), at, pls_quat_identity(), 1.0),
                                pb = pls_pose(narrow_shape(dimension, b), at, pls_quat_identity(), 0.5);
                pls_pair_state memory = {{0}};
                for (int k = 0; k < 3; ++k)
                {
                    pls_touch t = ask(&pa, &pb, &memory);
                    expect_finite(&t);
                    assert_true(t.delta > 0.0 && t.delta < 2.0 * (pa.size + pb.size));
                }
            }
    narrow_free_shapes();
}

/// Cubes: face on face, edge on edge, corner on corner, a shift along the face; depths known.
static void cubes_aligned(void **state)
{
    (void)state;
    const double half[4] = {0.5, 0.5, 0.5, 0.0};
    const struct
    {
        pls_vec3 at;
        double delta;
    } known[] = {{{1.0, 0.0, 0.0}, 0.0},      {{0.99, 0.0, 0.0}, 0.01},        {{1.01, 0.0, 0.0}, -0.01},  {{0.99, 0.3, -0.2}, 0.01},
                 {{1.0, 1.0, 0.0}, 0.0},      {{1.0, 1.0, 1.0}, 0.0},          {{0.99, 0.98, 0.97}, 0.01}, {{1.03, 1.04, 0.0}, -0.05},
                 {{0.98, 0.999, 0.0}, 0.001}, {{1.0 - 1e-13, 0.0, 0.0}, 1e-13}};
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *cube = make(&pls_box_shape, dimension, COUNTED(half));
        pls_pair_state memory = {{0}};
        for (int k = 0; k < 2 * (int)(sizeof known / sizeof *known); ++k) // cold, then from each other's memory
        {
            pls_vec3 at = known[k / 2].at;
            double delta = known[k / 2].delta;
            if (dimension == 2 && at.z != 0.0) continue;
            const pls_posed a = pls_pose(cube, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                            b = pls_pose(cube, at, pls_quat_identity(), 1.0);
            pls_pair_state cold = {{0}};
            pls_touch t = ask(&a, &b, k % 2 ? &memory : &cold);
            expect_finite(&t);
            assert_true(fabs(t.delta - delta) < 1e-12);
        }
        pls_shape_free(cube);
    }
}

static void spheres_at_the_same_place(void **state)
{
    (void)state;
    const double one = 1.0, other = 0.4;
    pls_shape *a = make(&pls_sphere_shape, 3, &one, 1), *b = make(&pls_sphere_shape, 3, &other, 1);
    const pls_posed pa = pls_pose(a, pls_vec(1.0, 2.0, 3.0), pls_quat_identity(), 1.0),
                    pb = pls_pose(b, pls_vec(1.0, 2.0, 3.0), pls_quat_identity(), 1.0);
    pls_pair_state memory = {{0}};
    pls_touch t = ask(&pa, &pb, &memory);
    expect_finite(&t);
    assert_true(fabs(t.delta - 1.4) < 1e-15);
    pls_shape_free(a);
    pls_shape_free(b);
}

/// The answer depends on state and poses only: after a copy of the state the same bits, and a pair far apart leaves it alone.
static void the_same_bits_from_the_same_state(void **state)
{
    (void)state;
    for (int a = 0; narrow_shape(3, a + 1); ++a)
    {
        const pls_shape *box = narrow_shape(3, 1), *other = narrow_shape(3, a);
        pls_pair_state memory = {{0}};
        for (int k = 0; k < 12; ++k)
        {
            pls_quat turn = pls_quat_unit((pls_quat){1.0, 0.01 * k, 0.02 * k, -0.03 * k});
            const pls_posed pa = pls_pose(box, pls_vec(0.0, 0.0, 0.0), turn, 1.0),
                            pb = pls_pose(other, pls_vec(0.0, 0.1, 1.1 - 0.01 * k), turn, 1.0);
            pls_pair_state copy = memory;
            pls_touch t = ask(&pa, &pb, &memory), again = ask(&pa, &pb, &copy);
            assert_memory_equal(&t, &again, sizeof t);
            assert_memory_equal(&memory, &copy, sizeof memory);
        }
    }
    narrow_free_shapes();
}

// ---- not convex -----------------------------------------------------------------------------------------------------------------------------------------------------

static const double ring = 1.0, tube = 0.25;

/// Spheres anywhere: exact. Ellipsoids and tori lying on a torus: known by symmetry.
static void a_torus(void **state)
{
    (void)state;
    const double radius = 0.3, half[4] = {0.3, 0.2, 0.15, 0.0}; // no rounding
    const double sizes[2] = {ring, tube};
    pls_shape *donut = make(&values_ring, 3, COUNTED(sizes)), *ball = make(&pls_sphere_shape, 3, &radius, 1),
              *egg = make(&pls_ellipsoid_shape, 3, COUNTED(half));
    const pls_posed lying = pls_pose(donut, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
    for (int k = 0; k < 40; ++k)
    {
        pls_vec3 c = pls_vec(0.05 * k - 1.0, 0.3 + 0.02 * k, 0.5 - 0.01 * k);
        const pls_posed b = pls_pose(ball, c, pls_quat_identity(), 1.0);
        pls_pair_state memory = {{0}};
        pls_touch t = ask(&lying, &b, &memory);
        expect_finite(&t);
        assert_true(fabs(t.delta - (radius - pls_shape_sdf(donut, pls_posed_own(&lying, c)))) <
                    1e-12); // its centre of mass is known by quadrature
    }
    pls_pair_state memory = {{0}}, other = {{0}};
    for (int k = 0; k < 40; ++k)
    {
        double depth = 0.02 - 0.001 * k;
        // The egg's short axis is z: it lies on top of the tube, whose crest is round along x only.
        const pls_posed b = pls_pose(egg, pls_vec(ring, 0.0, tube + half[2] - depth), pls_quat_identity(), 1.0);
        pls_touch t = ask(&lying, &b, &memory);
        assert_true(fabs(t.delta - depth) < 1e-6 && t.normal.z > 1.0 - 1e-6);
        // The other donut stands upright, its tube touching the crest from above.
        const double turn = sqrt(0.5);
        const pls_posed c = pls_pose(donut, pls_vec(ring, 0.0, tube + ring + tube - depth), (pls_quat){turn, 0.0, turn, 0.0}, 1.0);
        t = ask(&lying, &c, &other);
        expect_finite(&t);
        assert_true(fabs(t.delta - depth) < 1e-6);
    }
    pls_shape_free(donut);
    pls_shape_free(ball);
    pls_shape_free(egg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_in_space),
        cmocka_unit_test(every_pair_in_the_plane),
        cmocka_unit_test(poses_that_were_wrong),
        cmocka_unit_test(bodies_with_one_centre),
        cmocka_unit_test(cubes_aligned),
        cmocka_unit_test(spheres_at_the_same_place),
        cmocka_unit_test(the_same_bits_from_the_same_state),
        cmocka_unit_test(a_torus),
    };
    return cmocka_run_group_tests_name("narrow_phase", tests, NULL, NULL);
}
