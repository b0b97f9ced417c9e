// cases_measure.c -- homogenised measures with closed forms: Cauchy stress (P1 eq. 24, each pair once) and tangent operator D (P1 eq. 29).
#include "verify/cases.h"

// Bodies 0 and 1 are pressed together along z by a force of 3 N each.
static void press_pair(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time;
    (void)position;
    (void)velocity;
    (void)torque;
    *force = pls_vec(0, 0, body == 0 ? 3.0 : -3.0);
}

static pls_collection measure(pls_world *world, unsigned quantities, double volume)
{
    pls_collection_def def = pls_default_collection_def();
    pls_collection out;
    def.quantities = quantities;
    def.volume_kind = volume > 0.0 ? PLS_VOLUME_VALUE : PLS_VOLUME_PERIODIC;
    def.volume = volume;
    MUST(pls_measure_collection(world, &def, &out));
    return out;
}

void case_column_stress(verify_sheet *sheet)
{
    static const verify_field press = {press_pair, NULL};
    double force = 3.0, kn = 1000.0, overlap = force / kn, volume = 2.5;
    const verify_value law[] = {{"kn", kn}, {"ks", 500.0}, {"cn", 10.0}, {"cs", 5.0}, {"friction", 0.3}, {NULL, 0.0}};

    // Two spheres, nothing else: sigma_zz V = -F d with the distance d of the centres.
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    verify_scene scene = verify_open(&def, "viscoelastic", law);
    verify_ball(&scene, 1.0, 1.0, pls_vec(0, 0, 1), pls_vec(0, 0, 0));
    verify_ball(&scene, 1.5, 3.0, pls_vec(0, 0, 1 + 2.5 - overlap), pls_vec(0, 0, 0));
    verify_add_field(scene.world, &press);
    MUST(pls_world_run(scene.world, 200));
    pls_collection c = measure(scene.world, PLS_MEASURE_STRESS | PLS_MEASURE_FABRIC | PLS_MEASURE_COORDINATION, volume);
    verify_close(&scene);
    double others = fabs(c.stress[0][0]) + fabs(c.stress[1][1]) + fabs(c.stress[0][1]) + fabs(c.stress[1][0]) + fabs(c.stress[0][2]) +
                    fabs(c.stress[2][0]) + fabs(c.stress[1][2]) + fabs(c.stress[2][1]);
    sheet_relative(sheet, c.stress[2][2], -force * (2.5 - overlap) / volume, 1e-12, "two spheres: sigma_zz = -F d/V [Pa]");
    sheet_below(sheet, others, 1e-14, "two spheres: all other components [Pa]");
    sheet_absolute(sheet, c.fabric[2][2], 1.0, 1e-14, "two spheres: fabric zz");
    sheet_absolute(sheet, (double)c.contacts, 1.0, 0.0, "two spheres: contacts");
    sheet_absolute(sheet, c.coordination, 1.0, 0.0, "two spheres: coordination");

    // Between two planes that press with F: branches add up to the distance H of the planes, so sigma_zz V = -F H, at rest, after settling.
    scene = verify_open(&def, "viscoelastic", law);
    double height = 2.0 + 3.0 - 3.0 * overlap;
    verify_ball(&scene, 1.0, 1.0, pls_vec(0, 0, 1.0 - 0.9 * overlap), pls_vec(0, 0, 0));
    verify_ball(&scene, 1.5, 3.0, pls_vec(0, 0, height - 1.5 + 1.1 * overlap), pls_vec(0, 0, 0));
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    pls_body_id top = verify_wall(&scene, pls_vec(0, 0, height), pls_vec(0, 0, -1));
    MUST(pls_world_run(scene.world, 20000));
    pls_body_motion m = verify_motion(scene.world, top);
    c = measure(scene.world, PLS_MEASURE_STRESS, volume);
    verify_close(&scene);
    sheet_relative(sheet, m.force.z, force, 1e-10, "column: force on the upper plane [N]");
    sheet_relative(sheet, c.stress[2][2], -force * height / volume, 1e-10, "column between planes: sigma_zz = -F H/V [Pa]");
}

