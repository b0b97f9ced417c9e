# The program, bin/particls.

file(GLOB PARTICLS_PROGRAM_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cli/*.c)

if(PARTICLS_PROGRAM_SOURCES)
    add_executable(particls_program ${PARTICLS_PROGRAM_SOURCES})
    set_target_properties(particls_program PROPERTIES OUTPUT_NAME particls)
    target_include_directories(particls_program PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/cli)
    target_compile_definitions(particls_program PRIVATE PLS_PLUGIN_FLAGS="${PARTICLS_PLUGIN_FLAGS}")
    target_compile_options(particls_program PRIVATE ${PARTICLS_BASELINE_FLAGS})
    target_link_libraries(particls_program PRIVATE particls particls_flags)
endif()
