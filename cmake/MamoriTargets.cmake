# The functions that every layer's CMakeLists.txt uses. Arguments only, no ambient variables.
include_guard(GLOBAL)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# A compiler cache, unless the caller has chosen a compiler launcher (an empty one too).
function(mamori_use_ccache)
    if(MAMORI_USE_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
        find_program(MAMORI_CCACHE ccache)
        mark_as_advanced(MAMORI_CCACHE)
        if(MAMORI_CCACHE)
            set(CMAKE_CXX_COMPILER_LAUNCHER "${MAMORI_CCACHE}" PARENT_SCOPE)
        endif()
    endif()
endfunction()

# mamori/version.hpp, from the version of the project.
function(mamori_version_header)
    configure_file("${PROJECT_SOURCE_DIR}/cmake/version.hpp.in" "${PROJECT_BINARY_DIR}/generated/mamori/version.hpp" @ONLY)
endfunction()

# Flags that every target of the project has.
#   -ffp-contract=off: the same bytes everywhere (a fused multiply-add rounds once where two operations round twice).
#   -UNDEBUG: assertions stay on in every configuration, and Debian's Simbody headers need it to match its library.
function(mamori_common_flags target)
    target_compile_features(${target} PUBLIC cxx_std_17)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
        "$<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast;-Wnon-virtual-dtor;-Woverloaded-virtual>"
        -Wdouble-promotion $<$<BOOL:${MAMORI_WARNINGS_AS_ERRORS}>:-Werror> -ffp-contract=off -UNDEBUG)
endfunction()

# mamori_library(<layer> [TARGET_SUBSET] [COMPONENT name] SOURCES ... DEPENDS ... PRIVATE_DEPENDS ...)
#   gives mamori_<layer> and its alias mamori::<layer>, exported and installed.
#   TARGET_SUBSET: the layer runs on a bare controller: no exceptions, no RTTI, no guarded statics.
#   COMPONENT: users ask for it, find_package(mamori COMPONENTS name), since it needs libraries that not everybody has.
function(mamori_library layer)
    cmake_parse_arguments(arg "TARGET_SUBSET" "COMPONENT" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
    set(target mamori_${layer})
    add_library(${target} STATIC ${arg_SOURCES})
    add_library(mamori::${layer} ALIAS ${target})
    mamori_common_flags(${target})
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(${target} PUBLIC ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS})
    if(arg_TARGET_SUBSET)
        target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti -fno-threadsafe-statics)
        # The check `vptr` of the undefined-behaviour sanitizer reads type information, which this layer does not have.
        target_compile_options(${target} INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang>:-fno-sanitize=vptr>)
    endif()
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${layer})
    mamori_install_target(${target} "${arg_COMPONENT}")
endfunction()

