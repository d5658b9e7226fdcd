// What a kernel of the CUDA backend is: a struct that runs on a GPU and, thread after thread, on a
// processor. That is how everything but the launches is tested where there is no GPU
// (tests/trainer/host_machine.hpp); trainer/common/cuda/cuda_machine.cuh is the GPU's side.
//
//   struct Kernel {
//     static constexpr unsigned threads = 128;  // of a block
//     struct Shared { .. };                     // a block's memory, uninitialised
//     struct Local { .. };                      // a thread's memory, zeros at the start
//     float* argument; ..                       // its members, pointers to the device's memory
//
//     unsigned phases() const;                  // the same for all threads of a block
//     template <class Atomics>
//     void run(unsigned phase, const Thread& at, Shared& shared, Local& local) const;
//   };
//
// All threads of a block finish a phase before the next begins; within a phase they only meet in
// Atomics. Blocks do not meet at all but there. Kernels whose threads do not work together have one
// phase and Nothing to share.
//
// Whatever is added from many threads is an integer: a gradient is added in fixed point, so that
// the order of additions, which nobody knows on a GPU, does not change a bit of the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::cuda {

struct Thread {
  unsigned block, thread, blocks;
};

struct Nothing {};

/// A sum in fixed point: two's complement, so that it may be added as an unsigned number.
using Fixed = unsigned long long;

/// What is added at once stays below this, what is larger counts as not finite: a gradient of a
/// mean over pixels that is near it has lost its way, and a sum needs 8 times as much of one sign
/// before it leaves the range of texture_scale.
inline constexpr float largest_addend = 1024;

// Units per 1. Gradients by a texel are of means over millions of pixels, 1e-9 and more where they
// matter (Adam's epsilon is 1e-8): steps of 2^-50 leave them six digits. Those by a corner are
// larger by pixels per unit of length. Sums of losses have up to 1e8 terms of about 1.
inline constexpr float texture_scale = 0x1p50f, corner_scale = 0x1p42f, loss_scale = 0x1p32f;

TUREEN_HOST_DEVICE Fixed to_fixed(double value, float scale) {
  return Fixed(static_cast<long long>(value * double(scale)));
}

/// For floats the product with a power of two is exact in single precision as well.
TUREEN_HOST_DEVICE Fixed to_fixed(float value, float scale) {
  return Fixed(static_cast<long long>(value * scale));
}

TUREEN_HOST_DEVICE float from_fixed(Fixed sum, float scale) {
  return float(static_cast<long long>(sum)) / scale;
}

/// False for NaN, too.
TUREEN_HOST_DEVICE bool can_be_added(float value) {
  return value < largest_addend && value > -largest_addend;
}

/// The last i in [0, count) with begin[i] <= value, where begin ascends from 0.
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
