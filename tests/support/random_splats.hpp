// Random splats of every kernel and profile, for comparisons of renderers.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/splats.hpp"

namespace tureen::test {

/// A kernel with a profile that it supports.
struct SplatKind {
  const char* name;     // of a test parameter
  const char* profile;  // in named_profiles
  enum class Kernel { windows, gaussians, flat, neural } kernel;
  bool per_corner = false;  // SplatColor::per_corner
};
inline constexpr SplatKind splat_kinds[] = {
    {"windows", "triangle-splatting", SplatKind::Kernel::windows},
    {"gaussians_3dgs", "3dgs", SplatKind::Kernel::gaussians},
    {"gaussians_mip", "mip", SplatKind::Kernel::gaussians},
    {"flat_games", "games", SplatKind::Kernel::flat},
    {"discs_2dgs", "2dgs", SplatKind::Kernel::flat},
    {"discs_redisplats", "redisplats", SplatKind::Kernel::flat},
    {"neural", "splatnet", SplatKind::Kernel::neural},
    {"windows_per_corner", "mesh-splatting", SplatKind::Kernel::windows, true}};

/// `count` splats of mean size `size` in the ball of radius 1 about the origin, with harmonics of
/// degree 2 whose colours exceed 1 in places.
Splats random_splats(const SplatKind& kind, std::size_t count, double size, std::uint64_t seed);

/// Splats of the ball, of which each has one value at a limit of what defect() accepts: opacities
/// of 0 and 1, sizes and sigmas from 1e-38 to 1e38, windows without area, centres and colours far
/// out.
Splats hostile_splats(const SplatKind& kind);

/// The values of splat `i`, column by column.
std::vector<float> values_of(const SplatKernel& kernel, std::size_t i);

/// The axes are those of the column with the role ColumnRole::scale.
struct SplatEllipsoid {
  glm::dvec3 center{0}, axes{0};
  glm::dquat rotation{1, 0, 0, 0};
};
/// Of splat `i`; nullopt for kernels without such a column.
std::optional<SplatEllipsoid> ellipsoid_of(const SplatKernel& kernel, std::size_t i);

/// A camera that sees the ball from `distance` of its centre; below 1 it is inside.
Camera camera_of_ball(double distance, int width, int height);

}  // namespace tureen::test
