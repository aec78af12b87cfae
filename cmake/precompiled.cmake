# SPDX-License-Identifier: MIT
# SLUICE_PCH: the headers that most files include are read once for each set of flags and not once for each file. With clang 14
# that takes a third off the libraries and two fifths off the tests; gcc 12 gains a fifth. The sanitized presets set it;
# the default build does without, so that it goes on proving that every file includes what it uses.
option(SLUICE_PCH "Precompile the headers that most files include (needs clang)" OFF)
if(NOT SLUICE_PCH)
    return()
endif()
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "SLUICE_PCH needs clang: configure with -DCMAKE_CXX_COMPILER=clang++, or leave it OFF")
endif()
if(CCACHE)
    # Without this ccache passes every file with a precompiled header by; a change of one of its headers still makes it anew.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

find_package(nlohmann_json REQUIRED)
set(SLUICE_PCH_HEADERS <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <cstdint> <cstring> <filesystem>
    <fstream> <functional> <map> <memory> <mutex> <optional> <set> <span> <sstream> <string> <string_view> <thread>
    <unordered_map> <utility> <variant> <vector> <fmt/format.h> <nlohmann/json.hpp>)

# Makes a target precompile headers: for itself, and for others that name it.
function(sluice_precompile target)
    # The time of the header that CMake writes differs between checkouts that share ccache; its text does not.
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>)
    list(TRANSFORM ARGN REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:\\1>")
    target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()

# A library of no code of its own, so that no other has to wait for more than the headers.
function(sluice_add_precompiled name)
    cmake_parse_arguments(arg "" "" "HEADERS;LIBS;OPTIONS" ${ARGN})
    file(CONFIGURE OUTPUT ${name}.cpp CONTENT "")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    target_link_libraries(${name} PRIVATE sluice_options fmt::fmt nlohmann_json::nlohmann_json ${arg_LIBS})
    target_compile_options(${name} PRIVATE ${arg_OPTIONS})
    sluice_precompile(${name} ${SLUICE_PCH_HEADERS} ${arg_HEADERS})
endfunction()

sluice_add_precompiled(sluice_precompiled)
if(SLUICE_TESTS OR SLUICE_FUZZ) # as the folder tests is
    find_package(GTest REQUIRED)
    # As the programs that use them are compiled: clang tells a program's position independence from a library's.
    foreach(level 0 1)
        sluice_add_precompiled(sluice_precompiled_tests_O${level} HEADERS <gtest/gtest.h> <gmock/gmock.h>
            LIBS GTest::gtest GTest::gmock OPTIONS -O${level} -fPIE)
        set_target_properties(sluice_precompiled_tests_O${level} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    endforeach()
endif()

# CMake cannot give a target with a C source another's precompiled C++ headers: such a one reads them for each file.
function(sluice_reuse_precompiled target owner)
    get_target_property(c_sources ${target} SOURCES)
    list(FILTER c_sources INCLUDE REGEX "\\.c$")
    if(NOT c_sources)
        target_precompile_headers(${target} REUSE_FROM ${owner})
    endif()
endfunction()

# Every static library of ours in this folder and below, but for those with flags of their own.
function(sluice_precompile_libraries folder)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
        get_target_property(type ${target} TYPE)
        get_target_property(options ${target} COMPILE_OPTIONS)
        get_target_property(libraries ${target} LINK_LIBRARIES)
        if(type STREQUAL STATIC_LIBRARY AND NOT options AND sluice_options IN_LIST libraries)
            sluice_reuse_precompiled(${target} sluice_precompiled)
        endif()
    endforeach()
    get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
    foreach(folder ${folders})
        sluice_precompile_libraries(${folder})
    endforeach()
endfunction()