# mamori_install_target(<target> <component or "">): the target and the headers in include/ become part of the package.
function(mamori_install_target target component)
    if(NOT MAMORI_INSTALL)
        return()
    endif()
    set(export mamoriTargets)
    if(component)
        set(export mamori_${component}Targets)
    endif()
    if(NOT TARGET mamori_package) # all that `cmake --install` needs, without tests and examples
        add_custom_target(mamori_package)
    endif()
    add_dependencies(mamori_package ${target})
    install(TARGETS ${target} EXPORT ${export} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# Test sources run once or a few times: -O2 would cost more at compile time (about a quarter) than it gives at run time. What they
# link is optimised as users get it.
function(mamori_test_optimisation target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Compiles gtest.h once for all test programs: reading it costs each test file half a second. Not with a compiler launcher, since
# ccache keeps the objects anyway, and misses them with precompiled headers.
function(mamori_precompile_gtest target)
    if(CMAKE_CXX_COMPILER_LAUNCHER)
        return()
    endif()
    if(NOT TARGET mamori_gtest_prefix)
        add_library(mamori_gtest_prefix OBJECT "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/gtest_prefix.cpp")
        mamori_common_flags(mamori_gtest_prefix)
        mamori_test_optimisation(mamori_gtest_prefix)
        target_link_libraries(mamori_gtest_prefix PRIVATE GTest::gtest)
        target_precompile_headers(mamori_gtest_prefix PRIVATE <gtest/gtest.h>)
    endif()
    target_precompile_headers(${target} REUSE_FROM mamori_gtest_prefix)
endfunction()

# mamori_test(<name> [LONG pattern] SOURCES ... DEPENDS ...)
#   one GoogleTest program; ctest runs it and its JUnit file goes to <build>/evidence/junit/<name>.xml.
#   LONG: tests that take seconds (a filter of GoogleTest). They are <name>_long in ctest, with the label `long`: quick and
#   sanitized runs leave them out.
function(mamori_test name)
    cmake_parse_arguments(arg "" "LONG" "SOURCES;DEPENDS" ${ARGN})
    if(NOT MAMORI_BUILD_TESTS)
        return()
    endif()
    find_package(GTest REQUIRED)
    add_executable(${name} ${arg_SOURCES})
    mamori_common_flags(${name})
    mamori_test_optimisation(${name})
    target_link_libraries(${name} PRIVATE ${arg_DEPENDS} GTest::gtest GTest::gtest_main)
    target_link_libraries(${name} PRIVATE mamori::verifies)
    mamori_precompile_gtest(${name})
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/verification/support/include)
    set(output "--gtest_output=xml:${PROJECT_BINARY_DIR}/evidence/junit/${name}")
    if(arg_LONG)
        add_test(NAME ${name} COMMAND ${name} --gtest_filter=-${arg_LONG} ${output}.xml)
        add_test(NAME ${name}_long COMMAND ${name} --gtest_filter=${arg_LONG} ${output}_long.xml)
        set_tests_properties(${name}_long PROPERTIES TIMEOUT 600 LABELS long)
    else()
        add_test(NAME ${name} COMMAND ${name} ${output}.xml)
    endif()
    set_tests_properties(${name} PROPERTIES TIMEOUT 600)
endfunction()

# mamori_measure_coverage(): the tests of this folder write what they reach of it to <build>/evidence/profiles/<folder>. What clang
# cannot measure does not compile. Other programs that link the library write nothing.
# @satisfies SWR-VER-003      Design: docs/design/test_strength.md#coverage
function(mamori_measure_coverage)
    if(NOT MAMORI_MEASURE_COVERAGE)
        return()
    endif()
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "MAMORI_MEASURE_COVERAGE needs clang 18 or newer: configure with --preset host-asan, or turn it off")
    endif()
    set(tools "${PROJECT_SOURCE_DIR}/verification/coverage")
    set(launcher "${tools}/refuse_unmeasured.sh" ${CMAKE_CXX_COMPILER_LAUNCHER})
    if(NOT TARGET mamori_flush_on_death)
        add_library(mamori_flush_on_death OBJECT "${tools}/flush_on_death.cpp")
        mamori_common_flags(mamori_flush_on_death)
        # A test executes a child instruction by instruction.
        target_compile_options(mamori_flush_on_death PRIVATE -O2 -fno-sanitize=all)
    endif()
    get_property(targets DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
        get_target_property(type ${target} TYPE)
        if(type STREQUAL "EXECUTABLE")
            target_sources(${target} PRIVATE $<TARGET_OBJECTS:mamori_flush_on_death>)
            target_link_options(${target} PRIVATE -Wl,--wrap=_exit,--wrap=_Exit,--wrap=raise)
        elseif(type STREQUAL "STATIC_LIBRARY")
            target_link_options(${target} INTERFACE $<BUILD_INTERFACE:-fprofile-instr-generate=/dev/null>)
        else()
            continue()
        endif()
        target_compile_options(${target} PRIVATE
            -fprofile-instr-generate=/dev/null -fprofile-update=atomic -fcoverage-mapping -fcoverage-mcdc)
        set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "${launcher}")
    endforeach()
    get_property(tests DIRECTORY PROPERTY TESTS)
    get_filename_component(layer "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
    foreach(test IN LISTS tests)
        set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT
            "LLVM_PROFILE_FILE=${PROJECT_BINARY_DIR}/evidence/profiles/${layer}/${test}-%m.profraw")
    endforeach()
endfunction()

# @satisfies SWR-PRF-039      Design: docs/design/launcher.md#consumer-proof
function(mamori_install_package)
    set(mamori_model_dir "${CMAKE_INSTALL_DATADIR}/mamori/models")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/simbody_sim/models/" DESTINATION ${mamori_model_dir})
    configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/mamoriConfig.cmake.in"
        "${PROJECT_BINARY_DIR}/mamoriConfig.cmake" INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mamori
        PATH_VARS mamori_model_dir)
    write_basic_package_version_file("${PROJECT_BINARY_DIR}/mamoriConfigVersion.cmake"
        VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
    install(FILES "${PROJECT_BINARY_DIR}/mamoriConfig.cmake" "${PROJECT_BINARY_DIR}/mamoriConfigVersion.cmake"
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mamori)
    install(FILES "${PROJECT_BINARY_DIR}/generated/mamori/version.hpp" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mamori)
    install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/mamori)
    install(EXPORT mamoriTargets NAMESPACE mamori:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mamori)
    if(MAMORI_WITH_SIMBODY_SIM)
        install(EXPORT mamori_simbody_simTargets NAMESPACE mamori:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mamori)
    endif()
endfunction()
