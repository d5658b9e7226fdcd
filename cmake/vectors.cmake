# Highway for kernels with vectors in arrays and structs. Vectors whose size is unknown at compile
# time do not support these.
add_library(tureen_vectors INTERFACE)
if(EMSCRIPTEN)
  # Only its headers: pages have one kind of vectors, so nothing is chosen at run time.
  target_compile_definitions(tureen_vectors INTERFACE HWY_COMPILE_ONLY_STATIC)
else()
  find_package(hwy REQUIRED)
  target_link_libraries(tureen_vectors INTERFACE hwy::hwy)
  set(disabled "HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV")
  # With sanitizers, each kind of vectors takes minutes to compile: two kinds suffice for their tails.
  if(TUREEN_SANITIZE)
    string(APPEND disabled "|(HWY_AVX2-1)|HWY_SSE4|HWY_SSSE3")  # lower bits are wider vectors
  endif()
  target_compile_definitions(tureen_vectors INTERFACE "HWY_DISABLED_TARGETS=(${disabled})")
endif()
