// test_atomic_file.c -- files that are either complete or not there, also when the disk is full or the process dies.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "support/failing_allocator.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/// Each test works in a new folder, removed with its content afterwards.
static char scratch[64];
static char come_back[4096];

static int enter_scratch(void **state)
{
    (void)state;
    strcpy(scratch, "/tmp/particls-test-XXXXXX");
    return getcwd(come_back, sizeof come_back) && mkdtemp(scratch) && chdir(scratch) == 0 ? 0 : -1;
}

static int leave_scratch(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", scratch);
    return chdir(come_back) == 0 && system(command) == 0 ? 0 : -1;
}

static void assert_file_holds(const char *path, const char *expected)
{
    char *text;
    size_t size;
    assert_int_equal(pls_read_file(path, &text, &size), PLS_OK);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(text, expected);
    pls_release(&text);
}

static void a_file_appears_only_when_committed(void **state)
{
    (void)state;
    pls_atomic_file file;
    assert_int_equal(pls_atomic_open(&file, "series.csv"), PLS_OK);
    assert_int_equal(pls_atomic_write(&file, "time [s]\n", 9), PLS_OK);
    assert_int_equal(pls_atomic_write(&file, NULL, 0), PLS_OK);
    assert_int_equal(pls_atomic_print(&file, "%d\n", 42), PLS_OK);
    assert_false(pls_file_exists("series.csv"));
    assert_true(pls_file_exists("series.csv.tmp"));
    assert_int_equal(pls_atomic_commit(&file), PLS_OK);
    assert_false(pls_file_exists("series.csv.tmp"));
    assert_file_holds("series.csv", "time [s]\n42\n");
    assert_int_equal(pls_memory_in_use(), 0);
}

static void an_old_file_is_replaced_as_a_whole(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("a", "a long old text", 15), PLS_OK);
    assert_int_equal(pls_write_file("a", "new", 3), PLS_OK);
    assert_file_holds("a", "new");
    assert_int_equal(pls_write_file("a", NULL, 0), PLS_OK);
    assert_file_holds("a", "");
}

static void an_abandoned_file_leaves_the_old_one(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("a", "old", 3), PLS_OK);
    pls_atomic_file file;
    assert_int_equal(pls_atomic_open(&file, "a"), PLS_OK);
    assert_int_equal(pls_atomic_write(&file, "new", 3), PLS_OK);
    pls_atomic_abandon(&file);
    pls_atomic_abandon(&file);
    assert_false(pls_file_exists("a.tmp"));
    assert_file_holds("a", "old");
    assert_int_equal(pls_atomic_write(&file, "new", 3), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_atomic_print(&file, "new"), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_atomic_commit(&file), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_left_over_temporary_file_is_overwritten(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("a.tmp", "left over by a crash", 20), PLS_OK);
    assert_int_equal(pls_write_file("a", "new", 3), PLS_OK);
    assert_file_holds("a", "new");
    assert_false(pls_file_exists("a.tmp"));
}

static void another_library_may_write_the_temporary_file(void **state)
{
    (void)state;
    pls_atomic_file file;
    assert_int_equal(pls_atomic_open(&file, "a.h5"), PLS_OK);
    FILE *other = fopen(file.temporary, "wb");
    assert_non_null(other);
    assert_true(fputs("theirs", other) >= 0);
    assert_int_equal(fclose(other), 0);
    assert_int_equal(pls_atomic_commit(&file), PLS_OK);
    assert_file_holds("a.h5", "theirs");
}

