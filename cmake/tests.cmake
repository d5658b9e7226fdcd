# Test programs, one per group of sources in tests/MODULE, and the target tests_MODULE that builds them.

# Tests spend most of their time in the tested code, so -O1 saves more build time than it costs run
# time.
set(tureen_test_options $<$<CONFIG:Release>:-O1>)

set(tureen_suite_timeout 300)
if(TUREEN_SANITIZE)
  set(tureen_suite_timeout 2400)  # the thread sanitizer takes 8 to 20 times as long
endif()

# Sets OUT to the name of the tested module: the folder in tests/ that calls this function.
function(tureen_tested_module out)
  get_filename_component(module "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  set(${out} "${module}" PARENT_SCOPE)
  if(NOT TARGET tests_${module})
    add_custom_target(tests_${module})
  endif()
endfunction()

# tureen_test(NAME SOURCES .. LINK ..): a GoogleTest program with one ctest entry per test suite
# (cmake/discover_suites.cmake), labelled with its module.
function(tureen_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  tureen_tested_module(module)
  add_executable(${name} ${ARG_SOURCES})
  add_dependencies(tests_${module} ${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gmock GTest::gtest_main tureen_warnings)
  target_compile_definitions(${name} PRIVATE
    TUREEN_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TUREEN_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_precompile_headers(${name} REUSE_FROM test_precompiled)
  target_compile_options(${name} PRIVATE ${tureen_test_options})

  set(suites "${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake")
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS
    "${PROJECT_SOURCE_DIR}/cmake/discover_suites.cmake")
  add_custom_command(TARGET ${name} POST_BUILD BYPRODUCTS "${suites}"
    COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:${name}>" "-DMODULE=${module}"
      "-DTIMEOUT=${tureen_suite_timeout}" "-DTIMES=${PROJECT_BINARY_DIR}/test_times" "-DOUT=${suites}"
      -P "${PROJECT_SOURCE_DIR}/cmake/discover_suites.cmake"
    VERBATIM)
  # ctest reads this file; before the first build of the program there are no suites.
  set(include "${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake")
  file(WRITE "${include}" "if(EXISTS \"${suites}\")\n  include(\"${suites}\")\nelse()\n"
    "  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\n"
    "  set_tests_properties(${name}_NOT_BUILT PROPERTIES LABELS ${module})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${include}")
endfunction()
