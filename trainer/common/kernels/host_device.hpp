// A macro for functions that are compiled for both the processor and the GPU.
#pragma once

/// Replaces `inline` before a kernel's mathematics. With nvcc the function is callable on host and
/// device; with other compilers it is inline. A marked function calls only marked functions and
/// <cmath>, throws nothing and owns no memory. GCC inlines it even into long functions: a function
/// that is not inlined is compiled for one generation of processors only
/// (trainer/common/cpu/vector_clones.hpp).
#if defined(__CUDACC__)
#define TUREEN_HOST_DEVICE __host__ __device__ inline
#elif defined(__GNUC__) && defined(__OPTIMIZE__)
#define TUREEN_HOST_DEVICE [[gnu::always_inline]] inline
#else
#define TUREEN_HOST_DEVICE inline
#endif
