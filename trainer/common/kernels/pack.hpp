// Sixteen floats that behave like one: kernels that are templates on their number type run on a
// pack as they run on a float or a double, and a processor does in one instruction what a GPU's
// threads do side by side.
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
