# Warnings for all targets of the project, without system headers.
add_library(tureen_warnings INTERFACE)
target_compile_options(tureen_warnings INTERFACE -Wall -Wextra -Wshadow -Wpedantic)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False positives for string concatenation: GCC bug 105651, fixed in 13. With a precompiled header,
  # GCC also reports the last two, in the standard library.
  target_compile_options(tureen_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
endif()
if(CMAKE_UNITY_BUILD)
  # In a unity build, names in one source may shadow those in another source's anonymous namespace.
  # Preset dev compiles each source separately, with all warnings.
  target_compile_options(tureen_warnings INTERFACE -Wno-shadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(tureen_warnings INTERFACE -Wshadow=local -Wno-subobject-linkage)
  endif()
endif()
if(TUREEN_WERROR)
  target_compile_options(tureen_warnings INTERFACE -Werror)
endif()
