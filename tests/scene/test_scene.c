// test_scene.c -- loading: values, defaults, overrides, the used scene and the hash.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/scene_file.h"
#include "support/failing_allocator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char full_scene[] =
    "particls: 1\n"
    "title: 'a scene with \"everything\" in it'\n"
    "vars: {kn: 1.0e5, ks: kn/2, omega: 2*pi}\n"
    "materials:\n"
    "  grain: {density: \"1000*(1 + 0.1*T)\", young_modulus: 1.0e9, poisson_ratio: 0.3}\n"
    "  steel: {density: 7800}\n"
    "shapes: {ball: {sphere: {radius: 0.1}}, wall: {plane: }}\n"
    "domain: {periodic: [true, false, false], lower: [-5, 0, 0], upper: [5, 1, 1]}\n"
    "bodies:\n"
    "  - &first {name: a, shape: ball, material: grain, position: [0, 0, 0], velocity: [\"-omega*y\", \"omega*x\", 0]}\n"
    "  - {name: pack, shape: ball, material: grain, place: {random: {count: 20, box: {lower: [1, 0, 0], upper: [3, 2, 2]}, radius: "
    "{uniform: [0.02, "
    "0.05]}}}}\n"
    "  - {name: table, shape: ball, material: steel, place: {csv: {file: bodies.csv}}, lock: [rx, z]}\n"
    "  - {name: floor, shape: wall, material: steel, position: [0, 0, -1], normal: [0, 0, 1], motion: {displacement: [0, 0, "
    "\"0.1*sin(omega*t)\"]}}\n"
    "  - {shape: ball, material: steel, position: [4, 4, 4], orientation: {axis: [0, 0, 1], angle: pi/4}, fixed: true}\n"
    "contact:\n"
    "  - {between: all, law: elastic, kn: \"kn*(1 + 0.1*T)\", ks: ks}\n"
    "  - {between: [grain, grain], law: viscoelastic, kn: kn, ks: ks, cn: 1, cs: 1, friction: 0.3}\n"
    "forces:\n"
    "  - {gravity: [0, 0, -9.81]}\n"
    "  - {field: {acceleration: [0, \"x*t\", 0], where: \"x > 0\", bodies: a}}\n"
    "states:\n"
    "  - {name: T, initial: 1, rate: \"-T\"}\n"
    "  - {of: a, radius: {rate: 0.001}}\n"
    "  - {name: heat, of: pack, each: true, rate: \"vx^2 + T - heat\"}\n"
    "time: {end: 1.0}\n"
    "observe:\n"
    "  - {collection: all, every: 0.1}\n"
    "  - {collection: pack, every: 0.1, volume: {box: {lower: [0, 0, 0], upper: [1, 1, 1]}}, quantities: [porosity, tangent], walls: "
    "false}\n"
    "  - {particle: a, every_steps: 10}\n"
    "  - {particle: a, quantities: [force], every: 0.5, start: 0.25, end: 0.75}\n"
    "  - {frames: vtk, every: 0.5, contacts: true, name: collection_2}\n"
    "  - {checkpoint: {every_steps: 500}}\n";

static const char table[] = "x, y, z, radius\n# two bodies\n0,0,5,0.1\n1,0,5,0.2\n";

static pls_status load_full(const char *override, pls_scene **scene)
{
    PLS_TRY(pls_write_file("bodies.csv", table, strlen(table)));
    return load_text(full_scene, override, scene);
}

static pls_scene *must_load_full(void)
{
    pls_scene *scene;
    if (load_full(NULL, &scene) != PLS_OK) fail_msg("%s", pls_last_message());
    return scene;
}

