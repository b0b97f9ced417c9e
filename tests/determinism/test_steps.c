// test_steps.c -- how a run is cut into calls changes no bit, nor does the instruction set of the hot loops.
//
// Within one call of pls_world_run steps run into each other: bodies begin the next step while they are at hand. pls_step ends each step.
#include "support/heap.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

enum { LOOKS = 3, STEPS = 130 }; // no multiple of 64, between which the engine looks at its guards

typedef void (*advance)(pls_world *world);

static void in_one_run(pls_world *world) { MUST(pls_world_run(world, STEPS)); }

static void step_by_step(pls_world *world)
{
    for (int k = 0; k < STEPS; ++k) MUST(pls_step(world));
}

static void in_pieces(pls_world *world)
{
    for (uint64_t done = 0, piece = 1; done < STEPS; done += piece, piece = piece % 7 + 1)
    {
        if (piece > STEPS - done) piece = STEPS - done;
        MUST(pls_world_run(world, piece));
    }
}

static void run(const heap_setup *setup, advance go, uint64_t *hashes)
{
    heap h = heap_open(*setup);
    for (int look = 0; look < LOOKS; ++look)
    {
        go(h.scene.world);
        hashes[look] = verify_hash(h.scene.world);
        if (look == 0) heap_change_bodies(&h);
    }
    heap_expect_contacts(&h);
    heap_close(&h);
}

static void each_heap(void (*compare)(const heap_setup *setup))
{
    const heap_setup setups[] = {
        heap_default(3, 800),           heap_dense(3, 1000, 1.0, false), heap_dense(3, 1000, 1.0, true), heap_dense(3, 1000, 2.5, false),
        heap_dense(2, 1600, 2.5, true),
    };
    for (size_t k = 0; k < sizeof setups / sizeof *setups; ++k) compare(&setups[k]);
}

static void compare_calls(const heap_setup *setup)
{
    const advance ways[] = {step_by_step, in_pieces};
    uint64_t reference[LOOKS], hashes[LOOKS];
    run(setup, in_one_run, reference);
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k)
    {
        run(setup, ways[k], hashes);
        assert_memory_equal(hashes, reference, sizeof hashes);
    }
}

/// In a process of its own, because the library looks at the environment once.
static void run_on_isa(const char *isa, const heap_setup *setup, uint64_t *hashes)
{
    int ends[2], status = 1;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
    {
        bool ready = setenv("PARTICLS_ISA", isa, 1) == 0;
        if (ready) run(setup, in_one_run, hashes);
        _exit(ready && write(ends[1], hashes, LOOKS * sizeof *hashes) == (ssize_t)(LOOKS * sizeof *hashes) ? 0 : 1);
    }
    close(ends[1]);
    ssize_t got = read(ends[0], hashes, LOOKS * sizeof *hashes);
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(got, LOOKS * sizeof *hashes);
}

static void compare_isas(const heap_setup *setup)
{
    uint64_t reference[LOOKS], hashes[LOOKS];
    run_on_isa("v2", setup, reference);
    run_on_isa("v3", setup, hashes);
    assert_memory_equal(hashes, reference, sizeof hashes);
    run_on_isa("v4", setup, hashes);
    assert_memory_equal(hashes, reference, sizeof hashes);
}

// Before the other test: a child does not inherit the threads of this process.
static void instruction_set_changes_no_bit(void **state)
{
    (void)state;
    each_heap(compare_isas);
}

static void one_run_many_runs_and_single_steps_give_the_same_bits(void **state)
{
    (void)state;
    each_heap(compare_calls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instruction_set_changes_no_bit),
        cmocka_unit_test(one_run_many_runs_and_single_steps_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
