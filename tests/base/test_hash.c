// test_hash.c -- the hash against values computed by hand from its definition (in Python, whose integers do not overflow).

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/hash.h"

#include <string.h>

static void hashes_are_as_defined(void **state)
{
    (void)state;
    static const struct
    {
        const char *data;
        size_t size;
        uint64_t hash;
    } known[] = {
        {"", 0, UINT64_C(0xcbf29ce484222325)},
        {"a", 1, UINT64_C(0x68e0166a3938c199)},
        {"particls", 8, UINT64_C(0x066e932f5e0e2540)},
        {"signed distance functions", 25, UINT64_C(0x04d8f43ac46e611f)},
        {"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 16, UINT64_C(0x68853b6a3912cca3)},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; ++i)
    {
        assert_true(pls_hash(PLS_HASH_START, known[i].data, known[i].size) == known[i].hash);
    }
}

static void a_hash_can_be_continued_at_multiples_of_eight(void **state)
{
    (void)state;
    unsigned char data[64];
    for (size_t i = 0; i < sizeof data; ++i) data[i] = (unsigned char)(i * 37);
    for (size_t size = 0; size <= sizeof data; ++size)
    {
        uint64_t whole = pls_hash(PLS_HASH_START, data, size);
        for (size_t part = 0; part <= size; part += 8)
        {
            assert_true(pls_hash(pls_hash(PLS_HASH_START, data, part), data + part, size - part) == whole);
        }
    }
}

static void it_does_not_depend_on_alignment(void **state)
{
    (void)state;
    const char text[25] = "signed distance functions"; // without a terminator
    char shifted[48];
    uint64_t expected = pls_hash(PLS_HASH_START, text, sizeof text);
    for (size_t shift = 0; shift < 16; ++shift)
    {
        memcpy(shifted + shift, text, sizeof text);
        assert_true(pls_hash(PLS_HASH_START, shifted + shift, sizeof text) == expected);
    }
}

static void every_single_bit_and_every_pair_of_bits_counts(void **state)
{
    (void)state;
    enum { BITS = 192 };
    unsigned char data[BITS / 8] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    uint64_t expected = pls_hash(PLS_HASH_START, data, sizeof data);
    for (int i = 0; i < BITS; ++i)
    {
        data[i / 8] ^= (unsigned char)(1 << i % 8);
        assert_true(pls_hash(PLS_HASH_START, data, sizeof data) != expected);
        for (int k = 0; k < i; ++k)
        {
            data[k / 8] ^= (unsigned char)(1 << k % 8);
            assert_true(pls_hash(PLS_HASH_START, data, sizeof data) != expected);
            data[k / 8] ^= (unsigned char)(1 << k % 8);
        }
        data[i / 8] ^= (unsigned char)(1 << i % 8);
    }
}

/// Sign bits are where a plain multiplication hash is blind: v and -v must not look alike.
static void flipping_the_signs_of_two_numbers_counts(void **state)
{
    (void)state;
    const double forth[] = {0.25, -3, 1e-7, 8}, back[] = {-0.25, 3, -1e-7, -8}, half[] = {-0.25, -3, 1e-7, -8};
    uint64_t hash = pls_hash(PLS_HASH_START, forth, sizeof forth);
    assert_true(hash != pls_hash(PLS_HASH_START, back, sizeof back));
    assert_true(hash != pls_hash(PLS_HASH_START, half, sizeof half));
}

static void trailing_zeros_count(void **state)
{
    (void)state;
    const char zeros[24] = {0};
    for (size_t size = 0; size < sizeof zeros; ++size)
    {
        for (size_t other = 0; other < size; ++other)
        {
            assert_true(pls_hash(PLS_HASH_START, zeros, size) != pls_hash(PLS_HASH_START, zeros, other));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hashes_are_as_defined),
        cmocka_unit_test(a_hash_can_be_continued_at_multiples_of_eight),
        cmocka_unit_test(it_does_not_depend_on_alignment),
        cmocka_unit_test(every_single_bit_and_every_pair_of_bits_counts),
        cmocka_unit_test(flipping_the_signs_of_two_numbers_counts),
        cmocka_unit_test(trailing_zeros_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
