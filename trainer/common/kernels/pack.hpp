// Sixteen floats that behave like one number. Kernels are templates on their number type: they run
// on a pack as on a float or a double. A processor then executes one instruction for sixteen
// pixels, as a GPU does with its threads.
#pragma once

#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

#if defined(__GNUC__) && !defined(__CUDACC__)

inline constexpr int pack_lanes = 16;  // one register of AVX-512, two of AVX2, four of SSE
using Pack __attribute__((vector_size(sizeof(float) * pack_lanes))) = float;
using IntPack __attribute__((vector_size(sizeof(float) * pack_lanes))) = std::int32_t;

#endif

}  // namespace tureen::trainer::kernels
