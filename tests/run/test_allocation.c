// test_allocation.c -- every allocation of a run and of a resumed run may fail: each time OUT_OF_MEMORY, nothing leaks, and the directory stays good.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/failing_allocator.h"
#include "support/small_scene.h"

#include <particls/run.h>
#include <stdio.h>

static const char directory[] = "starved";

static pls_run_def run_def(void)
{
    pls_run_def def = pls_default_run_def();
    def.directory = directory;
    def.overwrite = true;
    return def;
}

static pls_status run(void *context)
{
    pls_run_def def = run_def();
    return pls_run_scene(context, &def);
}

static pls_status resume(void *context)
{
    (void)context;
    pls_run_def def = run_def();
    def.until = 0.0011; // one step more; a finished run would be left alone
    remove("starved/summary.json");
    return pls_run_resume(&def);
}

static void every_failing_allocation_of_a_run_is_an_error(void **state)
{
    (void)state;
    failing_allocator_install();
    pls_set_threads(1);
    pls_scene *scene;
    assert_int_equal(small_scene_load("time.end=0.001", &scene), PLS_OK);
    assert_int_equal(run(scene), PLS_OK);
    size_t allocations = assert_survives_allocation_failures(run, scene);
    print_message("%zu allocations of a run\n", allocations);
    assert_true(allocations > 100);
    pls_scene_free(scene);
    failing_allocator_remove();
}

static void every_failing_allocation_of_a_resumed_run_is_an_error(void **state)
{
    (void)state;
    failing_allocator_install();
    pls_scene *scene;
    assert_int_equal(small_scene_load("time.end=0.001", &scene), PLS_OK);
    assert_int_equal(run(scene), PLS_OK);
    pls_scene_free(scene);
    size_t allocations = assert_survives_allocation_failures(resume, NULL);
    print_message("%zu allocations of a resumed run\n", allocations);
    assert_true(allocations > 100);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failing_allocation_of_a_run_is_an_error),
        cmocka_unit_test(every_failing_allocation_of_a_resumed_run_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
