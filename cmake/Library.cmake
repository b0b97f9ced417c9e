# libparticls: shared, so that the program and the plugins it loads use one copy.
#
# All symbols are visible: plugins resolve the public ones, the tests also reach the internal ones.

file(GLOB_RECURSE PARTICLS_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.c)
set(PARTICLS_SIMD_SOURCES ${PARTICLS_SOURCES})
list(FILTER PARTICLS_SIMD_SOURCES INCLUDE REGEX "_simd\\.c$")
list(FILTER PARTICLS_SOURCES EXCLUDE REGEX "_simd\\.c$")

add_library(particls SHARED ${PARTICLS_SOURCES})
add_library(particls::particls ALIAS particls)
set_target_properties(particls PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_include_directories(particls
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_compile_features(particls PUBLIC c_std_17)
target_compile_options(particls PRIVATE ${PARTICLS_BASELINE_FLAGS})
target_link_libraries(particls
    PUBLIC m # the inline vector functions of the public headers use sqrt
    PRIVATE particls_flags PkgConfig::FYAML PkgConfig::MUPARSER PkgConfig::HDF5 PkgConfig::ZLIB PkgConfig::QHULL PkgConfig::PNG ${CMAKE_DL_LIBS})

if(PARTICLS_SIMD_SOURCES)
    foreach(isa IN LISTS PARTICLS_ISAS)
        add_library(particls_simd_${isa} OBJECT ${PARTICLS_SIMD_SOURCES})
        target_include_directories(particls_simd_${isa} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
        target_compile_definitions(particls_simd_${isa} PRIVATE PLS_ISA=${isa})
        # -Wno-psabi: wide vectors are passed between functions of one file only, so their calling convention does not matter.
        target_compile_options(particls_simd_${isa} PRIVATE ${PARTICLS_ISA_FLAGS_${isa}} -Wno-psabi)
        target_link_libraries(particls_simd_${isa} PRIVATE particls_flags)
        target_sources(particls PRIVATE $<TARGET_OBJECTS:particls_simd_${isa}>)
    endforeach()
endif()
