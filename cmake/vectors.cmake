# Highway for kernels with vectors in arrays and structs. Vectors whose size is unknown at compile
# time do not support these.
add_library(tureen_vectors INTERFACE)
if(EMSCRIPTEN)
  # Only its headers: pages have one kind of vectors, so nothing is chosen at run time.
  target_compile_definitions(tureen_vectors INTERFACE HWY_COMPILE_ONLY_STATIC)
else()
  find_package(hwy REQUIRED)
  target_link_libraries(tureen_vectors INTERFACE hwy::hwy)
  target_compile_definitions(tureen_vectors INTERFACE
    "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV)")
endif()
