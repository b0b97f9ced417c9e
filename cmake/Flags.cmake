# How everything here is compiled. Results are the same bits for every machine, variant and number of threads, so nothing may
# contract, reassociate or approximate; errno and floating-point traps are given up, because they only hinder vector code.

add_library(particls_flags INTERFACE)
target_compile_options(particls_flags INTERFACE
    -ffp-contract=off -fno-math-errno -fno-trapping-math
    -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes
    -fno-omit-frame-pointer
    $<$<CONFIG:Release>:-g>
    $<$<BOOL:${PARTICLS_WERROR}>:-Werror>)
target_link_libraries(particls_flags INTERFACE OpenMP::OpenMP_C)

if(PARTICLS_SANITIZE)
    target_compile_options(particls_flags INTERFACE -fsanitize=${PARTICLS_SANITIZE} -fno-sanitize-recover=all)
    target_link_options(particls_flags INTERFACE -fsanitize=${PARTICLS_SANITIZE})
endif()

# How a user compiles a plugin, as `particls plugin --cflags` and pkg-config print it.
set(PARTICLS_PLUGIN_FLAGS "-shared -fPIC -std=gnu17 -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math")

# Instruction sets. Files named *_simd.c are compiled once for each of PARTICLS_ISAS, with PLS_ISA=<name> defined, and the library
# picks one at run time; all else is compiled for the baseline.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|amd64|AMD64)$")
    set(PARTICLS_ISAS v2 v3 v4)
    set(PARTICLS_ISA_FLAGS_v2 -march=x86-64-v2)
    set(PARTICLS_ISA_FLAGS_v3 -march=x86-64-v3 -mprefer-vector-width=256)
    set(PARTICLS_ISA_FLAGS_v4 -march=x86-64-v4 -mprefer-vector-width=512)
    set(PARTICLS_BASELINE_FLAGS ${PARTICLS_ISA_FLAGS_v2})
else()
    set(PARTICLS_ISAS generic)
    set(PARTICLS_ISA_FLAGS_generic "")
    set(PARTICLS_BASELINE_FLAGS "")
    target_compile_definitions(particls_flags INTERFACE PLS_ISA_ONLY_GENERIC)
endif()
