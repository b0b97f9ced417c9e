// The product and sum rounded once, emulated, against the C library's (an instruction on most machines): the same bits, in easy numbers and in those made to be hard.

#include "math/fma_emulated.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static uint64_t state = 1;

static uint64_t next(void) // splitmix64
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/// Any sign and digits, often few of them, the exponent within `reach` of zero.
static double any_number(int reach)
{
    const uint64_t r = next();
    uint64_t digits = next() >> 12;
    if (r % 4 == 0) digits &= ~UINT64_C(0) << (next() % 52); // many zeros at the end: ties
    if (r % 4 == 1) digits |= (UINT64_C(1) << (next() % 52)) - 1;
    const uint64_t exponent = (uint64_t)(1023 + (int)(next() % (uint64_t)(2 * reach + 1)) - reach);
    const uint64_t bits = r >> 63 << 63 | exponent << 52 | digits;
    double out;
    memcpy(&out, &bits, sizeof out);
    return out;
}

static int same(double x, double y) { return memcmp(&x, &y, sizeof x) == 0 || (x != x && y != y); }

static void compare(double a, double b, double c)
{
    const double others[2] = {any_number(3), any_number(3)};
    const pls_pair_ got = pls_fma_emulated((pls_pair_){a, others[0]}, (pls_pair_){others[1], b}, (pls_pair_){c, c});
    const pls_pair_ both = pls_fma_emulated((pls_pair_){a, b}, (pls_pair_){b, a}, (pls_pair_){c, -c});
    if (!same(got[0], fma(a, others[1], c)) || !same(got[1], fma(others[0], b, c)) || !same(both[0], fma(a, b, c)) ||
        !same(both[1], fma(b, a, -c)))
        fail_msg("%a * %a + %a: %a, not %a", a, b, c, both[0], fma(a, b, c));
}

static void test_any_numbers(void **unused)
{
    (void)unused;
    for (int k = 0; k < 2000000; ++k) compare(any_number(60), any_number(60), any_number(120));
}

static void test_what_nearly_cancels(void **unused)
{
    (void)unused;
    for (int k = 0; k < 1000000; ++k)
    {
        const double a = any_number(20), b = any_number(20), p = a * b;
        compare(a, b, -p);
        compare(a, b, -nextafter(p, k % 2 ? INFINITY : -INFINITY));
        compare(a, b, p * 0x1p53 * (k % 3 - 1.0)); // the product is about half a last digit of the sum
        compare(a, b, any_number(1) * p * 0x1p54);
        compare(a, b, any_number(1) * p * 0x1p-54);
    }
}

static void test_zeros_and_what_is_out_of_reach(void **unused)
{
    (void)unused;
    const double special[] = {0.0,       -0.0,       1.0,
                              -1.0,      0x1p-1074,  -0x1p-1074,
                              0x1p-1022, 0x1.8p-600, -0x1.123456789abcdp-500,
                              0x1p-449,  0x1p-451,   0x1p399,
                              0x1.fp400, -0x1p900,   0x1.fffffffffffffp1023,
                              INFINITY,  -INFINITY,  NAN};
    const int count = (int)(sizeof special / sizeof *special);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            for (int k = 0; k < count; ++k) compare(special[i], special[j], special[k]);
    for (int k = 0; k < 1000000; ++k) compare(any_number(1000), any_number(1000), any_number(1000));
    for (int k = 0; k < 1000000; ++k) compare(any_number(20) * 0x1p-450, any_number(20) * 0x1p-450, any_number(60) * 0x1p-900);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_any_numbers), cmocka_unit_test(test_what_nearly_cancels),
                                       cmocka_unit_test(test_zeros_and_what_is_out_of_reach)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
