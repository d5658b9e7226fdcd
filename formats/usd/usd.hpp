// USD ParticleField (UsdVol, OpenUSD 26.03), read and written as text: .usda, and .usdz with a
// .usda. Experimental: the schema is new, and few programs read it.
// https://openusd.org/release/user_guides/schemas/usdVol/ParticleField.html
//
//   def ParticleField3DGaussianSplat   ellipsoids
//   def ParticleField                  with ParticleFieldKernelGaussianSurfletAPI: discs that span
//                                      the local x and y axes
//     point3f[] positions              or halfs with h at the end of the name, as the others
//     quatf[] orientations             (w, x, y, z)
//     float3[] scales                  standard deviations
//     float[] opacities                0..1
//     int radiance:sphericalHarmonicsDegree
//     float3[] radiance:sphericalHarmonicsCoefficients   all of a splat, one after the other
// Transforms of the prims and their parents place the layers; upAxis is the up axis.
//
// Not supported: binary USD (.usdc), references, variants, values over time, constant surflets,
// cameras, meshes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the file begins as USD, text or binary, or as an archive whose first file is one.
bool is_usd(std::span<const std::byte> head);

/// A layer for each field of particles, with the profile 3dgs or 2dgs. Throws InputError with the
/// line; for binary files the hint names the command that converts them.
Scene read_usd(Input input, const ReadOptions& options = {});
Scene read_usd(const std::filesystem::path& path, const ReadOptions& options = {});

/// All layers, as .usda or, by the extension, .usdz. The up axis becomes y, unless it is z. Values
/// read back bit for bit. Returns one sentence for each loss. Throws UsageError for other scenes
/// than Gaussians, OutputError.
std::vector<std::string> write_usd(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
