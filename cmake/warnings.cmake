# Warnings that every target of ours is built with; system headers are not.
add_library(tureen_warnings INTERFACE)
target_compile_options(tureen_warnings INTERFACE -Wall -Wextra -Wshadow -Wpedantic)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms on string concatenation: GCC bug 105651, mended in 13. A precompiled header brings the
  # last two, which are reported in the standard library.
  target_compile_options(tureen_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
endif()
if(CMAKE_UNITY_BUILD)
  # One source may name what another one has in its anonymous namespace. Preset dev compiles each source
  # by itself, with all warnings.
  target_compile_options(tureen_warnings INTERFACE -Wno-shadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(tureen_warnings INTERFACE -Wshadow=local -Wno-subobject-linkage)
  endif()
endif()
if(TUREEN_WERROR)
  target_compile_options(tureen_warnings INTERFACE -Werror)
endif()
