// test_golden.c -- wrong scenes, one class of mistake each, and the exact message the user gets.
//
// golden/NNN-name.yaml is a wrong scene, golden/NNN-name.expected its message. A first line "# --set path=value" is an override. The
// folder's own path is written $GOLDEN, that of the compiled plugins $PLUGINS. UPDATE_GOLDEN=1 writes the files anew; read the difference before keeping it.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <particls/memory.h>
#include <particls/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TEXT_SIZE = 4096 };

static int is_scene(const struct dirent *entry)
{
    const char *end = strrchr(entry->d_name, '.');
    return end && strcmp(end, ".yaml") == 0;
}

static void read_text(const char *path, char text[TEXT_SIZE])
{
    text[0] = '\0';
    FILE *file = fopen(path, "r");
    if (!file) return;
    text[fread(text, 1, TEXT_SIZE - 1, file)] = '\0';
    fclose(file);
}

/// `text` with `from` replaced by `to`.
static void replace(const char *text, const char *from, const char *to, char out[TEXT_SIZE])
{
    size_t used = 0, size = strlen(from);
    for (const char *c = text; *c && used + strlen(to) + 2 < TEXT_SIZE;)
    {
        if (strncmp(c, from, size) == 0)
        {
            used += (size_t)snprintf(out + used, TEXT_SIZE - used, "%s", to);
            c += size;
        }
        else
            out[used++] = *c++;
    }
    out[used] = '\0';
}

/// Text with the folders' paths replaced.
static void relocate(const char *message, const char *folder, char out[TEXT_SIZE])
{
    char without[TEXT_SIZE];
    replace(message, folder, "$GOLDEN", without);
    replace(without, PLS_PLUGIN_DIR, "$PLUGINS", out);
    strcat(out, "\n");
}

/// Load and, if that goes well, build and prepare: the status of what failed.
static pls_status try_scene(const char *path)
{
    char text[TEXT_SIZE], written[256], override[TEXT_SIZE];
    read_text(path, text);
    const char *set = override;
    size_t sets = sscanf(text, "# --set %255[^\n]", written) == 1;
    if (sets) replace(written, "$PLUGINS", PLS_PLUGIN_DIR, override);
    pls_scene *scene;
    pls_world *world = NULL;
    pls_status status = pls_scene_load(path, &set, sets, &scene);
    if (status == PLS_OK) status = pls_scene_build(scene, &world);
    if (status == PLS_OK) status = pls_world_prepare(world);
    pls_world_destroy(world);
    pls_scene_free(scene);
    return status;
}

static void every_wrong_scene_gets_its_message(void **state)
{
    (void)state;
    char folder[TEXT_SIZE / 2];
    assert_int_equal(chdir(PLS_SOURCE_DIR "/tests/scene/golden"), 0);
    assert_non_null(getcwd(folder, sizeof folder));
    struct dirent **entries;
    int count = scandir(".", &entries, is_scene, alphasort), wrong = 0;
    assert_true(count >= 45);
    for (int k = 0; k < count; ++k)
    {
        const char *name = entries[k]->d_name;
        char expected_path[512], expected[TEXT_SIZE], message[TEXT_SIZE];
        snprintf(expected_path, sizeof expected_path, "%.*s.expected", (int)strlen(name) - 5, name);
        size_t held = pls_memory_in_use();
        pls_status status = try_scene(name);
        assert_int_equal(pls_memory_in_use(), held);
        if (status == PLS_OK)
            snprintf(message, sizeof message, "(no error)\n");
        else
            relocate(pls_last_message(), folder, message);
        if (getenv("UPDATE_GOLDEN"))
        {
            FILE *file = fopen(expected_path, "w");
            assert_non_null(file);
            fputs(message, file);
            fclose(file);
        }
        read_text(expected_path, expected);
        if (status == PLS_OK || strcmp(message, expected) != 0)
        {
            print_error("%s\n--- expected\n%s--- got\n%s", name, expected, message);
            ++wrong;
        }
        free(entries[k]);
    }
    free(entries);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_wrong_scene_gets_its_message)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
