# What libFuzzer needs: clang, its fuzzer and sanitizers in everything, and of the modules only what
# reads. Included before any module; the fuzzers themselves are in tests/fuzz.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "libFuzzer is clang's: ./dev fuzz builds with it")
endif()

# Assertions are on, those of the standard library too: what one refuses would be a fault elsewhere.
add_compile_options(-O1 -gline-tables-only -fsanitize=fuzzer-no-link,address,undefined
  -fno-sanitize-recover=all -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS)
add_link_options(-fsanitize=address,undefined)

# What of the trainer reads and writes its checkpoints: training would take longer to build than all
# that is fuzzed.
function(tureen_fuzz_trainer)
  find_package(fmt REQUIRED)
  find_package(nlohmann_json REQUIRED)
  find_package(ZLIB REQUIRED)
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/trainer/" OUTPUT_VARIABLE sources)
  add_library(tureen_trainer STATIC ${sources})
  target_link_libraries(tureen_trainer PUBLIC tureen_formats
    PRIVATE nlohmann_json::nlohmann_json fmt::fmt ZLIB::ZLIB tureen_warnings)
endfunction()
