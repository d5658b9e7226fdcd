# The commit that is built, as a header that changes only when the commit does.
#
#   cmake -DSOURCE=.. -DOUT=commit.hpp -P commit.cmake     at every build
#
# "unknown" where the sources are not a git work tree or git is missing.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND git -C "${SOURCE}" describe --always --tags --dirty
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
# The sources may lie, unpacked, inside of a repository that is not theirs.
if(failed OR NOT EXISTS "${SOURCE}/.git")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#define TUREEN_COMMIT \"@commit@\"\n" @ONLY)
