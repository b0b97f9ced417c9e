// test_run.c -- runs in their directories: what is there afterwards, whatever happened on the way.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "run/run_state.h"
#include "support/small_scene.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

// ---- telling runs apart --------------------------------------------------------------------------------------------

/// Names of the files of a folder, one after the other, sorted by their hash so that the order of reading does not matter.
typedef struct folder_hash
{
    uint64_t sum; ///< of the hashes of name and content
    size_t count;
} folder_hash;

static uint64_t hash_text(const char *text, size_t size)
{
    uint64_t hash = UINT64_C(14695981039346656037); // FNV-1a, not the library's
    for (size_t k = 0; k < size; ++k) hash = (hash ^ (unsigned char)text[k]) * UINT64_C(1099511628211);
    return hash;
}

static pls_status add_file(void *context, const char *path, const char *name)
{
    folder_hash *folder = context;
    char *text;
    size_t size;
    PLS_TRY(pls_read_file(path, &text, &size));
    folder->sum += hash_text(text, size) ^ (3 * hash_text(name, strlen(name)));
    ++folder->count;
    pls_release(&text);
    return PLS_OK;
}

static folder_hash hash_folder(const char *directory, const char *folder)
{
    folder_hash hash = {0};
    must(pls_run_each_file(directory, folder, add_file, &hash));
    return hash;
}

static void expect_same_folder(const char *directory, const char *reference, const char *folder)
{
    folder_hash a = hash_folder(directory, folder);
    folder_hash b = hash_folder(reference, folder);
    assert_true(b.count > 0);
    assert_int_equal(a.count, b.count);
    assert_int_equal(a.sum, b.sum);
}

static void expect_same_results(const char *directory, const char *reference)
{
    expect_same_folder(directory, reference, "series");
    expect_same_folder(directory, reference, "frames");
    expect_same_folder(directory, reference, "checkpoint");
}

static char *summary_of(const char *directory)
{
    char path[PLS_PATH_SIZE];
    char *text;
    size_t size;
    must(pls_run_path(path, directory, "summary.json"));
    must(pls_read_file(path, &text, &size));
    return text;
}

static bool exists(const char *directory, const char *name)
{
    char path[PLS_PATH_SIZE];
    must(pls_run_path(path, directory, "%s", name));
    return pls_file_exists(path);
}

// ---- running -------------------------------------------------------------------------------------------------------

/// Breaks in at a step: through the progress-free door of a user's observer.
typedef struct breaker
{
    uint64_t step;
    volatile int flag;  ///< set at that step
    pls_status failure; ///< returned at that step
    char events[4096];
} breaker;

static pls_status break_in(void *context, pls_world *world)
{
    breaker *b = context;
    if (pls_world_step_number(world) != b->step) return PLS_OK;
    b->flag = 1;
    return b->failure == PLS_OK ? PLS_OK : pls_fail(b->failure, "the breaker broke the run at step %" PRIu64, b->step);
}

static void note_event(void *context, const pls_progress *progress)
{
    breaker *b = context;
    if (!progress->event) return;
    size_t used = strlen(b->events);
    snprintf(b->events + used, sizeof b->events - used, "%s\n", progress->event);
}

static pls_observer_def breaker_observer(breaker *b)
{
    return (pls_observer_def){
        .name = "breaker", .kind = PLS_OBSERVE_USER, .schedule = {.every_steps = 1, .end = INFINITY}, .function = break_in, .context = b};
}

static pls_run_def run_def(const char *directory, breaker *b, const pls_observer_def *observer)
{
    pls_run_def def = pls_default_run_def();
    def.directory = directory;
    def.overwrite = true;
    def.progress = note_event;
    def.context = b;
    def.interrupt = &b->flag;
    def.observers = observer;
    def.observer_count = observer ? 1 : 0;
    return def;
}

/// Run the small scene into `directory`, breaking in at a step (UINT64_MAX: never).
static pls_status run_broken(const char *directory, uint64_t step, pls_status failure)
{
    breaker b = {.step = step, .failure = failure};
    pls_observer_def observer = breaker_observer(&b);
    pls_run_def def = run_def(directory, &b, &observer);
    pls_scene *scene;
    must(small_scene_load(NULL, &scene));
    pls_status status = pls_run_scene(scene, &def);
    pls_scene_free(scene);
    return status;
}