/// D of one contact along `n` at distance `d`: 1/V (kn n d n d + kt sum over tangents t d t d).
static double tangent_component(pls_vec3 normal, double d, double kn, double kt, int i, int j, int k, int l)
{
    const double n[3] = {normal.x, normal.y, normal.z};
    double tangents = (i == k ? 1.0 : 0.0) - n[i] * n[k];
    return (kn * n[i] * n[k] + kt * tangents) * d * n[j] * d * n[l];
}

void case_single_contact_tangent(verify_sheet *sheet)
{
    double kn = 1000.0, ks = 600.0, distance = 1.99, volume = 4.0, error = 0.0, largest = 0.0;
    pls_vec3 n = pls_unit(pls_vec(0.3, -0.5, 0.8));
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", kn}, {"ks", ks}, {"friction", 0.3}, {NULL, 0.0}});
    verify_ball(&scene, 1.0, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    verify_ball(&scene, 1.0, 1.0, pls_scale(n, distance), pls_vec(0, 0, 0));
    MUST(pls_world_prepare(scene.world));
    pls_collection c = measure(scene.world, PLS_MEASURE_TANGENT, volume);
    verify_close(&scene);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                {
                    double exact = tangent_component(n, distance, kn, ks, i, j, k, l) / volume;
                    error = fmax(error, fabs(c.tangent[i][j][k][l] - exact));
                    largest = fmax(largest, fabs(exact));
                }
    sheet_below(sheet, error / largest, 1e-13, "largest error of the 81 components, of the largest component");
}

void case_fcc_tangent(verify_sheet *sheet)
{
    // n^3 cells of edge a, four spheres each, nearest neighbours at a/sqrt(2). Sums over the 24 contacts of a cell (THEORY: D of P1 eq. 29):
    //     D_1111 = (2 kn + 2 kt)/a    D_1122 = (kn - kt)/a    D_1212 = (kn + 3 kt)/a    D_1221 = (kn - kt)/a
    enum { CELLS = 3 };
    const double base[4][3] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
    double a = 2.0 * sqrt(2.0) * 0.999, kn = 1000.0, kt = 400.0;
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    def.periodic[0] = def.periodic[1] = def.periodic[2] = true;
    def.lower = pls_vec(0, 0, 0);
    def.upper = pls_vec(CELLS * a, CELLS * a, CELLS * a);
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", kn}, {"ks", kt}, {"friction", 0.3}, {NULL, 0.0}});
    for (int x = 0; x < CELLS; ++x)
        for (int y = 0; y < CELLS; ++y)
            for (int z = 0; z < CELLS; ++z)
                for (int b = 0; b < 4; ++b)
                    verify_ball(&scene, 1.0, 1.0,
                                pls_vec((x + base[b][0] + 0.1) * a, (y + base[b][1] + 0.1) * a, (z + base[b][2] + 0.1) * a),
                                pls_vec(0, 0, 0));
    MUST(pls_world_prepare(scene.world));
    pls_collection c = measure(scene.world, PLS_MEASURE_TANGENT | PLS_MEASURE_COORDINATION | PLS_MEASURE_FABRIC | PLS_MEASURE_STRESS, 0.0);
    verify_close(&scene);
    double overlap = 2.0 - a / sqrt(2.0), pressure = 24.0 * kn * overlap * (a / sqrt(2.0)) / (3.0 * a * a * a);
    sheet_absolute(sheet, c.coordination, 12.0, 0.0, "coordination");
    sheet_relative(sheet, c.tangent[0][0][0][0], 2.0 * (kn + kt) / a, 1e-12, "D_1111 [Pa]");
    sheet_relative(sheet, c.tangent[1][1][2][2], (kn - kt) / a, 1e-12, "D_2233 [Pa]");
    sheet_relative(sheet, c.tangent[0][1][0][1], (kn + 3.0 * kt) / a, 1e-12, "D_1212 [Pa]");
    sheet_relative(sheet, c.tangent[2][0][0][2], (kn - kt) / a, 1e-12, "D_3113 [Pa]");
    sheet_below(sheet, c.tangent[0][0][0][1] / kn, 1e-13, "D_1112, of kn/m");
    sheet_relative(sheet, c.stress[1][1], -pressure, 1e-11, "sigma_22, 24 contacts of force kn delta per cell [Pa]");
    sheet_relative(sheet, c.fabric[0][0], 1.0 / 3.0, 1e-12, "fabric");
}
