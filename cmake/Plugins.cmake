# Every folder of plugins/ is one plugin: lib/plugins/<folder>.so of the build tree.

file(GLOB PARTICLS_PLUGIN_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/*/*.c)

foreach(source IN LISTS PARTICLS_PLUGIN_SOURCES)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME name)
    set(target particls_plugin_${name})
    if(NOT TARGET ${target})
        add_library(${target} MODULE)
        set_target_properties(${target} PROPERTIES
            PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/plugins)
        target_compile_options(${target} PRIVATE ${PARTICLS_BASELINE_FLAGS})
        target_link_libraries(${target} PRIVATE particls particls_flags)
    endif()
    target_sources(${target} PRIVATE ${source})
endforeach()
