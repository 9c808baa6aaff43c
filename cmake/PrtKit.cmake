# Compile options, and one function per kind of target: a module is a folder of sources, its
# dependencies are the arrows of the architecture diagram.

# GCC 12 misfires with -Wrestrict on std::string concatenation (GCC bug 105651).
add_library(prt_options INTERFACE)
target_compile_options(prt_options INTERFACE -Wall -Wextra -Wshadow -Werror -Wno-psabi
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
target_include_directories(prt_options INTERFACE ${CMAKE_SOURCE_DIR}/lib ${CMAKE_SOURCE_DIR})
target_compile_definitions(prt_options INTERFACE PRTKIT_VERSION="${PROJECT_VERSION}")
if(PRTKIT_SANITIZE)
  # GCC 12 also misfires with -Wmaybe-uninitialized on sanitized standard headers (bug 105562).
  target_compile_options(prt_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_compile_options(prt_options INTERFACE -fsanitize=address,undefined
                                               -fno-sanitize-recover=undefined
                                               -fno-omit-frame-pointer)
  target_link_options(prt_options INTERFACE -fsanitize=address,undefined)
endif()
if(PRTKIT_FUZZ)
  target_compile_options(prt_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                                               -fno-sanitize-recover=undefined)
  target_link_options(prt_options INTERFACE -fsanitize=address,undefined)
endif()

# prt_precompile(OWNER headers…): a precompiled header that targets of the same options share with
# REUSE_FROM. Files include what they use all the same:
# CMAKE_DISABLE_PRECOMPILE_HEADERS does without.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/empty.cpp CONTENT "")
function(prt_precompile owner)
  add_library(${owner} OBJECT ${CMAKE_BINARY_DIR}/empty.cpp)
  target_link_libraries(${owner} PRIVATE prt_options Imath::Imath fmt::fmt
                                         nlohmann_json::nlohmann_json)
  target_precompile_headers(${owner} PRIVATE
    <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <numeric>
    <optional> <span> <string> <vector> <ImathMatrix.h> <fmt/format.h> <nlohmann/json.hpp> ${ARGN})
endfunction()

# prt_module(NAME GLUE SOURCES files… DEPENDS public… PRIVATE private…): static library prt_NAME
# from those files, or from every .cpp here that no module before it was made from. A module that is
# GLUE has no loop worth optimising, only text to parse and libraries to call.
function(prt_module name)
  cmake_parse_arguments(ARG "GLUE" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  set(sources ${ARG_SOURCES})
  if(NOT sources)
    file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp *.h)
    get_property(taken DIRECTORY PROPERTY PRTKIT_TAKEN_SOURCES)
    list(REMOVE_ITEM sources ${taken})
  endif()
  set_property(DIRECTORY APPEND PROPERTY PRTKIT_TAKEN_SOURCES ${sources})
  add_library(prt_${name} STATIC ${sources})
  set_target_properties(prt_${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(prt_${name} PUBLIC prt_options ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE})
  if(ARG_GLUE)
    target_compile_options(prt_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_precompile_headers(prt_${name} REUSE_FROM prt_precompiled)
endfunction()

# prt_test(NAME NUMERIC DEPENDS libraries… LAUNCHER command…): test_NAME from every *_test.cpp of
# tests/NAME, one CTest entry, run by the command if one is given. Only tests that are NUMERIC, with
# loops of their own that take seconds, are worth optimising.
# Tests run in the source folder's tests/ so that they name their data relative to it.
function(prt_test name)
  cmake_parse_arguments(ARG "NUMERIC" "" "DEPENDS;LAUNCHER" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${name}/*.cpp ${name}/*.h)
  if(NOT sources)
    message(FATAL_ERROR "tests/${name} holds no test")
  endif()
  add_executable(test_${name} ${sources})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  if(ARG_NUMERIC)
    target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    target_precompile_headers(test_${name} REUSE_FROM prt_precompiled_numeric_tests)
  else()
    target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O0>)
    target_precompile_headers(test_${name} REUSE_FROM prt_precompiled_tests)
  endif()
  add_test(NAME ${name} COMMAND ${ARG_LAUNCHER} $<TARGET_FILE:test_${name}>
           WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}/tests)
endfunction()
