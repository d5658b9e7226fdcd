// Splats of a scene as rows of floats, as the kernel's file lists them. These are the values
// of the kernel's columns except labels, one after another, then harmonics: red, green and blue of
// each coefficient, colour by colour.
#pragma once

#include <cstdint>
#include <span>

#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"
#include "splatting/parameter_rows.hpp"

namespace tureen::splatting {

/// Of one colour.
inline std::size_t harmonics_rows(int degree) { return 3 * std::size_t(harmonics::count(degree)); }

/// The number of rows before the harmonics.
std::size_t kernel_rows(const SplatKernel& kernel);

/// Writes the values of splat `i` in the rows before the harmonics. They are those of the columns,
/// but the third scale of flat Gaussians is 0, and the networks' frequencies and phases are times
/// omega.
void write_kernel_rows(const SplatKernel& kernel, std::size_t i, std::span<float> out);

/// The splats with these indices, with harmonics up to `degree`.
ParameterRows rows_of(const Splats& splats, std::span<const std::uint32_t> which, int degree);

}  // namespace tureen::splatting
