// Splats: primitives that are blended by opacity. A kernel gives a splat's alpha at a point of the
// image, its colour is one of spherical harmonics, and a profile holds the rules of the method that
// trained it.
//
// All values are after activation. Splats are blended in the order of their centres' view depth.
// Index i of the kernel is also splat i of the colour: never reorder one without the other.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/kernels/gaussians.hpp"
#include "scene/kernels/neural_densities.hpp"
#include "scene/kernels/triangle_windows.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

using SplatKernel = std::variant<TriangleWindows, Gaussians, NeuralDensities>;

/// Calls act(Column) for each array that the kernel can have, in the order of its file in kernels/.
template <MaybeConst<SplatKernel> Kernel>
void for_each_possible_column(Kernel& kernel, auto&& act) {
  std::visit([&](auto& each) { for_each_column(each, act); }, kernel);
}
/// The same for the arrays that it has.
template <MaybeConst<SplatKernel> Kernel>
void for_each_column(Kernel& kernel, auto&& act) {
  for_each_possible_column(kernel, [&](const auto& column) {
    if (!column.is_absent()) act(column);
  });
}

/// Colour max(0, 1/2 + sum_i Y_i(d) c_i), where d is the unit direction from the eye to the splat's
/// centre. It may exceed 1; only pixels are clamped.
struct SplatColor {
  int degree = 0;  // 0..4
  /// For each splat, or each corner of each splat: harmonics::count(degree) RGB coefficients.
  std::vector<glm::vec3> coefficients = {};
  /// Only triangle windows: each corner has a colour of its own, with d from the eye to the corner.
  /// In between, the colour is the mean of the corners' by the barycentrics in the image: affine
  /// there, not perspective (Triangle Splatting+, arXiv 2509.25122; MeshSplatting, 2512.06818). A
  /// corner behind the eye has no image, and weight 0.
  bool per_corner = false;
};

/// Coefficients a splat: harmonics::count(degree), or three times as many.
std::size_t coefficients_per_splat(const SplatColor& color);

/// The rules by which a method renders its splats. GLB files store them; tags of PLY files choose
/// them.
struct SplatProfile {
  /// Where the kernel of a Gaussian is measured.
  enum class Projection {
    ewa,    // in the image, by the affine approximation at the centre (EWA splatting)
    plane,  // on the plane of a disc, exactly
  };
  /// Widening of Gaussians below the size of a pixel.
  enum class LowPass {
    none,
    dilation,  // adds 0.3 px^2 to the variances in the image; 3DGS
    mip,       // the same, and opacity keeps its integral; Mip-Splatting
    screen,    // alpha is at least that of a Gaussian of variance 0.5 px^2 in the image; 2DGS
  };

  Projection projection = Projection::ewa;
  LowPass low_pass = LowPass::none;
  float max_alpha = 0.99f;          // larger values are clamped
  float min_alpha = 1.0f / 255.0f;  // smaller values are not blended
  /// A splat that would lower the transmittance of a pixel below this value ends the pixel and is
  /// not blended. 0: every splat is blended. Rasters ignore it; tiles and the oracle apply it.
  float stop_transmittance = 1e-4f;
  /// Splats whose centre has at most this view depth, in layer units, are not drawn: too near for
  /// the affine approximation of EWA, and the rule of 3DGS and of the methods built on its
  /// rasteriser (in_frustum() of their code). 0: the centre may be anywhere, even behind the eye.
  float min_center_depth = 0.0f;

  bool operator==(const SplatProfile&) const = default;
};

/// SplatProfile::min_center_depth of the published rasterisers.
inline constexpr float published_center_depth = 0.2f;
/// Variance in px^2 that LowPass::dilation and LowPass::mip add along both axes of the image.
inline constexpr double dilation_variance = 0.3;
/// EWA splatting moves the centre in its Jacobian into the image and this margin, a fraction of the
/// image's size at each side: 3DGS clamps at 1.3 times the half field of view.
inline constexpr double ewa_margin = 0.15;
/// Variance in px^2 of the Gaussian of LowPass::screen.
inline constexpr double screen_variance = 0.5;

