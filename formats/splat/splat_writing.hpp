// What all writers of splat formats do: splats in world coordinates, and the sentences about what
// these formats lose.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace tureen {

/// The up axis of splat files: y points down in COLMAP.
inline constexpr glm::vec3 splat_up{0.0f, -1.0f, 0.0f};

/// Moves the splats into world coordinates; relative to the layer's origin if that is so far away
/// that positions would lose more than 7 of their 24 bits.
void place_in_world(Layer& layer);

/// One sentence for each loss of a format that holds a profile by its name, `stored`.
std::vector<std::string> profile_losses(SplatProfile profile, const std::string& format,
                                        std::string_view stored);

/// One sentence for each loss of a format that holds splats and a profile, and nothing else.
/// `layer` is placed; `stored` is the profile that readers find.
std::vector<std::string> splat_losses(const Scene& scene, const Layer& layer,
                                      const std::string& format, std::string_view stored);

/// Whether the scene is one layer with Gaussians.
bool holds_gaussians(const Scene& scene);

/// What a format can store of Gaussians.
struct GaussianFormat {
  std::string name;  // "SPZ", in sentences
  int max_degree = 3;
  bool has_mip = true;    // else readers use 3dgs
  bool has_flat = false;  // discs, which span the local x and y axes
  std::string_view flat_profile = "2dgs";
};

/// The Gaussians of a scene as a format stores them.
struct StoredGaussians {
  Splats splats;             // in world coordinates; coefficients up to the largest degree
  std::string_view profile;  // "3dgs", "mip" or "2dgs"
  std::vector<std::string> lost;

  const Gaussians& gaussians() const { return std::get<Gaussians>(splats.kernel); }
};

/// Copies the Gaussians of a scene. Discs become ellipsoids without thickness unless the format has
/// them. Throws UsageError if the scene has several layers or something else than Gaussians.
StoredGaussians gaussians_for(const Scene& scene, const GaussianFormat& format);

/// Rotations and axes of an ellipsoid have 24 forms. The one with descending scales whose w is the
/// largest part of the quaternion, and positive; for discs z stays the normal. Formats that store
/// the smaller parts of quaternions then need fewer bits.
void order_axes(glm::vec3& scales, glm::quat& rotation, bool flat);

}  // namespace tureen
