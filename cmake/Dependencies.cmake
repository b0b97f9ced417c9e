# What the library is built on. A missing one is named with its Debian package.

find_package(PkgConfig)
if(NOT PkgConfig_FOUND)
    message(FATAL_ERROR "pkg-config is missing. On Debian:\n  apt-get install pkg-config")
endif()

# particls_require(<name> <debian package> <pkg-config module>...) makes PkgConfig::<name> from the first module that exists.
function(particls_require name package)
    pkg_search_module(${name} QUIET IMPORTED_TARGET GLOBAL ${ARGN})
    if(NOT ${name}_FOUND)
        message(FATAL_ERROR "${ARGV2} is missing. On Debian:\n  apt-get install ${package}\n"
            "scripts/install-packages installs all that is needed.")
    endif()
    message(STATUS "Found ${ARGV2} ${${name}_VERSION}")
endfunction()

particls_require(FYAML libfyaml-dev libfyaml)
particls_require(MUPARSER libmuparser-dev muparser)
particls_require(HDF5 libhdf5-dev hdf5-serial hdf5) # Debian keeps a parallel variant beside the serial one
particls_require(ZLIB zlib1g-dev zlib)
particls_require(QHULL libqhull-dev qhull_r)
particls_require(PNG libpng-dev libpng)
if(PARTICLS_TESTS)
    particls_require(CMOCKA libcmocka-dev cmocka)
endif()

find_package(OpenMP COMPONENTS C)
if(NOT OpenMP_C_FOUND)
    message(FATAL_ERROR "The compiler ${CMAKE_C_COMPILER} has no OpenMP. On Debian gcc (build-essential) brings it, clang needs\n"
        "  apt-get install libomp-dev")
endif()
