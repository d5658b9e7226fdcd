// A kernel of the CUDA backend is a struct that runs on a GPU and, thread after thread, on a
// processor. Tests therefore run everything except the launches without a GPU
// (tests/trainer/host_machine.hpp). trainer/common/cuda/cuda_machine.cuh runs kernels on a GPU.
//
//   struct Kernel {
//     static constexpr unsigned threads = 128;  // per block
//     struct Shared { .. };                     // memory of a block, uninitialised
//     struct Local { .. };                      // memory of a thread, zeros at the start
//     float* argument; ..                       // members: pointers to the device's memory
//
//     unsigned phases() const;                  // the same for all threads of a block
//     template <class Atomics>
//     void run(unsigned phase, const Thread& at, Shared& shared, Local& local) const;
//   };
//
// All threads of a block finish a phase before the next begins. Within a phase, threads share data
// only through Atomics; so do blocks in all phases. Kernels with independent threads have one phase
// and share Nothing.
//
// Many threads add only integers: gradients are added in fixed point. The order of additions is
// undefined on a GPU, and so does not change a bit of the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::cuda {

struct Thread {
  unsigned block, thread, blocks;
};

struct Nothing {};

/// A sum in fixed point: two's complement, so unsigned additions are correct.
using Fixed = unsigned long long;

/// The largest absolute value of one addend; larger ones count as not finite. Gradients of a mean
/// over pixels are far below it unless training diverges. A sum leaves the range of texture_scale
/// only at 8 times this value.
inline constexpr float largest_addend = 1024;

// Units per 1. Texel gradients come from means over millions of pixels; the relevant ones are 1e-9
// or more (Adam's epsilon is 1e-8), and steps of 2^-50 give them six digits. Corner gradients are
// larger by the pixels per unit of length. Sums of losses have up to 1e8 terms of about 1.
inline constexpr float texture_scale = 0x1p50f, corner_scale = 0x1p42f, loss_scale = 0x1p32f;

TUREEN_HOST_DEVICE Fixed to_fixed(double value, float scale) {
  return Fixed(static_cast<long long>(value * double(scale)));
}

/// In single precision: the product of a float with a power of two is exact.
TUREEN_HOST_DEVICE Fixed to_fixed(float value, float scale) {
  return Fixed(static_cast<long long>(value * scale));
}

TUREEN_HOST_DEVICE float from_fixed(Fixed sum, float scale) {
  return float(static_cast<long long>(sum)) / scale;
}

/// False for NaN as well.
TUREEN_HOST_DEVICE bool can_be_added(float value) {
  return value < largest_addend && value > -largest_addend;
}

/// The last i in [0, count) with begin[i] <= value; `begin` ascends from 0.
template <class Number>
TUREEN_HOST_DEVICE std::size_t interval_of(const Number* begin, std::size_t count, Number value) {
  std::size_t low = 0, high = count;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    if (begin[middle] <= value)
      low = middle;
    else
      high = middle;
  }
  return low;
}

}  // namespace tureen::trainer::cuda
