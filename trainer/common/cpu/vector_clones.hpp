// One function compiled for several generations of x86-64: the loader picks the best that the
// processor has, so that a loop is vectorised as wide as it can be and the program still runs
// everywhere.
#pragma once

#include <cstddef>  // defines __GLIBC__, where it is that

/// Before the definition of a function that holds hot loops (not a template: it becomes an indirect
/// function of the linker's):
///
///   TUREEN_VECTOR_CLONES void scale(std::span<float> values, float factor) { .. }
///
/// What it calls is only compiled for each generation if it is inlined: keep callees `static` or
/// `inline` and mark those that -O3 might leave out of line TUREEN_ALWAYS_INLINE.
///
/// The generations differ in fused multiply-adds, so results agree between machines of one
/// generation to the bit and between others to rounding.
///
/// Nothing for other compilers and processors (Clang knows no x86-64-v names here), without glibc's
/// indirect functions, and under sanitizers, whose run time is not ready when they are resolved.
/// -DTUREEN_VECTOR_CLONES= does without, to measure one generation by -march.
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

/// Beside TUREEN_VECTOR_CLONES: everything that the function calls is inlined into each clone,
/// where the callees are not ours to mark.
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

/// Before a loop: what it writes in one turn it does not read in another, so that it is vectorised
/// without looking for pointers that overlap.
#if defined(__clang__)
#define TUREEN_INDEPENDENT_TURNS _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define TUREEN_INDEPENDENT_TURNS _Pragma("GCC ivdep")
#else
#define TUREEN_INDEPENDENT_TURNS
#endif