static void observers_hold_what_the_scene_says(void **state)
{
    (void)state;
    pls_scene *scene = must_load_full();
    size_t count;
    const pls_observer_def *o = pls_scene_observers(scene, &count);
    assert_int_equal(count, 6);
    assert_string_equal(o[0].name, "collection");
    assert_int_equal(o[0].collection.quantities, PLS_MEASURE_STRESS | PLS_MEASURE_COORDINATION | PLS_MEASURE_ENERGY);
    assert_true(o[0].collection.include_walls);
    assert_int_equal(o[0].collection.volume_kind, PLS_VOLUME_BOUNDING_BOX);
    assert_true(o[0].schedule.every == 0.1 && o[0].schedule.every_steps == 0 && o[0].schedule.start == 0.0 && isinf(o[0].schedule.end));
    assert_string_equal(o[1].name, "collection_3"); // collection_2 is given to another one
    assert_string_equal(o[1].collection.group, "pack");
    assert_int_equal(o[1].collection.volume_kind, PLS_VOLUME_BOX);
    assert_true(o[1].collection.upper.z == 1.0 && !o[1].collection.include_walls);
    assert_string_equal(o[2].name, "a");
    assert_int_equal(o[2].schedule.every_steps, 10);
    assert_int_equal(o[2].particle.quantity_count, 3);
    assert_string_equal(o[2].particle.quantities[0], "position");
    assert_string_equal(o[3].name, "a_2");
    assert_true(o[3].schedule.start == 0.25 && o[3].schedule.end == 0.75);
    assert_int_equal(o[4].kind, PLS_OBSERVE_FRAMES);
    assert_true(o[4].frames.contacts);
    assert_int_equal(o[5].kind, PLS_OBSERVE_CHECKPOINT);
    assert_int_equal(o[5].schedule.every_steps, 500);
    pls_scene_free(scene);
}

