// simd.c -- which instruction set to use, found once.

#include "math/simd.h"

#include <stdlib.h>
#include <string.h>

static int find_level(void)
{
    int level = 0;
#if !defined(PLS_ISA_ONLY_GENERIC) && (defined(__x86_64__) || defined(__i386__))
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) level = 1;
    if (level == 1 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        level = 2;
#endif
    const char *wish = getenv("PARTICLS_ISA");
    if (wish && strcmp(wish, "v2") == 0) level = 0;
    if (wish && strcmp(wish, "v3") == 0 && level > 1) level = 1;
    return level;
}

int pls_isa_level(void)
{
    static int known = -1; // every thread would write the same value
    int level = __atomic_load_n(&known, __ATOMIC_RELAXED);
    if (level < 0)
    {
        level = find_level();
        __atomic_store_n(&known, level, __ATOMIC_RELAXED);
    }
    return level;
}

const char *pls_isa_name(void)
{
#if defined(PLS_ISA_ONLY_GENERIC)
    return "generic";
#else
    static const char *const names[] = {"x86-64-v2", "x86-64-v3 (AVX2)", "x86-64-v4 (AVX-512)"};
    return names[pls_isa_level()];
#endif
}
