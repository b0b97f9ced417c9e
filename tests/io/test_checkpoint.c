// test_checkpoint.c -- checkpoints: what was saved comes back bit for bit, and any damage is found.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "io/checkpoint.h"
#include "support/failing_allocator.h"
#include "support/small_scene.h"

#include <signal.h>
#include <string.h>
#include <sys/resource.h>

static const char path[] = "state.h5";
static const char run_text[] = "end 1\nseries 12 stress\n";

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

static char *read_bytes(const char *name, size_t *size)
{
    char *bytes;
    must(pls_read_file(name, &bytes, size));
    return bytes;
}

static pls_world *new_world(void)
{
    pls_scene *scene;
    pls_world *world;
    must(small_scene_load(NULL, &scene));
    must(pls_scene_build(scene, &world));
    pls_scene_free(scene);
    return world;
}

/// A lively world after some steps, saved as `path`.
static pls_world *saved_world(void)
{
    pls_world *world = new_world();
    must(pls_world_run(world, 200));
    must(pls_checkpoint_write(path, world, 77, run_text));
    return world;
}

static uint64_t hash_of(pls_world *world)
{
    uint64_t hash;
    must(pls_world_state_hash(world, &hash));
    return hash;
}

static void a_restored_world_goes_on_with_the_same_bits(void **state)
{
    (void)state;
    pls_world *first = saved_world();
    must(pls_world_run(first, 300));

    pls_world *second = new_world();
    pls_checkpoint checkpoint = {0};
    must(pls_checkpoint_open(&checkpoint, path));
    assert_int_equal(checkpoint.scene_hash, 77);
    assert_string_equal(checkpoint.run, run_text);
    assert_int_equal(checkpoint.header.step, 200);
    assert_string_equal(checkpoint.version, PLS_VERSION_TEXT);
    must(pls_checkpoint_restore(&checkpoint, second));
    pls_checkpoint_close(&checkpoint);
    must(pls_world_run(second, 300));
    assert_int_equal(hash_of(first), hash_of(second));
    pls_world_destroy(first);
    pls_world_destroy(second);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void numbers_that_are_free_come_back_with_their_generations(void **state)
{
    (void)state;
    pls_world *first = saved_world(), *second = new_world();
    size_t numbers, restored;
    pls_world_rows_by_number(first, &numbers);
    pls_body_id last = {(uint32_t)numbers, 1};
    must(pls_world_remove_body(first, last));
    must(pls_checkpoint_write(path, first, 77, run_text));
    pls_checkpoint checkpoint = {0};
    must(pls_checkpoint_open(&checkpoint, path));
    must(pls_checkpoint_restore(&checkpoint, second));
    pls_checkpoint_close(&checkpoint);
    pls_world_rows_by_number(second, &restored);
    assert_int_equal(restored, numbers);
    pls_body_motion motion;
    assert_int_equal(pls_body_get(second, last, &motion), PLS_STALE_ID);
    assert_int_equal(hash_of(first), hash_of(second));
    pls_world_destroy(first);
    pls_world_destroy(second);
}

static void equal_states_give_equal_bytes(void **state)
{
    (void)state;
    pls_world *first = saved_world();
    size_t size;
    char *bytes = read_bytes(path, &size);
    pls_world *second = saved_world();
    must(pls_checkpoint_write("again.h5", second, 77, run_text));
    size_t size_again;
    char *again = read_bytes("again.h5", &size_again);
    assert_int_equal(size, size_again);
    assert_memory_equal(bytes, again, size);
    pls_release(&bytes);
    pls_release(&again);
    pls_world_destroy(first);
    pls_world_destroy(second);
}

static pls_status status_of(const char *bytes, size_t size)
{
    must(pls_write_file("damaged.h5", bytes, size));
    pls_checkpoint checkpoint = {0};
    pls_status status = pls_checkpoint_open(&checkpoint, "damaged.h5");
    pls_checkpoint_close(&checkpoint);
    return status;
}

static void every_flipped_byte_is_found(void **state)
{
    (void)state;
    pls_world *world = saved_world();
    size_t size;
    char *bytes = read_bytes(path, &size);
    assert_int_equal(status_of(bytes, size), PLS_OK);
    for (size_t k = 0; k < size; k += k < 700 ? 13 : 397)
    {
        bytes[k] = (char)(bytes[k] ^ 1 << (k % 8));
        assert_int_equal(status_of(bytes, size), PLS_CORRUPT);
        assert_non_null(strstr(pls_last_message(), "damaged.h5"));
        bytes[k] = (char)(bytes[k] ^ 1 << (k % 8));
    }
    pls_release(&bytes);
    pls_world_destroy(world);
}

static void a_file_cut_off_anywhere_is_found(void **state)
{
    (void)state;
    pls_world *world = saved_world();
    size_t size;
    char *bytes = read_bytes(path, &size);
    const size_t lengths[] = {0, 1, 100, 511, 512, 513, 2048, size / 2, size - 1};
    for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; ++k) assert_int_equal(status_of(bytes, lengths[k]), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "cut off"));
    pls_release(&bytes);
    pls_world_destroy(world);
}