static void title_end_path_and_inputs_are_told(void **state)
{
    (void)state;
    pls_scene *scene = must_load_full();
    char expected[4096];
    assert_non_null(realpath("bodies.csv", expected));
    assert_string_equal(pls_scene_title(scene), "a scene with \"everything\" in it");
    assert_string_equal(pls_scene_path(scene), "test_scene.yaml");
    assert_true(pls_scene_end_time(scene) == 1.0);
    assert_int_equal(pls_scene_input_count(scene), 1);
    assert_string_equal(pls_scene_input(scene, 0), expected);
    assert_null(pls_scene_input(scene, 1));
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void the_used_scene_loads_to_the_same_scene_from_any_folder(void **state)
{
    (void)state;
    pls_scene *scene = must_load_full(), *again;
    char *text, *second;
    assert_int_equal(pls_scene_used_text(scene, &text), PLS_OK);
    assert_int_equal(pls_make_directory("elsewhere"), PLS_OK);
    assert_int_equal(pls_write_file("elsewhere/used.yaml", text, strlen(text)), PLS_OK);
    if (pls_scene_load("elsewhere/used.yaml", NULL, 0, &again) != PLS_OK) fail_msg("%s\n%s", pls_last_message(), text);
    assert_int_equal(pls_scene_used_text(again, &second), PLS_OK);
    assert_string_equal(text, second);
    assert_true(pls_scene_hash(scene) == pls_scene_hash(again));
    pls_scene_free_text(text);
    pls_scene_free_text(second);
    pls_scene_free(scene);
    pls_scene_free(again);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void the_used_scene_has_values_in_place_of_expressions_and_defaults(void **state)
{
    (void)state;
    pls_scene *scene = must_load_full();
    char *text;
    assert_int_equal(pls_scene_used_text(scene, &text), PLS_OK);
    assert_non_null(strstr(text, "vars: {kn: 100000, ks: 50000, omega: 6.283185307179586}"));
    assert_non_null(strstr(text, "law: viscoelastic, lever: contact_point, solver: depth, faces: auto, tolerance: "));
    assert_non_null(strstr(text, "kn: 100000, ks: 50000, cn: 1"));
    assert_non_null(strstr(text, "time: {end: 1, dt: auto, safety: 0.5, allow_unstable: false, local_damping: 0, relaxation: none}"));
    assert_non_null(strstr(text, "neighbours: {skin: auto, reorder: true}"));
    assert_non_null(strstr(text, "density: \"1000*(1 + 0.1*T)\""));
    assert_non_null(strstr(text, "angle: 0.7853981633974483"));
    pls_scene_free_text(text);
    pls_scene_free(scene);
}

static uint64_t hash_of(const char *text, const char *override)
{
    pls_scene *scene;
    if (load_text(text, override, &scene) != PLS_OK) fail_msg("%s", pls_last_message());
    uint64_t hash = pls_scene_hash(scene);
    pls_scene_free(scene);
    return hash;
}

#define ONE_BODY SCENE_HEAD "bodies:\n  - {name: a, shape: ball, material: grain, position: [0, 0, 0]"

static void the_hash_depends_on_values_and_not_on_how_they_are_written(void **state)
{
    (void)state;
    uint64_t hash = hash_of(ONE_BODY "}\ntime: {end: 2}\n", NULL);
    assert_true(hash == hash_of("# a comment\n" ONE_BODY ", scale: 1}\ntime: {dt: auto, end: 2.0}\n", NULL));
    assert_true(hash == hash_of(ONE_BODY "}\ntime:\n  end: \"1 + 1\"\n", NULL));
    assert_true(hash == hash_of(ONE_BODY "}\ntime: {end: 7}\n", "time.end=2"));
    assert_true(hash != hash_of(ONE_BODY "}\ntime: {end: 2.0000000000000004}\n", NULL));
    assert_true(hash != hash_of(ONE_BODY ", scale: 2}\ntime: {end: 2}\n", NULL));
}

static void the_hash_depends_on_the_contents_of_tables(void **state)
{
    (void)state;
    pls_scene *scene = must_load_full();
    uint64_t hash = pls_scene_hash(scene);
    pls_scene_free(scene);
    const char other[] = "x,y,z,radius\n0,0,5,0.1\n1,0,5,0.3\n";
    assert_int_equal(pls_write_file("bodies.csv", other, strlen(other)), PLS_OK);
    assert_true(hash != hash_of(full_scene, NULL));
}

static void assert_used(const char *override, const char *part)
{
    pls_scene *scene;
    char *text;
    if (load_full(override, &scene) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_int_equal(pls_scene_used_text(scene, &text), PLS_OK);
    if (!strstr(text, part)) fail_msg("%s does not give %s:\n%s", override, part, text);
    pls_scene_free_text(text);
    pls_scene_free(scene);
}

static void overrides_reach_every_kind_of_place(void **state)
{
    (void)state;
    assert_used("time.end=2.5", "end: 2.5,");
    assert_used("time.dt=1e-4", "dt: 0.0001,");
    assert_used("vars.kn=30", "ks: 15,");
    assert_used("bodies[0].scale=2", "scale: 2}");
    assert_used("bodies[pack].place.random.count=21", "count: 21,");
    assert_used("bodies[a].velocity=[1, 2, 3]", "velocity: [1, 2, 3]");
    assert_used("bodies[0].position[2]=7", "position: [0, 0, 7]");
    assert_used("guard.max_overlap=0.5", "guard: {max_overlap: 0.5}");
    assert_used("materials.steel.density=8000", "steel: {density: 8000}");
    assert_used("title=\"x: y\"", "title: \"x: y\"");
}

static void an_override_hits_one_copy_of_an_anchor(void **state)
{
    (void)state;
    const char text[] = SCENE_HEAD "vars: {p: 1}\nbodies:\n"
                                   "  - {name: a, shape: ball, material: grain, position: &p [0, 0, 0]}\n"
                                   "  - {name: b, shape: ball, material: grain, position: *p}\ntime: {end: 1}\n";
    pls_scene *scene;
    char *used;
    if (load_text(text, "bodies[0].position[0]=4", &scene) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_int_equal(pls_scene_used_text(scene, &used), PLS_OK);
    assert_non_null(strstr(used, "name: a, shape: ball, material: grain, position: [4, 0, 0]"));
    assert_non_null(strstr(used, "name: b, shape: ball, material: grain, position: [0, 0, 0]"));
    pls_scene_free_text(used);
    pls_scene_free(scene);
}

static void files_that_are_no_scenes_are_refused(void **state)
{
    (void)state;
    pls_scene *scene;
    assert_int_equal(pls_scene_load("no such file.yaml", NULL, 0, &scene), PLS_NOT_FOUND);
    assert_int_equal(pls_scene_load(".", NULL, 0, &scene), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_scene_load("/dev/zero", NULL, 0, &scene), PLS_INVALID_ARGUMENT);
    FILE *file = fopen("large.yaml", "w");
    assert_non_null(file);
    assert_int_equal(fseek(file, 65L << 20, SEEK_SET), 0);
    fputc('\n', file);
    fclose(file);
    assert_int_equal(pls_scene_load("large.yaml", NULL, 0, &scene), PLS_LIMIT_EXCEEDED);
    remove("large.yaml");
    assert_null(scene);
}

static void aliases_of_aliases_cannot_fill_the_memory(void **state)
{
    (void)state;
    char text[4096] = "particls: 1\na0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int k = 1; k < 12; ++k)
    {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "a%d: &a%d [", k, k);
        for (int j = 0; j < 10; ++j)
        {
            used = strlen(text);
            snprintf(text + used, sizeof text - used, "%s*a%d", j ? ", " : "", k - 1);
        }
        strcat(text, "]\n");
    }
    pls_scene *scene;
    assert_int_equal(load_text(text, NULL, &scene), PLS_LIMIT_EXCEEDED);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void deep_nesting_is_refused(void **state)
{
    (void)state;
    char text[2048] = "particls: 1\ntitle: ";
    for (int k = 0; k < 900; ++k) strcat(text, "[");
    pls_scene *scene;
    assert_int_equal(load_text(text, NULL, &scene), PLS_SCENE);
}

static pls_status load_job(void *context)
{
    const char *override = context;
    pls_scene *scene;
    pls_status status = pls_scene_load("test_scene.yaml", &override, 1, &scene);
    char *text = NULL;
    if (status == PLS_OK) status = pls_scene_used_text(scene, &text);
    pls_scene_free_text(text);
    pls_scene_free(scene);
    return status;
}

static void loading_survives_allocation_failures(void **state)
{
    (void)state;
    pls_scene_free(must_load_full());
    failing_allocator_install();
    char override[] = "bodies[0].velocity=[1, 2, 3]";
    assert_true(assert_survives_allocation_failures(load_job, override) > 50);
    failing_allocator_remove();
}

/// Every third prefix of a good scene, and the scene with every third byte replaced, loads or fails with a message.
static void mangled_scenes_never_crash(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("bodies.csv", table, strlen(table)), PLS_OK);
    const char bytes[] = "{}[]:,\"'&*-#\n \tx0=";
    size_t size = strlen(full_scene);
    char *text = malloc(size + 1);
    assert_non_null(text);
    for (size_t k = 0; k < 2 * size; k += 3)
    {
        memcpy(text, full_scene, size + 1);
        if (k < size)
            text[k] = '\0';
        else
            text[k - size] = bytes[(k * 7) % (sizeof bytes - 1)];
        pls_scene *scene;
        FILE *file = fopen("mangled.yaml", "w");
        assert_non_null(file);
        fputs(text, file);
        fclose(file);
        pls_status status = pls_scene_load("mangled.yaml", NULL, 0, &scene);
        assert_true(status == PLS_OK || strlen(pls_last_message()) > 0);
        pls_scene_free(scene);
        assert_int_equal(pls_memory_in_use(), 0);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(observers_hold_what_the_scene_says),
        cmocka_unit_test(title_end_path_and_inputs_are_told),
        cmocka_unit_test(the_used_scene_loads_to_the_same_scene_from_any_folder),
        cmocka_unit_test(the_used_scene_has_values_in_place_of_expressions_and_defaults),
        cmocka_unit_test(the_hash_depends_on_values_and_not_on_how_they_are_written),
        cmocka_unit_test(the_hash_depends_on_the_contents_of_tables),
        cmocka_unit_test(overrides_reach_every_kind_of_place),
        cmocka_unit_test(an_override_hits_one_copy_of_an_anchor),
        cmocka_unit_test(files_that_are_no_scenes_are_refused),
        cmocka_unit_test(aliases_of_aliases_cannot_fill_the_memory),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(loading_survives_allocation_failures),
        cmocka_unit_test(mangled_scenes_never_crash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
