// hash.h -- 64-bit hash for state_hash, file checksums and scene hashes. FNV-1a over 8-byte words, each followed by a fold (hash.c says
// exactly): simple, fast enough and the same everywhere (little-endian words). Not cryptographic.
#ifndef PLS_BASE_HASH_H
#define PLS_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

/// Start value of a hash.
#define PLS_HASH_START UINT64_C(0xcbf29ce484222325)

/// Continue `hash` with `size` bytes. Hashing a then b equals hashing a..b only when a's size is a multiple of 8.
uint64_t pls_hash(uint64_t hash, const void *data, size_t size);

#endif