static void other_files_are_told_from_checkpoints(void **state)
{
    (void)state;
    pls_checkpoint checkpoint = {0};
    assert_int_equal(pls_checkpoint_open(&checkpoint, "missing.h5"), PLS_NOT_FOUND);
    assert_int_equal(pls_checkpoint_open(&checkpoint, "."), PLS_IO);
    char text[600];
    memset(text, 'x', sizeof text);
    assert_int_equal(status_of(text, sizeof text), PLS_CORRUPT);
    static const char newer[] = "particls checkpoint, format 9\nbytes behind these 512: 88\n";
    memcpy(text, newer, sizeof newer - 1);
    assert_int_equal(status_of(text, sizeof text), PLS_VERSION);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_full_disk_leaves_the_old_checkpoint(void **state)
{
    (void)state;
    pls_world *world = saved_world();
    size_t size;
    char *bytes = read_bytes(path, &size);
    must(pls_world_run(world, 1));
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_IGN);
    const size_t room[] = {0, 300, 1000, 5000, size / 2, size - 10};
    for (size_t k = 0; k < sizeof room / sizeof room[0]; ++k)
    {
        struct rlimit small = {room[k], before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        pls_status status = pls_checkpoint_write(path, world, 77, run_text);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(status, PLS_DISK_FULL);
        assert_non_null(strstr(pls_last_message(), path));
        assert_false(pls_file_exists("state.h5.tmp"));
        size_t size_now;
        char *now = read_bytes(path, &size_now);
        assert_int_equal(size_now, size);
        assert_memory_equal(now, bytes, size);
        pls_release(&now);
    }
    must(pls_checkpoint_write(path, world, 77, run_text)); // room again
    pls_checkpoint checkpoint = {0};
    must(pls_checkpoint_open(&checkpoint, path));
    assert_int_equal(checkpoint.header.step, 201);
    pls_checkpoint_close(&checkpoint);
    pls_release(&bytes);
    pls_world_destroy(world);
}

static pls_status save_and_restore(void *context)
{
    pls_world *world = context;
    PLS_TRY(pls_checkpoint_write(path, world, 77, run_text));
    pls_checkpoint checkpoint = {0};
    PLS_TRY(pls_checkpoint_open(&checkpoint, path));
    size_t count;
    const pls_field *field = pls_fields(PLS_TABLE_BODIES, &count);
    char *data = NULL;
    pls_status status = pls_allocate(&data, checkpoint.header.rows[PLS_TABLE_BODIES], 64, "a field");
    if (status == PLS_OK) status = pls_checkpoint_read_field(&checkpoint, PLS_TABLE_BODIES, field, data);
    pls_release(&data);
    pls_checkpoint_close(&checkpoint);
    return status;
}

static void every_failing_allocation_is_an_error(void **state)
{
    (void)state;
    failing_allocator_install();
    pls_world *world = saved_world();
    must(save_and_restore(world)); // scratch memory that the world keeps is there from here on
    assert_true(assert_survives_allocation_failures(save_and_restore, world) > 5);
    pls_world_destroy(world);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_restored_world_goes_on_with_the_same_bits),
        cmocka_unit_test(numbers_that_are_free_come_back_with_their_generations),
        cmocka_unit_test(equal_states_give_equal_bytes),
        cmocka_unit_test(every_flipped_byte_is_found),
        cmocka_unit_test(a_file_cut_off_anywhere_is_found),
        cmocka_unit_test(other_files_are_told_from_checkpoints),
        cmocka_unit_test(a_full_disk_leaves_the_old_checkpoint),
        cmocka_unit_test(every_failing_allocation_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
