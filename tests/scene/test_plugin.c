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
#define TEXT_OF(x)   #x
#define AS_TEXT(x)   TEXT_OF(x)
#define THIS_VERSION AS_TEXT(PLS_API_VERSION)
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

/// A plugin that tells one lie of many, said by its number in the environment: compiled once for all of them.
static const char liar[] = PLUGIN_START PLUGIN_API
    "#include <stdlib.h>\n"
    "static pls_status push(void *c, const pls_force_batch *b) { (void)c; (void)b; return PLS_OK; }\n"
    "static pls_status look(const pls_observer_view *v, const double *m, double *row) { (void)v; (void)m; row[0] = 1; return PLS_OK; }\n"
    "static pls_status note(const pls_observer_view *v, double *m) { (void)v; m[0] = 1; return PLS_OK; }\n"
    "static const pls_observer_column one[] = {{.name = \"one\", .unit = \"m\"}, {0}}, two[] = {{.name = \"one\"}, {.name = \"one\"}, "
    "{0}},\n"
    "  time[] = {{.name = \"time\"}, {0}}, comma[] = {{.name = \"a,b\"}, {0}}, unit[] = {{.name = \"a\", .unit = \"m,s\"}, {0}};\n"
    "#define ROW .minimum = -INFINITY, .maximum = INFINITY\n"
    "static const pls_parameter twice[] = {{.name = \"a\", ROW}, {.name = \"a\", ROW}, {0}}, bodies[] = {{.name = \"bodies\", ROW}, {0}},\n"
    "  odd[] = {{.name = \"a b\", ROW}, {0}}, flat[] = {{.name = \"a\", .components = 2, ROW}, {0}}, points[] = {{.name = \"a\", .kind = "
    "PLS_PARAMETER_POINTS}, {0}},\n"
    "  low[] = {{.name = \"a\", .initial = -1, .maximum = 1}, {0}}, law[] = {{.name = \"between\", ROW}, {0}};\n"
    "#define FORCE(...) host->add_force(host, &(pls_force_ops){.api_version = PLS_API_VERSION, .name = \"push\", .evaluate = push, "
    "__VA_ARGS__})\n"
    "#define EYE(...) host->add_observer(host, &(pls_observer_ops){.api_version = PLS_API_VERSION, .name = \"eye\", .columns = one, "
    ".look = look, __VA_ARGS__})\n"
    "pls_status particls_plugin(pls_plugin_host *host)\n"
    "{ switch (atoi(getenv(\"LIE\"))) {\n"
    "  case 0: return host->add_force(host, NULL);\n"
    "  case 1: return FORCE(.evaluate = NULL);\n"
    "  case 2: return FORCE(.api_version = 2);\n"
    "  case 3: return FORCE(.name = NULL);\n"
    "  case 4: return FORCE(.name = \"gravity\");\n"
    "  case 5: return FORCE(.name = \"my-push\");\n"
    "  case 6: return FORCE(.parameters = twice);\n"
    "  case 7: return FORCE(.parameters = bodies);\n"
    "  case 8: return FORCE(.parameters = odd);\n"
    "  case 9: return FORCE(.parameters = flat);\n"
    "  case 10: return FORCE(.parameters = points);\n"
    "  case 11: return FORCE(.parameters = low);\n"
    "  case 12: { pls_status once = FORCE(.name = \"same\"); return once == PLS_OK ? FORCE(.name = \"same\") : once; }\n"
    "  case 13: return host->add_observer(host, NULL);\n"
    "  case 14: return EYE(.look = NULL);\n"
    "  case 15: return EYE(.columns = NULL);\n"
    "  case 16: return EYE(.columns = two);\n"
    "  case 17: return EYE(.columns = time);\n"
    "  case 18: return EYE(.columns = comma);\n"
    "  case 19: return EYE(.columns = unit);\n"
    "  case 20: return EYE(.memory = 1);\n"
    "  case 21: return EYE(.update = note);\n"
    "  case 22: return EYE(.memory = 65, .update = note);\n"
    "  case 23: return EYE(.name = \"every\");\n"
    "  case 24: return EYE(.api_version = 2);\n"
    "  case 25: return host->add_law(host, &(pls_law_ops){.api_version = PLS_API_VERSION, .name = \"law\", .parameters = law});\n"
    "  default: return PLS_OK; } }\n";