static pls_status resume(const char *directory, breaker *b)
{
    pls_run_def def = run_def(directory, b, NULL);
    return pls_run_resume(&def);
}

static int make_reference(void **state)
{
    (void)state;
    must(run_broken("reference", UINT64_MAX, PLS_OK));
    return 0;
}

// ---- tests ---------------------------------------------------------------------------------------------------------

static void a_finished_run_has_scene_series_frames_checkpoints_and_summary(void **state)
{
    (void)state;
    assert_true(exists("reference", "scene.used.yaml"));
    assert_true(exists("reference", "series/heap.csv"));
    assert_true(exists("reference", "frames/picture_000000.vtp"));
    assert_true(exists("reference", "frames/picture_000005.vtp")); // 0 to 0.1 s every 0.02 s
    assert_false(exists("reference", "frames/picture_000006.vtp"));
    assert_true(exists("reference", "frames/picture.contacts_000005.vtp"));
    assert_true(exists("reference", "frames/picture.pvd"));
    assert_true(exists("reference", "checkpoint/000000750.h5")); // the last two of 0, 250, 500, 750, 1000
    assert_true(exists("reference", "checkpoint/000001000.h5"));
    assert_int_equal(hash_folder("reference", "checkpoint").count, 2);
    char *summary = summary_of("reference");
    assert_non_null(strstr(summary, "\"finished\": true"));
    assert_non_null(strstr(summary, "\"steps\": 1000,"));
    assert_null(strstr(summary, "nan"));
    pls_release(&summary);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void an_interrupted_run_ends_as_if_it_had_not_been(void **state)
{
    (void)state;
    const uint64_t steps[] = {0, 1, 249, 250, 251, 777, 999};
    for (size_t k = 0; k < sizeof steps / sizeof steps[0]; ++k)
    {
        breaker quiet = {0};
        assert_int_equal(run_broken("interrupted", steps[k], PLS_OK), PLS_INTERRUPTED);
        assert_non_null(strstr(pls_last_message(), "particls resume"));
        char *summary = summary_of("interrupted");
        assert_non_null(strstr(summary, "\"finished\": false"));
        pls_release(&summary);
        must(resume("interrupted", &quiet));
        expect_same_results("interrupted", "reference");
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_failed_run_keeps_its_series_says_why_and_can_go_on(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("failed", 613, PLS_USER), PLS_USER);
    assert_non_null(strstr(pls_last_message(), "broke the run at step 613"));
    char *summary = summary_of("failed");
    assert_non_null(strstr(summary, "\"finished\": false"));
    assert_non_null(strstr(summary, "broke the run at step 613"));
    pls_release(&summary);
    assert_true(exists("failed", "checkpoint/000000500.h5"));
    must(resume("failed", &quiet));
    assert_non_null(strstr(quiet.events, "going on from the checkpoint at t = 0.05 s"));
    expect_same_results("failed", "reference");
}

static void flip_byte(const char *path, size_t at)
{
    char *bytes;
    size_t size;
    must(pls_read_file(path, &bytes, &size));
    bytes[at % size] = (char)(bytes[at % size] ^ 0x10);
    must(pls_write_file(path, bytes, size));
    pls_release(&bytes);
}

static void a_damaged_checkpoint_falls_back_to_the_one_before(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("damaged", 613, PLS_USER), PLS_USER);
    flip_byte("damaged/checkpoint/000000500.h5", 5000);
    must(resume("damaged", &quiet));
    assert_non_null(strstr(quiet.events, "damaged/checkpoint/000000500.h5\" is damaged"));
    assert_non_null(strstr(quiet.events, "going on from the checkpoint at t = 0.025 s"));
    assert_true(exists("damaged", "checkpoint/000000500.h5.set-aside"));
    must(pls_run_remove("damaged/checkpoint/000000500.h5.set-aside"));
    expect_same_results("damaged", "reference");
}

static void without_a_good_checkpoint_nothing_is_touched(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("ruined", 613, PLS_USER), PLS_USER);
    flip_byte("ruined/checkpoint/000000500.h5", 5000);
    flip_byte("ruined/checkpoint/000000250.h5", 100);
    folder_hash series = hash_folder("ruined", "series");
    assert_int_equal(resume("ruined", &quiet), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "no checkpoint of \"ruined\" can be used"));
    assert_int_equal(hash_folder("ruined", "series").sum, series.sum);
    assert_true(exists("ruined", "checkpoint/000000500.h5"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_series_that_was_cut_falls_back_to_the_checkpoint_before(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("cut", 613, PLS_USER), PLS_USER);
    char *text;
    size_t size;
    must(pls_read_file("cut/series/heap.csv", &text, &size));
    char *half = text;
    for (int line = 0; line < 18; ++line) half = strchr(half, '\n') + 1; // the look at 0.034 s is the last: after the checkpoint of 0.025 s
    must(pls_write_file("cut/series/heap.csv", text, (size_t)(half - text)));
    pls_release(&text);
    must(resume("cut", &quiet));
    assert_non_null(strstr(quiet.events, "going on from the checkpoint at t = 0.025 s"));
    expect_same_folder("cut", "reference", "series");
}

static void a_run_killed_before_its_first_checkpoint_starts_over(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("early", 10, PLS_USER), PLS_USER);
    must(pls_run_remove("early/checkpoint/000000000.h5"));
    must(resume("early", &quiet));
    assert_non_null(strstr(quiet.events, "starting from the beginning"));
    expect_same_results("early", "reference");
}

