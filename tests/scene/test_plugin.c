// test_plugin.c -- plugins: compiled here, loaded by a scene, and every way in which one can be no good.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/scene_file.h"

#include <stdio.h>
#include <stdlib.h>

static const char good_plugin[] =
    "#include <particls/plugin.h>\n"
    "static const pls_parameter parameters[] = {\n"
    "    {.name = \"kn\", .unit = \"N/m\", .meaning = \"stiffness\", .initial = PLS_REQUIRED, .maximum = INFINITY, .open_minimum = true},\n"
    "    {.name = NULL}};\n"
    "static pls_status prepare(const double *v, const pls_material_values *a, const pls_material_values *b, double *c)\n"
    "{ (void)a; (void)b; c[0] = v[0]; return PLS_OK; }\n"
    "static void evaluate(const pls_law_batch *b)\n"
    "{ for (size_t k = 0; k < b->count; ++k) { b->normal_force[k] = b->constants[0] * b->delta[k] * b->delta[k]; b->shear_force_x[k] = 0;\n"
    "  b->shear_force_y[k] = 0; b->shear_force_z[k] = 0; b->damping_power[k] = 0; b->slip_work[k] = 0; } }\n"
    "static void stiffness(const double *c, const pls_contact_point *p, pls_contact_stiffness *out)\n"
    "{ *out = (pls_contact_stiffness){2 * c[0] * p->delta, 0, 0, 0}; }\n"
    "static void energy(const double *c, const pls_contact_point *p, double *n, double *s)\n"
    "{ *n = c[0] * p->delta * p->delta * p->delta / 3; *s = 0; }\n"
    "static const pls_law_ops law = {.api_version = PLS_API_VERSION, .name = \"square\", .meaning = \"kn delta^2\", .parameters = "
    "parameters,\n"
    "    .prepare = prepare, .evaluate = evaluate, .stiffness = stiffness, .energy = energy};\n"
    "const uint32_t particls_plugin_api = PLS_API_VERSION;\n"
    "pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &law); }\n";

/// Compile a plugin of this source to plugin.so.
static void compile(const char *source)
{
    const char *compiler = getenv("CC");
    char command[2048];
    assert_int_equal(pls_write_file("plugin.c", source, strlen(source)), PLS_OK);
    remove("plugin.so");
    snprintf(command, sizeof command, "%s -std=gnu17 -shared -fPIC -O1 -I%s/include plugin.c -o plugin.so", compiler ? compiler : "cc",
             PLS_SOURCE_DIR);
    assert_int_equal(system(command), 0);
}

#define BODIES                                                                        \
    "bodies:\n"                                                                       \
    "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], fixed: true}\n" \
    "  - {name: b, shape: ball, material: grain, position: [0.18, 0, 0]}\n"           \
    "time: {end: 1, dt: 1.0e-3}\n"

static void a_law_of_a_plugin_works_like_a_built_in_one(void **state)
{
    (void)state;
    compile(good_plugin);
    pls_scene *scene = must_load(SCENE_HEAD BODIES "plugins: [./plugin.so]\ncontact:\n  - {between: all, law: square, kn: 5000}\n");
    pls_world *world = must_build(scene);
    if (pls_world_prepare(world) != PLS_OK) fail_msg("%s", pls_last_message());
    double force = body_value(world, "force", 1, 0);
    assert_true(fabs(force - 5000 * 0.02 * 0.02) < 1e-12);
    pls_world_destroy(world);
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void assert_refused(const char *source, const char *part)
{
    compile(source);
    pls_scene *scene;
    pls_status status = load_text(SCENE_HEAD BODIES "plugins: [plugin.so]\n", NULL, &scene);
    assert_int_equal(status, PLS_SCENE);
    if (!strstr(pls_last_message(), part) || !strstr(pls_last_message(), "test_scene.yaml:8:11: ")) fail_msg("%s", pls_last_message());
    assert_int_equal(pls_memory_in_use(), 0);
}

#define PLUGIN_START "#include <particls/plugin.h>\n"
#define PLUGIN_API   "const uint32_t particls_plugin_api = PLS_API_VERSION;\n"

static void plugins_that_are_no_good_are_refused_with_the_reason(void **state)
{
    (void)state;
    assert_refused("int nothing;\n", "does not export 'particls_plugin_api'");
    assert_refused(PLUGIN_START PLUGIN_API, "does not export 'particls_plugin'");
    assert_refused("#include <stdint.h>\nconst uint32_t particls_plugin_api = 99;\n", "made for version 99 of the plugin interface");
    assert_refused(PLUGIN_START PLUGIN_API
                   "pls_status particls_plugin(pls_plugin_host *host) { (void)host; return pls_fail(PLS_USER, \"out of order\"); }\n",
                   "out of order");
    assert_refused(PLUGIN_START PLUGIN_API "static const pls_law_ops law = {.api_version = PLS_API_VERSION, .name = \"empty\"};\n"
                                           "pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &law); }\n",
                   "the contact law 'empty' lacks one of prepare, evaluate, stiffness, energy");
    assert_refused(PLUGIN_START PLUGIN_API "static const pls_law_ops law = {.api_version = 7, .name = \"old\"};\n"
                                           "pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &law); }\n",
                   "the contact law 'old' is made for version 7");
    assert_refused(PLUGIN_START PLUGIN_API "static double sdf(const pls_shape *s, pls_vec3 X) { (void)s; return X.x; }\n"
                                           "static const pls_shape_ops shape = {.api_version = PLS_API_VERSION, .name = \"sphere\", .sdf = "
                                           "sdf, .in_3d = true, .unbounded = true};\n"
                                           "pls_status particls_plugin(pls_plugin_host *host) { return host->add_shape(host, &shape); }\n",
                   "already registered");
    assert_refused(PLUGIN_START PLUGIN_API
                   "extern int not_there(void);\n"
                   "pls_status particls_plugin(pls_plugin_host *host) { (void)host; return not_there() ? PLS_OK : PLS_USER; }\n",
                   "undefined symbol: not_there");
}

static void the_hash_does_not_change_when_a_plugin_is_compiled_anew(void **state)
{
    (void)state;
    const char text[] = SCENE_HEAD BODIES "plugins: [./plugin.so]\ncontact:\n  - {between: all, law: square, kn: 5000}\n";
    compile(good_plugin);
    pls_scene *scene = must_load(text);
    uint64_t hash = pls_scene_hash(scene);
    pls_scene_free(scene);
    char other[sizeof good_plugin + 32];
    snprintf(other, sizeof other, "%sint more = 1;\n", good_plugin);
    compile(other);
    scene = must_load(text);
    assert_true(hash == pls_scene_hash(scene));
    pls_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_law_of_a_plugin_works_like_a_built_in_one),
        cmocka_unit_test(plugins_that_are_no_good_are_refused_with_the_reason),
        cmocka_unit_test(the_hash_does_not_change_when_a_plugin_is_compiled_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
