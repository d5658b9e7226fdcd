# Settings for libFuzzer: clang, with its fuzzer and sanitizers in all targets. Included before any
# module. The fuzz targets are in tests/fuzz.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "libFuzzer needs clang; ./dev fuzz selects it")
endif()

# Enables assertions, including those of the standard library. A failed assertion is a fault in builds
# without assertions.
add_compile_options(-O1 -gline-tables-only -fsanitize=fuzzer-no-link,address,undefined
  -fno-sanitize-recover=all -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS)
add_link_options(-fsanitize=address,undefined)

# The sources that read and write the trainer's checkpoints. The whole trainer would take longer to
# build than all other fuzzed code.
function(tureen_fuzz_trainer)
  find_package(fmt REQUIRED)
  find_package(nlohmann_json REQUIRED)
  find_package(ZLIB REQUIRED)
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/trainer/" OUTPUT_VARIABLE sources)
  add_library(tureen_trainer STATIC ${sources})
  target_link_libraries(tureen_trainer PUBLIC tureen_formats
    PRIVATE nlohmann_json::nlohmann_json fmt::fmt ZLIB::ZLIB tureen_warnings)
endfunction()