static void resuming_nothing_says_so(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(resume("no_such_directory", &quiet), PLS_NOT_FOUND);
    must(pls_make_directory("empty"));
    assert_int_equal(resume("empty", &quiet), PLS_NOT_FOUND);
    assert_non_null(strstr(pls_last_message(), "no run has begun"));
    assert_int_equal(resume("small.yaml", &quiet), PLS_NOT_FOUND); // a file
}

static void a_finished_run_is_left_alone_unless_asked_for_more(void **state)
{
    (void)state;
    breaker quiet = {0};
    pls_run_def def = run_def("finished", &quiet, NULL);
    pls_scene *scene;
    must(small_scene_load("time.end=0.06", &scene));
    must(pls_run_scene(scene, &def));
    pls_scene_free(scene);
    folder_hash before = hash_folder("finished", "checkpoint");
    must(resume("finished", &quiet));
    assert_non_null(strstr(quiet.events, "has finished at t = 0.06 s"));
    assert_int_equal(hash_folder("finished", "checkpoint").sum, before.sum);

    def.until = 0.1;
    must(pls_run_resume(&def));
    expect_same_folder("finished", "reference", "series");
    expect_same_folder("finished", "reference", "frames");
}

static void a_finished_run_that_was_killed_while_tidying_up_is_tidied_up(void **state)
{
    (void)state;
    must(run_broken("untidy", UINT64_MAX, PLS_OK));
    must(pls_write_file("untidy/checkpoint/000000500.h5", "old", 3));
    must(pls_write_file("untidy/checkpoint/000000990.h5", "interim", 7));
    breaker quiet = {0};
    must(resume("untidy", &quiet));
    assert_non_null(strstr(quiet.events, "has finished"));
    expect_same_results("untidy", "reference");

    must(pls_run_remove("untidy/summary.json")); // by hand
    must(resume("untidy", &quiet));
    expect_same_results("untidy", "reference");
    char *reference = summary_of("reference");
    char *summary = summary_of("untidy");
    assert_non_null(strstr(summary, "\"finished\": true"));
    assert_string_equal(strstr(summary, "\"state_hash\""), strstr(reference, "\"state_hash\""));
    pls_release(&reference);
    pls_release(&summary);
}

static void another_run_is_not_overwritten_by_accident(void **state)
{
    (void)state;
    breaker quiet = {0};
    pls_run_def def = run_def("reference", &quiet, NULL);
    def.overwrite = false;
    folder_hash before = hash_folder("reference", "series");
    pls_scene *scene;
    must(small_scene_load(NULL, &scene));
    assert_int_equal(pls_run_scene(scene, &def), PLS_DUPLICATE);
    assert_non_null(strstr(pls_last_message(), "--overwrite"));
    pls_scene_free(scene);
    assert_int_equal(hash_folder("reference", "series").sum, before.sum);
}

static void overwriting_leaves_other_files_alone(void **state)
{
    (void)state;
    must(pls_make_directory("with_notes"));
    must(pls_write_file("with_notes/notes.txt", "mine", 4));
    must(run_broken("with_notes", UINT64_MAX, PLS_OK));
    must(run_broken("with_notes", UINT64_MAX, PLS_OK));
    assert_true(exists("with_notes", "notes.txt"));
    expect_same_results("with_notes", "reference");
}

