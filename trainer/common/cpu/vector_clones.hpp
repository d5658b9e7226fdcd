// One function compiled for several generations of x86-64. The loader picks the best one that the
// processor supports: loops use the widest vectors, and the program still runs on older processors.
#pragma once

#include <cstddef>  // defines __GLIBC__ on glibc

/// Place it before the definition of a function with hot loops. The function must not be a
/// template: it becomes an indirect function of the linker.
///
///   TUREEN_VECTOR_CLONES void scale(std::span<float> values, float factor) { .. }
///
/// A callee is compiled for each generation only if it is inlined: make callees `static` or
/// `inline`, and mark those that -O3 may not inline TUREEN_ALWAYS_INLINE.
///
/// The generations differ in fused multiply-adds. Results are the same to the bit on machines of
/// one generation, and the same within rounding on others.
///
/// The macro is empty for other compilers and processors (Clang rejects the x86-64-v names here)
/// and without glibc's indirect functions. It is also empty with sanitizers, whose run time is not
/// ready when the loader resolves indirect functions. -DTUREEN_VECTOR_CLONES= disables the clones,
/// to measure one generation with -march.
#ifndef TUREEN_VECTOR_CLONES
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&   \
    !defined(__CUDACC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    __GNUC__ >= 12
#define TUREEN_VECTOR_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TUREEN_VECTOR_CLONES
#endif
#endif

/// With TUREEN_VECTOR_CLONES: inlines all callees into each clone, for callees that we cannot mark.
#if defined(__GNUC__) && defined(__OPTIMIZE__)
#define TUREEN_FLATTEN __attribute__((flatten))
#else
#define TUREEN_FLATTEN
#endif

/// Instead of `inline`.
#if defined(__GNUC__)
#define TUREEN_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define TUREEN_ALWAYS_INLINE inline
#endif

/// Before a loop whose iterations do not read what other iterations write. The compiler then
/// vectorises it without checks for overlapping pointers.
#if defined(__clang__)
#define TUREEN_INDEPENDENT_TURNS _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define TUREEN_INDEPENDENT_TURNS _Pragma("GCC ivdep")
#else
#define TUREEN_INDEPENDENT_TURNS
#endif
