// What lets one function be compiled for the processor and for the graphics processor.
#pragma once

/// Instead of `inline`, before a kernel's mathematics: callable from both sides under nvcc, an
/// inline function anywhere else. What is marked so calls nothing but its like and the functions of
/// <cmath>, throws nothing and owns nothing. GCC is made to inline it even into long functions: a
/// kernel that stays out of line is compiled for one generation of processors only
/// (trainer/common/cpu/vector_clones.hpp).
#if defined(__CUDACC__)
#define TUREEN_HOST_DEVICE __host__ __device__ inline
#elif defined(__GNUC__) && defined(__OPTIMIZE__)
#define TUREEN_HOST_DEVICE [[gnu::always_inline]] inline
#else
#define TUREEN_HOST_DEVICE inline
#endif
