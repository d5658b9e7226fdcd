# Checks the arrows between modules before compiling (cmake/arrows.cmake).
file(GLOB_RECURSE arrows_sources CONFIGURE_DEPENDS LIST_DIRECTORIES false
  base/*.?pp image/*.?pp scene/*.?pp camera/*.?pp formats/*.?pp oracle/*.?pp splatting/*.?pp
  runtime/*.?pp trainer/*.?pp trainer/*.cu* jobs/*.?pp viewer/*.?pp web/engine/*.?pp)
set(arrows_stamp "${PROJECT_BINARY_DIR}/arrows.stamp")
add_custom_command(
  OUTPUT "${arrows_stamp}"
  COMMAND "${CMAKE_COMMAND}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DSTAMP=${arrows_stamp}"
          -P "${PROJECT_SOURCE_DIR}/cmake/arrows.cmake"
  DEPENDS "${PROJECT_SOURCE_DIR}/cmake/arrows.cmake" ${arrows_sources}
  COMMENT "Checking the arrows between modules"
  VERBATIM)
add_custom_target(arrows DEPENDS "${arrows_stamp}")

# tureen_module(NAME SOURCES .. PUBLIC .. PRIVATE ..): the library tureen_NAME of a folder. Its headers
# include only PUBLIC modules and libraries; its sources also include PRIVATE ones.
function(tureen_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(tureen_${name} STATIC ${ARG_SOURCES})
  add_dependencies(tureen_${name} arrows)
  target_link_libraries(tureen_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} tureen_warnings)
endfunction()

# Tests spend most of their time in the tested code, so -O1 saves more build time than it costs run
# time.
set(tureen_test_options $<$<CONFIG:Release>:-O1>)

# tureen_test(NAME SOURCES .. LINK ..): a GoogleTest program with one ctest entry per test.
function(tureen_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gmock GTest::gtest_main tureen_warnings)
  target_compile_definitions(${name} PRIVATE
    TUREEN_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TUREEN_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_precompile_headers(${name} REUSE_FROM test_precompiled)
  target_compile_options(${name} PRIVATE ${tureen_test_options})
  set(timeout 300)
  if(TUREEN_SANITIZE)
    set(timeout 1200)  # damage of glTF takes 295 s under the thread sanitizer
  endif()
  # NO_PRETTY_VALUES omits parameter values from test names. For types without a printer they would be
  # raw bytes.
  gtest_discover_tests(${name} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${timeout})
endfunction()