/// A profile of a published method.
struct NamedProfile {
  std::string_view name;  // in files and options
  SplatProfile profile;
  /// kernel_name() of the splats that have this name rather than another one of an equal profile.
  std::string_view kernel = {};
};
/// "3dgs", "mip", "2dgs", "games", "redisplats", "triangle-splatting", "mesh-splatting",
/// "splatnet".
extern const std::span<const NamedProfile> named_profiles;
/// The profile of this name, or nullopt.
std::optional<SplatProfile> profile_named(std::string_view name);
/// The first name of this profile, or "custom".
std::string_view name_of(const SplatProfile& profile);

/// The name of a profile of splats with this kernel. Several methods have equal profiles; the
/// kernel decides.
std::string_view profile_name(const SplatKernel& kernel, const SplatProfile& profile);

struct Splats {
  SplatKernel kernel = {};
  SplatColor color = {};
  SplatProfile profile = {};
  /// The row of each splat in its file, from 0, if the reader was asked for it; otherwise empty.
  std::vector<std::uint32_t> rows = {};
};

/// Calls act(array, elements per splat) for all arrays.
void for_each_array(MaybeConst<Splats> auto& splats, auto&& act) {
  for_each_column(splats.kernel, [&](const auto& column) { act(column.values, column.per_splat); });
  act(splats.color.coefficients, coefficients_per_splat(splats.color));
  if (!splats.rows.empty()) act(splats.rows, std::size_t(1));
}

/// The reason why splats with this kernel cannot have this profile, or nullopt: a value outside its
/// range, or a rule that the kernel does not support. O(1).
std::optional<std::string> profile_defect(const SplatKernel& kernel, const SplatProfile& profile);

/// The opacities, or null for a kernel without.
const std::vector<float>* opacity_of(const SplatKernel& kernel);
/// Whether there are splats, but none with an opacity that reaches SplatProfile::min_alpha.
bool is_transparent(const Splats& splats);

/// The degree of the highest band with a coefficient other than 0.
int degree_in_use(const SplatColor& color);

/// Number of splats.
std::size_t count(const SplatKernel& kernel);
std::size_t count(const Splats& splats);

/// "triangle windows", "Gaussians", "flat Gaussians" or "neural densities".
const char* kernel_name(const SplatKernel& kernel);

std::string_view profile_name(const Splats& splats);

/// "90854 Gaussians, profile 3dgs, harmonics of degree 0"; with colours of corners, " per corner".
std::string describe(const Splats& splats);

/// The centre of splat `i` in double precision, in layer coordinates.
glm::dvec3 center(const Splats& splats, std::size_t i);

/// The box around every point at which a splat's alpha, without a low pass, reaches
/// SplatProfile::min_alpha; zeros without such points. Splats that are not finite are ignored.
Bounds bounds(const Splats& splats);
/// The same for the splats with these indices, drawn by `profile`.
Bounds bounds(const Splats& splats, std::span<const std::uint32_t> which,
              const SplatProfile& profile);

/// Bytes in the vectors.
std::size_t byte_size(const Splats& splats);
/// Bytes of one splat with this kernel and one colour of this degree.
std::size_t bytes_per_splat(const SplatKernel& kernel, int degree);

/// Sets the rows to 0, 1, ..: before a reader drops or reorders splats.
void number_rows(Splats& splats);

/// Whether the values of splat `i` are in their ranges, as defect() checks them.
bool is_valid(const Splats& splats, std::size_t i);

/// The reason why these splats cannot be drawn (a size that does not match, a value outside its
/// range or not finite, a profile_defect()), or nullopt. Readers return
/// splats without a defect, and all users rely on that. O(data).
std::optional<std::string> defect(const Splats& splats);

}  // namespace tureen
