#include "support/grains.h"

#include "base/random.h"
#include "support/numbers.h"
#include "support/values_alone.h"

const char *grain_name(enum grain_kind kind)
{
    static const char *const name[GRAIN_KINDS] = {"ball",        "ellipsoid", "superquadric", "capsule",
                                                  "rounded box", "box",       "polyhedron",   "compound of two balls",
                                                  "cylinder",    "prism",     "SDF-only cone"};
    return name[kind];
}

static pls_shape_id stone(const verify_scene *scene)
{
    enum { POINTS = 14 };
    pls_vec3 point[POINTS];
    for (int k = 0; k < POINTS; ++k) // a spiral over an ellipsoid, uneven enough to have no two faces alike
    {
        const double z = 1.0 - (2.0 * k + 1.0) / POINTS, angle = 2.4 * k, ring = sqrt(1.0 - z * z);
        point[k] = scene->dimension == 3 ? pls_vec(0.42 * ring * cos(angle), 0.36 * ring * sin(angle), 0.3 * z)
                                         : pls_vec(0.42 * cos(0.45 * k), 0.32 * sin(0.45 * k), 0.0);
    }
    return verify_add_hull(scene, point, POINTS);
}

static pls_shape_id column(const verify_scene *scene)
{
    static const pls_vec3 base[5] = {{0.36, 0.02, 0.0}, {0.1, 0.33, 0.0}, {-0.3, 0.2, 0.0}, {-0.27, -0.22, 0.0}, {0.15, -0.3, 0.0}};
    return scene->dimension == 3 ? verify_add_prism(scene, base, 5, 0.5) : verify_add_hull(scene, base, 5);
}

pls_shape_id grain_shape(const verify_scene *scene, enum grain_kind kind)
{
    static const double cone[] = {0.28, 0.15, 0.4};
    switch (kind)
    {
        case GRAIN_BALL: return verify_add_shape(scene, "sphere", NUMBERS(0.35));
        case GRAIN_ELLIPSOID: return verify_add_shape(scene, "ellipsoid", NUMBERS(0.45, 0.35, 0.28, 0.0));
        case GRAIN_SUPERQUADRIC: return verify_add_shape(scene, "superquadric", NUMBERS(0.36, 0.3, 0.33, 0.7, 0.8, 0.0));
        case GRAIN_CAPSULE: return verify_add_shape(scene, "capsule", NUMBERS(0.22, 0.45));
        case GRAIN_SOAP: return verify_add_shape(scene, "box", NUMBERS(0.3, 0.24, 0.2, 0.08));
        case GRAIN_BOX: return verify_add_shape(scene, "box", NUMBERS(0.33, 0.26, 0.22, 0.0));
        case GRAIN_STONE: return stone(scene);
        case GRAIN_CYLINDER:
            return scene->dimension == 3 ? verify_add_shape(scene, "cylinder", NUMBERS(0.26, 0.6, 0.0))
                                         : verify_add_shape(scene, "box", NUMBERS(0.26, 0.3, 0.2, 0.0));
        case GRAIN_PRISM: return column(scene);
        case GRAIN_CONE: return verify_use_shape(scene, &values_cone, &(pls_shape_input){VALUES(cone)});
        default: return verify_add_dumbbell(scene, 0.22, 0.46);
    }
}

pls_body_def grain_def(const verify_scene *scene, pls_shape_id shape, uint64_t number, pls_vec3 position)
{
    pls_random random = pls_random_stream(11, number, PLS_FOR_USER);
    pls_body_def def = verify_body_def(scene, shape, position);
    const double a = pls_random_normal(&random), b = pls_random_normal(&random), c = pls_random_normal(&random),
                 d = pls_random_normal(&random);
    def.orientation = pls_quat_unit(scene->dimension == 3 ? (pls_quat){a, b, c, d} : (pls_quat){a, 0.0, 0.0, b});
    return def;
}
