// What lets one function be compiled for the processor and for the graphics processor.
#pragma once

/// Instead of `inline`, before a kernel's mathematics: callable from both sides under nvcc, an
/// inline function anywhere else. What is marked so calls nothing but its like and the functions of
/// <cmath>, throws nothing and owns nothing.
#if defined(__CUDACC__)
#define TUREEN_HOST_DEVICE __host__ __device__ inline
#else
#define TUREEN_HOST_DEVICE inline
#endif