static void two_processes_cannot_run_in_one_directory(void **state)
{
    (void)state;
    breaker quiet = {0};
    FILE *lock = fopen("reference/.lock", "r+");
    assert_non_null(lock);
    assert_int_equal(flock(fileno(lock), LOCK_EX | LOCK_NB), 0);
    assert_int_equal(resume("reference", &quiet), PLS_DUPLICATE);
    assert_int_equal(run_broken("reference", UINT64_MAX, PLS_OK), PLS_DUPLICATE);
    assert_non_null(strstr(pls_last_message(), "another process"));
    fclose(lock);
    must(resume("reference", &quiet));
}

static void a_full_disk_stops_the_run_and_nothing_is_lost(void **state)
{
    (void)state;
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_IGN);
    const size_t room[] = {1500, 4000, 9000}; // in series, frames or checkpoints, early or late
    for (size_t k = 0; k < sizeof room / sizeof room[0]; ++k)
    {
        breaker quiet = {0};
        struct rlimit small = {room[k], before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        pls_run_def def = run_def("full", &quiet, NULL);
        pls_scene *scene;
        setrlimit(RLIMIT_FSIZE, &before);
        must(small_scene_load(NULL, &scene));
        setrlimit(RLIMIT_FSIZE, &small);
        pls_status status = pls_run_scene(scene, &def);
        setrlimit(RLIMIT_FSIZE, &before);
        pls_scene_free(scene);
        assert_int_equal(status, PLS_DISK_FULL);
        if (!exists("full", "scene.used.yaml")) continue; // not even begun
        must(resume("full", &quiet));
        expect_same_results("full", "reference");
    }
}

static void a_changed_scene_is_not_mixed_with_old_results(void **state)
{
    (void)state;
    breaker quiet = {0};
    assert_int_equal(run_broken("changed", 613, PLS_USER), PLS_USER);
    char *text;
    size_t size;
    must(pls_read_file("changed/scene.used.yaml", &text, &size));
    char *end = strstr(text, "0.4"); // the friction
    assert_non_null(end);
    end[2] = '5';
    must(pls_write_file("changed/scene.used.yaml", text, size));
    pls_release(&text);
    assert_int_equal(resume("changed", &quiet), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "scene.used.yaml"));
}

static void a_definition_must_be_made_by_its_function(void **state)
{
    (void)state;
    pls_run_def def = {.directory = "x"};
    assert_int_equal(pls_run_resume(&def), PLS_INVALID_ARGUMENT);
    def = pls_default_run_def();
    assert_int_equal(pls_run_resume(&def), PLS_INVALID_ARGUMENT); // no directory
    def.directory = "reference";
    def.until = INFINITY;
    assert_int_equal(pls_run_resume(&def), PLS_INVALID_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_finished_run_has_scene_series_frames_checkpoints_and_summary),
        cmocka_unit_test(an_interrupted_run_ends_as_if_it_had_not_been),
        cmocka_unit_test(a_failed_run_keeps_its_series_says_why_and_can_go_on),
        cmocka_unit_test(a_damaged_checkpoint_falls_back_to_the_one_before),
        cmocka_unit_test(without_a_good_checkpoint_nothing_is_touched),
        cmocka_unit_test(a_series_that_was_cut_falls_back_to_the_checkpoint_before),
        cmocka_unit_test(a_run_killed_before_its_first_checkpoint_starts_over),
        cmocka_unit_test(resuming_nothing_says_so),
        cmocka_unit_test(a_finished_run_is_left_alone_unless_asked_for_more),
        cmocka_unit_test(a_finished_run_that_was_killed_while_tidying_up_is_tidied_up),
        cmocka_unit_test(another_run_is_not_overwritten_by_accident),
        cmocka_unit_test(overwriting_leaves_other_files_alone),
        cmocka_unit_test(two_processes_cannot_run_in_one_directory),
        cmocka_unit_test(a_full_disk_stops_the_run_and_nothing_is_lost),
        cmocka_unit_test(a_changed_scene_is_not_mixed_with_old_results),
        cmocka_unit_test(a_definition_must_be_made_by_its_function),
    };
    return cmocka_run_group_tests(tests, make_reference, NULL);
}
