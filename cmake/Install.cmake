# Installation, find_package(particls) and pkg-config.

include(CMakePackageConfigHelpers)

set(PARTICLS_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/particls)

install(TARGETS particls EXPORT particls-targets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/particls DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET particls_program)
    # The program finds the library beside it, wherever both are moved.
    file(RELATIVE_PATH library_from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(particls_program PROPERTIES INSTALL_RPATH "$ORIGIN/${library_from_program}")
    install(TARGETS particls_program)
endif()

install(EXPORT particls-targets NAMESPACE particls:: DESTINATION ${PARTICLS_CMAKE_DIR})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/particls-config.cmake.in
    ${PROJECT_BINARY_DIR}/particls-config.cmake INSTALL_DESTINATION ${PARTICLS_CMAKE_DIR})
# Until 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/particls-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/particls-config.cmake ${PROJECT_BINARY_DIR}/particls-config-version.cmake
    DESTINATION ${PARTICLS_CMAKE_DIR})

# The prefix is written relative to the .pc file, so that an installed tree may be moved.
file(RELATIVE_PATH PARTICLS_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH PARTICLS_PC_LIBDIR ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH PARTICLS_PC_INCLUDEDIR ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(${PROJECT_SOURCE_DIR}/cmake/particls.pc.in ${PROJECT_BINARY_DIR}/particls.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/particls.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