static void every_lie_of_a_plugin_is_found_when_it_is_loaded(void **state)
{
    (void)state;
    static const char *const told[] = {
        "add_force was called with null",
        "the force 'push' lacks its evaluate",
        "the force 'push' is made for version 2 of the plugin interface; this is version " THIS_VERSION,
        "a force has no name",
        "'gravity' is a key of 'forces' already: give the force another name",
        "'my-push' cannot be the name of a force",
        "the force 'push' has two parameters 'a'",
        "the force 'push' has a parameter 'bodies', which is a key of scenes there",
        "the force 'push' has a parameter 'a b'",
        "the parameter 'a' of the force 'push' has 2 components",
        "the parameter 'a' of the force 'push' is no number; only shapes take others",
        "the parameter 'a' of the force 'push' has the default -1, but values from 0 to 1",
        "the force \"same\" is already registered",
        "add_observer was called with null",
        "the observer 'eye' lacks one of name, look, columns",
        "the observer 'eye' lacks one of name, look, columns",
        "the observer 'eye' has two columns 'one'",
        "the observer 'eye' has a column 'time'; every series has that by itself",
        "the observer 'eye' has a column 'a,b'",
        "the observer 'eye' has a column 'a' in 'm,s', which cannot be a unit",
        "the observer 'eye' has memory, but no update that would fill it",
        "the observer 'eye' has update, but no memory that it could bring up to date",
        "the observer 'eye' wants to remember 65 numbers; at most 64 are possible",
        "'every' is a key of 'observe' already: give the observer another name",
        "the observer 'eye' is made for version 2 of the plugin interface; this is version " THIS_VERSION,
        "the contact law 'law' has a parameter 'between', which is a key of scenes there",
    };
    compile(liar);
    for (size_t k = 0; k <= sizeof told / sizeof *told; ++k)
    {
        char number[32];
        snprintf(number, sizeof number, "%zu", k);
        assert_int_equal(setenv("LIE", number, 1), 0);
        pls_scene *scene;
        pls_status status = load_text(SCENE_HEAD BODIES "plugins: [plugin.so]\n", NULL, &scene);
        if (k == sizeof told / sizeof *told) // the truth
        {
            assert_int_equal(status, PLS_OK);
            pls_scene_free(scene);
            break;
        }
        assert_int_equal(status, PLS_SCENE);
        if (!strstr(pls_last_message(), told[k]) || !strstr(pls_last_message(), "test_scene.yaml:8:11: "))
            fail_msg("lie %zu: '%s' is not in: %s", k, told[k], pls_last_message());
        assert_int_equal(pls_memory_in_use(), 0);
    }
}

static void what_a_plugin_holds_can_be_read(void **state)
{
    (void)state;
    char *text;
    assert_int_equal(pls_plugin_reference(PLS_PLUGIN_DIR "/template.so", &text), PLS_OK);
    static const char *const parts[] = {"### my_law\n",
                                        "### my_shape\n",
                                        "### my_force\n",
                                        "### my_observer\n",
                                        "| `centre` | vector | m | 0 | ",
                                        "| `largest_speed` | m/s | "};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k)
        if (!strstr(text, parts[k])) fail_msg("'%s' is not in: %s", parts[k], text);
    pls_scene_free_text(text);
    assert_int_equal(pls_plugin_reference(PLS_SOURCE_DIR "/tests/scene/golden/not-a-plugin.so", &text), PLS_SCENE);
    assert_non_null(strstr(pls_last_message(), "cannot be loaded"));
    assert_int_equal(pls_memory_in_use(), 0);
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
        cmocka_unit_test(every_lie_of_a_plugin_is_found_when_it_is_loaded),
        cmocka_unit_test(what_a_plugin_holds_can_be_read),
        cmocka_unit_test(the_hash_does_not_change_when_a_plugin_is_compiled_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
