// failing_allocator.h -- an allocator that fails at a chosen call, to prove that every allocation is checked and nothing leaks.
//
// Install it while the library holds nothing; then arm it as often as needed:
//
//     failing_allocator_install();
//     failing_allocator_arm(3);      // the third allocation from here on fails, once
//     ...
//     failing_allocator_arm(0);      // none fails
//     failing_allocator_remove();
//
// or hand a whole job to `assert_survives_allocation_failures`. Include <cmocka.h> first.
#ifndef PLS_TEST_FAILING_ALLOCATOR_H
#define PLS_TEST_FAILING_ALLOCATOR_H

#include <particls/memory.h>

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

typedef struct failing_allocator
{
    atomic_size_t calls; ///< since it was armed
    atomic_size_t fail_at;
    atomic_bool fired;
} failing_allocator;

static failing_allocator failing_allocator_state;

static inline void *failing_allocator_allocate(void *context, size_t size, size_t alignment)
{
    failing_allocator *state = context;
    if (atomic_fetch_add(&state->calls, 1) + 1 == atomic_load(&state->fail_at))
    {
        atomic_store(&state->fired, true);
        return NULL;
    }
    return aligned_alloc(alignment, size);
}

static inline void failing_allocator_release(void *context, void *block, size_t size)
{
    (void)context;
    (void)size;
    free(block);
}

/// Let the `n`-th allocation from now on fail, once; 0 lets none fail.
static inline void failing_allocator_arm(size_t n)
{
    atomic_store(&failing_allocator_state.calls, 0);
    atomic_store(&failing_allocator_state.fired, false);
    atomic_store(&failing_allocator_state.fail_at, n);
}

/// Whether an allocation has failed since the last arming.
static inline bool failing_allocator_fired(void) { return atomic_load(&failing_allocator_state.fired); }

/// Allocations since the last arming.
static inline size_t failing_allocator_calls(void) { return atomic_load(&failing_allocator_state.calls); }

static inline void failing_allocator_install(void)
{
    failing_allocator_arm(0);
    pls_allocator allocator = {failing_allocator_allocate, failing_allocator_release, &failing_allocator_state};
    assert_int_equal(pls_set_allocator(&allocator), PLS_OK);
}

static inline void failing_allocator_remove(void)
{
    failing_allocator_arm(0);
    assert_int_equal(pls_set_allocator(NULL), PLS_OK);
}

/// Run `job` with its first, second, third ... allocation failing, until it needs no more of them. Each failed run must return
/// OUT_OF_MEMORY with a message, the last must return OK; each must give back all memory it took. The job frees what it made before it
/// returns, also when it fails. Returns how many allocations the job makes.
static inline size_t assert_survives_allocation_failures(pls_status (*job)(void *context), void *context)
{
    size_t held = pls_memory_in_use();
    for (size_t n = 1;; ++n)
    {
        failing_allocator_arm(n);
        pls_status status = job(context);
        bool fired = failing_allocator_fired();
        failing_allocator_arm(0);
        assert_int_equal(pls_memory_in_use(), held);
        if (!fired)
        {
            if (status != PLS_OK) print_error("%s\n", pls_last_message());
            assert_int_equal(status, PLS_OK);
            return n - 1;
        }
        assert_int_equal(status, PLS_OUT_OF_MEMORY);
        assert_true(pls_last_message()[0] != '\0');
    }
}

#endif
