#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <optional>

#include "formats/common/format_remarks.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/ply/ply_values.hpp"
#include "formats/splat/splat_ply.hpp"
#include "formats/splat/splat_ply_layout.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

using SplatRow = std::array<double, splat_slot::count>;

class SplatPlyReader {
 public:
  SplatPlyReader(Input& input, const PlyHeader& header, const ReadOptions& options)
      : input_(input), header_(header), options_(options), values_(input, header, options) {}

  Scene read() {
    const PlyElement& vertex = *header_.find("vertex");
    SplatPlyLayout layout = splat_ply_layout(input_, vertex);
    const SplatPlyProfile profile = splat_ply_profile(header_, layout.kernel);
    if (profile.is_flat) layout.kernel = Gaussians{.flat = true};
    SplatBuilder builder(input_, options_, layout.kernel, layout.degree, vertex.count);
    glm::dvec3 origin(0.0);
    for (const PlyElement& element : header_.elements) {
      if (&element != &vertex) {
        values_.skip_rows(element);
        continue;
      }
      for (std::uint64_t i = 0; i < element.count; ++i) {
        values_.read_row(element, layout.slots,
                         [&](std::size_t slot, double value) { row_[slot] = value; });
        if (i == 0) builder.set_origin(origin = origin_of(vertex, layout));
        add_row(layout, profile, builder);
      }
    }
    std::optional<Remark> trailing;
    if (values_.anything_left())
      trailing = Remark{&remarks::bytes_ignored, {{"bytes", values_.remaining()}}};
    Scene scene = builder.finish(profile.profile, "PLY");
    add_profile_remarks(profile, scene);
    if (trailing) scene.info.remarks.push_back(*trailing);
    if (layout.has_filter) scene.info.remarks.push_back({&remarks::filter_applied});
    if (origin == glm::dvec3(0.0) && has_doubles(vertex, layout))
      scene.info.remarks.push_back({&remarks::coordinates_rounded});
    return scene;
  }

 private:
  void add_row(const SplatPlyLayout& layout, const SplatPlyProfile& profile,
               SplatBuilder& builder) const {
    namespace slot = splat_slot;
    SplatValues splat;
    splat.center = {row_[slot::center], row_[slot::center + 1], row_[slot::center + 2]};
    splat.rotation = {row_[slot::rotation], row_[slot::rotation + 1], row_[slot::rotation + 2],
                      row_[slot::rotation + 3]};
    // The cyclic exchange of axes: our x, y, z are the file's y, z, x.
    if (profile.normal_first) splat.rotation = splat.rotation * glm::dquat(0.5, 0.5, 0.5, 0.5);
    splat.scales = {std::exp(row_[slot::scale]), std::exp(row_[slot::scale + 1]), 0.0};
    if (!profile.is_flat) splat.scales.z = std::exp(row_[slot::scale + 2]);
    splat.opacity = sigmoid(row_[slot::opacity]);
    if (layout.has_filter) apply_filter(row_[slot::filter], splat);
    std::array<glm::vec3, harmonics::count(harmonics::max_degree)> coefficients;
    const auto used = static_cast<std::size_t>(harmonics::count(layout.degree));
    for (std::size_t i = 0; i < used; ++i) {
      const double* rgb = &row_[slot::color + 3 * i];
      coefficients[i] = {rgb[0], rgb[1], rgb[2]};
      if (layout.full_channel > 0)
        coefficients[i] =
            (coefficients[i] / float(layout.full_channel) - 0.5f) / float(harmonics::y00);
    }
    std::array<float, NeuralDensities::parameters> values;  // Gaussians ignore them
    std::copy_n(&row_[slot::network], values.size(), values.begin());
    builder.add(splat, std::span(coefficients).first(used), values);
  }

  /// Coordinates with more digits than a float has, such as those of maps, keep them relative to a
  /// point near the first splat; otherwise the origin stays.
  glm::dvec3 origin_of(const PlyElement& vertex, const SplatPlyLayout& layout) const {
    constexpr double far = 1024;  // from there on, steps of a float are larger than 1e-4
    const bool is_exact =
        header_.encoding == PlyHeader::Encoding::ascii || has_doubles(vertex, layout);
    const glm::dvec3 first(row_[0], row_[1], row_[2]);
    static_assert(splat_slot::center == 0);
    const double largest = std::max({std::abs(first.x), std::abs(first.y), std::abs(first.z)});
    return is_exact && largest >= far && std::isfinite(largest) ? glm::round(first)
                                                                : glm::dvec3(0.0);
  }

  /// Z. Yu and others, "Mip-Splatting", arXiv 2311.16493, eq. 9: a Gaussian of this deviation
  /// widens the splat and lowers its peak, so that its integral stays.
  static void apply_filter(double filter, SplatValues& splat) {
    double ratio = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double wide = std::hypot(splat.scales[axis], filter);
      ratio *= splat.scales[axis] / wide;
      splat.scales[axis] = wide;
    }
    splat.opacity *= ratio;
  }

  bool has_doubles(const PlyElement& vertex, const SplatPlyLayout& layout) const {
    if (header_.encoding == PlyHeader::Encoding::ascii) return false;
    for (std::size_t i = 0; i < vertex.properties.size(); ++i)
      if (layout.slots[i] != splat_slot::none && layout.slots[i] < splat_slot::center + 3 &&
          vertex.properties[i].type == PlyType::float64)
        return true;
    return false;
  }

  Input& input_;
  const PlyHeader& header_;
  const ReadOptions& options_;
  PlyValues values_;
  SplatRow row_{};
};

}  // namespace

bool is_splat_ply(const PlyHeader& header) {
  for (const char* name : {"face", "tristrips"})
    if (const PlyElement* faces = header.find(name); faces && faces->count > 0) return false;
  const PlyElement* vertex = header.find("vertex");
  return vertex && vertex->find("scale_0") && vertex->find("rot_0");
}

Scene read_splat_ply(Input& input, const PlyHeader& header, const ReadOptions& options) {
  return SplatPlyReader(input, header, options).read();
}

}  // namespace tureen
