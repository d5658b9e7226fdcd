# Writes a header with the current commit. The header changes only when the commit changes.
#
#   cmake -DSOURCE=.. -DOUT=commit.hpp -P commit.cmake     at every build
#
# The commit is "unknown" if the sources are not a git work tree or git is missing.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND git -C "${SOURCE}" describe --always --tags --dirty
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
# An unpacked archive of the sources may lie inside another repository.
if(failed OR NOT EXISTS "${SOURCE}/.git")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#define TUREEN_COMMIT \"@commit@\"\n" @ONLY)
