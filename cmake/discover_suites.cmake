# Writes a file for ctest with an entry PROGRAM.SUITE per test suite of a GoogleTest program. Each suite is
# one process: its tests share fixtures, which saves 3,400 program starts. Suites whose
# full names begin with "Thorough" get the label "thorough": only `./dev test --all` runs them.
#
#   cmake -DPROGRAM=.. -DMODULE=.. -DTIMEOUT=seconds -DTIMES=folder -DOUT=x.cmake
#         -P discover_suites.cmake
#
# Each entry writes the times of its tests to TIMES/SUITE.json.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed ERROR_VARIABLE errors
  RESULT_VARIABLE failed TIMEOUT 60)
if(failed)
  message(FATAL_ERROR "${PROGRAM} does not list its tests: ${failed}\n${errors}")
endif()
get_filename_component(program "${PROGRAM}" NAME)
# Names of parameters may contain the separators of CMake's lists.
string(REGEX REPLACE "[][;]" "_" listed "${listed}")
string(REPLACE "\n" ";" lines "${listed}")
set(entries "")
foreach(line IN LISTS lines)
  if(line MATCHES "^DISABLED_" OR NOT line MATCHES "^([^ ]+)\\.( |$)")
    continue()
  endif()
  set(suite "${CMAKE_MATCH_1}")
  set(labels "${MODULE}")
  if(suite MATCHES "^Thorough")
    string(APPEND labels ";thorough")
  endif()
  string(REPLACE "/" "." file "${suite}")
  string(APPEND entries
    "add_test([=[${program}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=] --gtest_brief=1"
    " [=[--gtest_output=json:${TIMES}/${program}/${file}.json]=])\n"
    "set_tests_properties([=[${program}.${suite}]=] PROPERTIES TIMEOUT ${TIMEOUT} LABELS [=[${labels}]=])\n")
endforeach()
file(WRITE "${OUT}" "${entries}")
