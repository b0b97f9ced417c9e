// random.c -- Philox 4x32-10.
//
// J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011, section 3.3 (multipliers and
// key increments as published). The key is the seed; the counter is (id low, id high, purpose, draw), so a draw depends on nothing else.

#include "base/random.h"

#include <math.h>

enum { ROUNDS = 10 };

void pls_philox4x32(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4])
{
    uint32_t x0 = counter[0], x1 = counter[1], x2 = counter[2], x3 = counter[3];
    uint32_t k0 = key[0], k1 = key[1];
    for (int round = 0; round < ROUNDS; ++round)
    {
        uint64_t product0 = (uint64_t)UINT32_C(0xD2511F53) * x0;
        uint64_t product1 = (uint64_t)UINT32_C(0xCD9E8D57) * x2;
        x0 = (uint32_t)(product1 >> 32) ^ x1 ^ k0;
        x1 = (uint32_t)product1;
        x2 = (uint32_t)(product0 >> 32) ^ x3 ^ k1;
        x3 = (uint32_t)product0;
        k0 += UINT32_C(0x9E3779B9); // golden ratio
        k1 += UINT32_C(0xBB67AE85); // sqrt(3) - 1
    }
    out[0] = x0;
    out[1] = x1;
    out[2] = x2;
    out[3] = x3;
}

/// Two independent 64-bit numbers of the stream's next draw.
static void draw(pls_random *random, uint64_t out[2])
{
    const uint32_t counter[4] = {(uint32_t)random->id, (uint32_t)(random->id >> 32), random->purpose, random->counter};
    const uint32_t key[2] = {(uint32_t)random->seed, (uint32_t)(random->seed >> 32)};
    uint32_t bits[4];
    pls_philox4x32(counter, key, bits);
    ++random->counter;
    out[0] = bits[0] | (uint64_t)bits[1] << 32;
    out[1] = bits[2] | (uint64_t)bits[3] << 32;
}

/// The upper 53 bits as a number in [0, 1).
static double to_unit(uint64_t bits) { return (double)(bits >> 11) * 0x1p-53; }

double pls_random_uniform(pls_random *random) { return to_unit(pls_random_u64(random)); }

double pls_random_normal(pls_random *random)
{
    const double two_pi = 6.283185307179586;
    uint64_t bits[2];
    draw(random, bits);
    double radius = sqrt(-2 * log(1 - to_unit(bits[0]))); // 1 - u lies in (0, 1], where the logarithm is finite
    return radius * cos(two_pi * to_unit(bits[1]));
}

uint64_t pls_random_u64(pls_random *random)
{
    uint64_t bits[2];
    draw(random, bits);
    return bits[0];
}