/// A file size limit stands for a full disk: the kernel reports it at the same calls (as EFBIG instead of ENOSPC).
static void limit_file_size(rlim_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes == RLIM_INFINITY ? limit.rlim_max : bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void a_full_disk_leaves_the_old_file_and_says_so(void **state)
{
    (void)state;
    // 600 bytes fail at the flush inside commit, 100,000 already at a write.
    static const size_t sizes[] = {600, 100000};
    char *data;
    assert_int_equal(pls_allocate(&data, 100000, 1, "data"), PLS_OK);
    assert_int_equal(pls_make_directory("run"), PLS_OK);
    assert_int_equal(pls_write_file("run/a", "old", 3), PLS_OK);
    void (*before)(int) = signal(SIGXFSZ, SIG_IGN);
    for (size_t i = 0; i < 2; ++i)
    {
        limit_file_size(512);
        pls_status status = pls_write_file("run/a", data, sizes[i]);
        limit_file_size(RLIM_INFINITY);
        assert_int_equal(status, PLS_DISK_FULL);
        assert_non_null(strstr(pls_last_message(), "cannot write \"run/a\": the disk is full"));
        assert_non_null(strstr(pls_last_message(), "nothing was lost"));
        assert_non_null(strstr(pls_last_message(), "free space in \"run\""));
        assert_false(pls_file_exists("run/a.tmp"));
        assert_file_holds("run/a", "old");
    }
    signal(SIGXFSZ, before);
    pls_release(&data);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// The stream is put on /dev/full, where every write fails with the real ENOSPC.
static void no_space_left_is_a_full_disk(void **state)
{
    (void)state;
    pls_atomic_file file;
    assert_int_equal(pls_atomic_open(&file, "a"), PLS_OK);
    int full = open("/dev/full", O_WRONLY);
    assert_true(full >= 0);
    assert_true(dup2(full, fileno(file.stream)) >= 0);
    close(full);
    assert_int_equal(pls_atomic_write(&file, "lost", 4), PLS_OK); // still in the buffer
    assert_int_equal(pls_atomic_commit(&file), PLS_DISK_FULL);
    assert_non_null(strstr(pls_last_message(), "No space left"));
    assert_false(pls_file_exists("a"));
    assert_false(pls_file_exists("a.tmp"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_failing_print_is_reported(void **state)
{
    (void)state;
    pls_atomic_file file;
    assert_int_equal(pls_atomic_open(&file, "a"), PLS_OK);
    int full = open("/dev/full", O_WRONLY);
    assert_true(full >= 0);
    assert_true(dup2(full, fileno(file.stream)) >= 0);
    close(full);
    pls_status status = PLS_OK;
    for (int i = 0; i < 100000 && status == PLS_OK; ++i) status = pls_atomic_print(&file, "%d,%d\n", i, i);
    assert_int_equal(status, PLS_DISK_FULL);
    assert_false(pls_file_exists("a.tmp"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_missing_folder_is_reported(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("nowhere/a", "x", 1), PLS_IO);
    assert_non_null(strstr(pls_last_message(), "cannot write \"nowhere/a\": No such file or directory"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static void devices_and_folders_are_not_replaced(void **state)
{
    (void)state;
    assert_int_equal(pls_make_directory("folder"), PLS_OK);
    assert_int_equal(symlink("/dev/null", "null"), 0);
    static const char *const paths[] = {"/dev/null", "folder", "null", ".", "/"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; ++i)
    {
        assert_int_equal(pls_write_file(paths[i], "x", 1), PLS_INVALID_ARGUMENT);
        assert_non_null(strstr(pls_last_message(), paths[i]));
    }
    struct stat null_device;
    assert_int_equal(stat("/dev/null", &null_device), 0);
    assert_true(S_ISCHR(null_device.st_mode));
}

static void rewrite_without_end(char *data, size_t size)
{
    for (int k = 0;; ++k)
    {
        memset(data, 'a' + k % 26, size);
        if (pls_write_file("a", data, size) != PLS_OK) _exit(1);
    }
}

/// A child rewrites the file without end and is killed at some moment; whichever it was, a whole version is there.
static void a_killed_writer_leaves_a_whole_file(void **state)
{
    (void)state;
    enum { SIZE = 50000 };
    static char data[SIZE];
    memset(data, 'a', SIZE);
    assert_int_equal(pls_write_file("a", data, SIZE), PLS_OK);
    for (int run = 0; run < 20; ++run)
    {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) rewrite_without_end(data, SIZE);
        usleep((useconds_t)(3000 + run * 1777));
        kill(child, SIGKILL);
        int ended;
        assert_int_equal(waitpid(child, &ended, 0), child);
        assert_true(WIFSIGNALED(ended));
        char *text;
        size_t size;
        assert_int_equal(pls_read_file("a", &text, &size), PLS_OK);
        assert_int_equal(size, SIZE);
        for (size_t i = 0; i < size; ++i) assert_int_equal(text[i], text[0]);
        pls_release(&text);
    }
}

static void a_file_is_read_as_it_is(void **state)
{
    (void)state;
    char *text;
    size_t size;
    char bytes[10000];
    for (size_t i = 0; i < sizeof bytes; ++i) bytes[i] = (char)(i * 7);
    assert_int_equal(pls_write_file("bytes", bytes, sizeof bytes), PLS_OK);
    assert_int_equal(pls_read_file("bytes", &text, &size), PLS_OK);
    assert_int_equal(size, sizeof bytes);
    assert_memory_equal(text, bytes, size);
    assert_int_equal(text[size], 0);
    pls_release(&text);
    assert_int_equal(pls_read_file("/proc/self/status", &text, &size), PLS_OK); // a file whose size is said to be 0
    assert_true(size > 100 && strlen(text) == size);
    pls_release(&text);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_long_pipe_is_read_to_its_end(void **state)
{
    (void)state;
    assert_int_equal(mkfifo("pipe", 0600), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
    {
        FILE *pipe = fopen("pipe", "wb");
        for (int i = 0; pipe && i < 300000; ++i) fputc('p', pipe);
        _exit(pipe && fclose(pipe) == 0 ? 0 : 1);
    }
    char *text;
    size_t size;
    assert_int_equal(pls_read_file("pipe", &text, &size), PLS_OK);
    assert_int_equal(size, 300000);
    assert_int_equal(strspn(text, "p"), 300000);
    pls_release(&text);
    int ended;
    assert_int_equal(waitpid(child, &ended, 0), child);
}

static void what_cannot_be_read_is_reported(void **state)
{
    (void)state;
    char here = 0;
    char *text = &here;
    size_t size = 7;
    assert_int_equal(pls_read_file("missing", &text, &size), PLS_NOT_FOUND);
    assert_null(text);
    assert_int_equal(size, 0);
    assert_non_null(strstr(pls_last_message(), "cannot read \"missing\": No such file or directory"));
    assert_int_equal(pls_read_file(".", &text, &size), PLS_IO);
    assert_null(text);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void folders_are_made_with_their_parents(void **state)
{
    (void)state;
    assert_int_equal(pls_make_directory("a/b//c"), PLS_OK);
    assert_true(pls_file_exists("a/b/c"));
    assert_int_equal(pls_make_directory("a/b/c"), PLS_OK);
    assert_int_equal(pls_make_directory("a/d/"), PLS_OK);
    assert_true(pls_file_exists("a/d"));
    assert_int_equal(pls_make_directory("/"), PLS_OK);
    assert_int_equal(pls_make_directory("."), PLS_OK);
    char absolute[128];
    snprintf(absolute, sizeof absolute, "%s/x/y", scratch);
    assert_int_equal(pls_make_directory(absolute), PLS_OK);
    assert_true(pls_file_exists("x/y"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_folder_cannot_be_made_where_a_file_is(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("file", "x", 1), PLS_OK);
    assert_int_equal(pls_make_directory("file"), PLS_IO);
    assert_int_equal(pls_make_directory("file/below"), PLS_IO);
    assert_non_null(strstr(pls_last_message(), "\"file\""));
    assert_int_equal(pls_make_directory(""), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_memory_in_use(), 0);
}

static pls_status write_and_read(void *context)
{
    (void)context;
    char *text;
    size_t size;
    PLS_TRY(pls_make_directory("deep/folder"));
    PLS_TRY(pls_write_file("deep/folder/a", "text", 4));
    PLS_TRY(pls_write_file("a", "text", 4));
    PLS_TRY(pls_read_file("a", &text, &size));
    pls_release(&text);
    PLS_TRY(pls_read_file("/proc/self/maps", &text, &size)); // grows while it is read
    pls_release(&text);
    return PLS_OK;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(write_and_read, NULL) >= 9);
    failing_allocator_remove();
    assert_false(pls_file_exists("a.tmp"));
}

#define IN_SCRATCH(test) cmocka_unit_test_setup_teardown(test, enter_scratch, leave_scratch)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_SCRATCH(a_file_appears_only_when_committed),
        IN_SCRATCH(an_old_file_is_replaced_as_a_whole),
        IN_SCRATCH(an_abandoned_file_leaves_the_old_one),
        IN_SCRATCH(a_left_over_temporary_file_is_overwritten),
        IN_SCRATCH(another_library_may_write_the_temporary_file),
        IN_SCRATCH(a_full_disk_leaves_the_old_file_and_says_so),
        IN_SCRATCH(no_space_left_is_a_full_disk),
        IN_SCRATCH(a_failing_print_is_reported),
        IN_SCRATCH(a_missing_folder_is_reported),
        IN_SCRATCH(devices_and_folders_are_not_replaced),
        IN_SCRATCH(a_killed_writer_leaves_a_whole_file),
        IN_SCRATCH(a_file_is_read_as_it_is),
        IN_SCRATCH(a_long_pipe_is_read_to_its_end),
        IN_SCRATCH(what_cannot_be_read_is_reported),
        IN_SCRATCH(folders_are_made_with_their_parents),
        IN_SCRATCH(a_folder_cannot_be_made_where_a_file_is),
        IN_SCRATCH(every_failed_allocation_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
