// random.h -- counter-based random numbers: a pure function of (seed, id, purpose, counter), so that what a body draws does not depend on
// the order in which bodies are visited. Philox 4x32-10 (Salmon et al., SC 2011), tested against its published known answers.
#ifndef PLS_BASE_RANDOM_H
#define PLS_BASE_RANDOM_H

#include <stdint.h>

/// What a stream of numbers is for; keeps streams of the same body apart. Never renumber.
typedef enum pls_purpose {
    PLS_FOR_POSITION = 1,
    PLS_FOR_SIZE = 2,
    PLS_FOR_ORIENTATION = 3,
    PLS_FOR_VELOCITY = 4,
    PLS_FOR_SHAPE = 5,
    PLS_FOR_TOUGHNESS = 6,
    PLS_FOR_USER = 64
} pls_purpose;

typedef struct pls_random
{
    uint64_t seed;
    uint64_t id;
    uint32_t purpose;
    uint32_t counter; ///< advances with each draw
} pls_random;

static inline pls_random pls_random_stream(uint64_t seed, uint64_t id, pls_purpose purpose)
{
    return (pls_random){seed, id, (uint32_t)purpose, 0};
}
/// The generator itself: ten rounds of Philox 4x32.
void pls_philox4x32(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);
/// Uniform in [0, 1), 53 bits.
double pls_random_uniform(pls_random *random);
/// Standard normal (Box-Muller, one value per call).
double pls_random_normal(pls_random *random);
uint64_t pls_random_u64(pls_random *random);

#endif
