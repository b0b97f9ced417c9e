// hash.c -- FNV-1a over 8-byte words, each round ended by a fold.
//
// Exactly: the data is read as little-endian 64-bit words; each word w does
//     hash = (hash xor w) * 0x100000001b3 mod 2^64;   hash = hash xor (hash >> 32).
// One to seven bytes left over are zero-padded to a word, and their number follows as one more word. No other step: a hash can be continued.
//
// The fold is needed: an odd multiplier carries differences only upwards, so without it the sign bits of two doubles flipped together would
// cancel and leave the hash unchanged.

#include "base/hash.h"

#include <string.h>

static uint64_t add_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

static uint64_t read_word(const unsigned char *bytes, size_t size)
{
    uint64_t word = 0;
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(&word, bytes, size);
#else
    for (size_t i = 0; i < size; ++i) word |= (uint64_t)bytes[i] << (8 * i);
#endif
    return word;
}

uint64_t pls_hash(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    size_t whole = size - size % 8;
    for (size_t i = 0; i < whole; i += 8) hash = add_word(hash, read_word(bytes + i, 8));
    if (whole < size)
    {
        hash = add_word(hash, read_word(bytes + whole, size - whole));
        hash = add_word(hash, size - whole);
    }
    return hash;
}
