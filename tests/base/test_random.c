// test_random.c -- Philox against its published answers, and the distributions drawn from it.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"

#include <math.h>

/// The three answers for philox4x32-10 in the file kat_vectors of Random123, the authors' library.
static void philox_gives_the_published_answers(void **state)
{
    (void)state;
    static const struct
    {
        uint32_t counter[4], key[2], out[4];
    } known[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}, {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; ++i)
    {
        uint32_t out[4];
        pls_philox4x32(known[i].counter, known[i].key, out);
        assert_memory_equal(out, known[i].out, sizeof out);
    }
}

/// Seed, id, purpose and counter laid out so that the third known answer comes out.
static void a_draw_uses_seed_id_purpose_and_counter(void **state)
{
    (void)state;
    const pls_random stream = {UINT64_C(0x299f31d0a4093822), UINT64_C(0x85a308d3243f6a88), 0x13198a2e, 0x03707344};
    pls_random random = stream;
    assert_true(pls_random_u64(&random) == UINT64_C(0x94fdccebd16cfe09));
    assert_int_equal(random.counter, stream.counter + 1);

    random = stream;
    double uniform = pls_random_uniform(&random);
    assert_true(uniform == (double)(UINT64_C(0x94fdccebd16cfe09) >> 11) / 9007199254740992.0);

    random = stream;
    double u = uniform, v = (double)(UINT64_C(0x24126ea15001e420) >> 11) / 9007199254740992.0;
    double normal = sqrt(-2 * log1p(-u)) * cos(2 * acos(-1.0) * v);
    assert_true(fabs(pls_random_normal(&random) - normal) < 1e-14);
}

static void streams_differ_in_each_of_their_keys(void **state)
{
    (void)state;
    pls_random streams[] = {
        pls_random_stream(1, 1, PLS_FOR_POSITION), pls_random_stream(2, 1, PLS_FOR_POSITION), pls_random_stream(1, 2, PLS_FOR_POSITION),
        pls_random_stream(1, 1, PLS_FOR_SIZE),     pls_random_stream(1, 1, PLS_FOR_POSITION),
    };
    enum { STREAMS = sizeof streams / sizeof *streams };
    pls_random_u64(&streams[STREAMS - 1]); // one draw further on
    uint64_t drawn[STREAMS];
    for (int i = 0; i < STREAMS; ++i) drawn[i] = pls_random_u64(&streams[i]);
    for (int i = 0; i < STREAMS; ++i)
    {
        for (int k = 0; k < i; ++k) assert_true(drawn[i] != drawn[k]);
    }
}

/// The mean and variance of n draws lie within five standard errors of the distribution's; uniform: 1/2, 1/12, normal: 0, 1.
static void uniform_and_normal_draws_have_the_right_moments(void **state)
{
    (void)state;
    enum { DRAWS = 200000 };
    pls_random random = pls_random_stream(42, 7, PLS_FOR_USER);
    double sum = 0, squares = 0;
    for (int i = 0; i < DRAWS; ++i)
    {
        double u = pls_random_uniform(&random);
        assert_true(u >= 0 && u < 1);
        sum += u - 0.5;
        squares += (u - 0.5) * (u - 0.5);
    }
    assert_true(fabs(sum / DRAWS) < 5 * sqrt(1.0 / 12 / DRAWS));
    assert_true(fabs(squares / DRAWS - 1.0 / 12) < 5 * sqrt(1.0 / 180 / DRAWS)); // variance of (u - 1/2)^2: 1/80 - 1/144 = 1/180

    double sum1 = 0, sum2 = 0, sum3 = 0, sum4 = 0;
    int within_one = 0;
    for (int i = 0; i < DRAWS; ++i)
    {
        double x = pls_random_normal(&random);
        assert_true(isfinite(x));
        sum1 += x;
        sum2 += x * x;
        sum3 += x * x * x;
        sum4 += x * x * x * x;
        within_one += fabs(x) < 1;
    }
    assert_true(fabs(sum1 / DRAWS) < 5 * sqrt(1.0 / DRAWS));
    assert_true(fabs(sum2 / DRAWS - 1) < 5 * sqrt(2.0 / DRAWS));
    assert_true(fabs(sum3 / DRAWS) < 5 * sqrt(15.0 / DRAWS));
    assert_true(fabs(sum4 / DRAWS - 3) < 5 * sqrt(96.0 / DRAWS));
    double share = erf(sqrt(0.5)); // 0.683 of a normal distribution lies within one standard deviation
    assert_true(fabs((double)within_one / DRAWS - share) < 5 * sqrt(share * (1 - share) / DRAWS));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_gives_the_published_answers),
        cmocka_unit_test(a_draw_uses_seed_id_purpose_and_counter),
        cmocka_unit_test(streams_differ_in_each_of_their_keys),
        cmocka_unit_test(uniform_and_normal_draws_have_the_right_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
