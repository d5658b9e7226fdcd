// Collects the splats of a file. It drops invalid ones, sorts the others, and adds the remarks that
// all formats share.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "base/input.hpp"
#include "formats/common/splat_values.hpp"
#include "formats/read_options.hpp"
#include "formats/splat/splat_writing.hpp"
#include "scene/scene.hpp"

namespace tureen {

class SplatBuilder {
 public:
  /// `kernel` without splats, `count` splats to come. Takes the memory of `count` splats from the
  /// input's budget, of at most an eighth more than ReadOptions::max_splats. The caller has checked
  /// that the input can hold them. Throws InputError for 2^32 splats or more.
  SplatBuilder(Input& input, const ReadOptions& options, SplatKernel kernel, int degree,
               std::uint64_t count);

  /// Rounds the values to float and adds the splat. Drops it unless is_valid() and unit_rotation()
  /// accept it. `coefficients`: harmonics::count(degree). `values`: of the kernel's column with the
  /// role ColumnRole::value, if it has one.
  void add(const SplatValues& splat, std::span<const glm::vec3> coefficients,
           std::span<const float> values = {});

  /// Centres are stored relative to this point, the origin of the layer: before the first add().
  void set_origin(const glm::dvec3& origin) { origin_ = origin; }

  /// A scene with the splats in Morton order, up -y (assumed, as in COLMAP), and remarks.
  /// `profile` must fit the kernel; its min_center_depth is lowered if the splats lie within twice
  /// that distance, since it would then remove most of them from a usual view. `format` is its name
  /// in sentences.
  Scene finish(const SplatProfile& profile, const std::string& format);

 private:
  /// Takes memory; throws InputError with a number of splats that would fit if the budget is
  /// exceeded.
  void take(std::uint64_t bytes, const std::string& what);
  /// Removes all but the largest splats.
  void keep_largest();

  Input& input_;
  bool keep_rows_;
  /// With ReadOptions::max_splats: the number that stays, and that to which the splats may grow.
  std::size_t kept_ = 0, held_ = 0;
  std::uint64_t fitting_ = 0;  // number of splats that the budget holds
  std::uint64_t added_ = 0, dropped_ = 0;
  Splats splats_;
  glm::dvec3 origin_{0.0};
};

}  // namespace tureen
