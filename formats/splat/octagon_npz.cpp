#include "formats/splat/octagon_npz.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <string_view>
#include <utility>

#include "base/little_endian.hpp"
#include "formats/archive/npy_array.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr double default_octagon_q = 4;  // of generate_mesh.py
constexpr std::size_t octagon_corners = 8, octagon_faces = 6;

void require_shape(const NpyArray& array, std::size_t rows, std::size_t columns) {
  if (array.rows() != rows || array.columns() != columns)
    array.fail("has " + std::to_string(array.rows()) + " x " + std::to_string(array.columns()) +
               " numbers instead of " + std::to_string(rows) + " x " + std::to_string(columns));
}

void require_fans(const NpyArray& faces, std::size_t octagons) {
  require_shape(faces, octagon_faces * octagons, 3);
  if (faces.holds_floats()) faces.fail("holds floats instead of integers");
  for (std::size_t row = 0; row < faces.rows(); ++row) {
    const std::size_t first = row / octagon_faces * octagon_corners, k = row % octagon_faces + 1;
    const std::array<std::size_t, 3> fan{first, first + k, first + k + 1};
    for (std::size_t column = 0; column < 3; ++column)
      if (faces.at(row, column) != double(fan[column]))
        faces.fail("row " + std::to_string(row) +
                   " is no face of an octagon: the corners of octagon i are the vertices 8 i to "
                   "8 i + 7, and its faces a fan");
  }
}

glm::dvec3 corner(const NpyArray& vertices, std::size_t row) {
  return {vertices.at(row, 0), vertices.at(row, 1), vertices.at(row, 2)};
}

/// The disc whose circle of radius `rho` standard deviations has the corners 0, 2 and 6. Without an
/// area it gets the quaternion 0, for which SplatBuilder drops it.
SplatValues disc_of(const glm::dvec3& p0, const glm::dvec3& p2, const glm::dvec3& p6, double rho) {
  SplatValues splat;
  splat.center = 0.5 * (p2 + p6);
  const glm::dvec3 a = (p0 - splat.center) / rho, b = (p2 - splat.center) / rho;
  // The longest point of a cos(t) + b sin(t), as in Jacobi's method for singular values. The other
  // axis follows from the area, |a x b|, and the normal, both of which keep their accuracy for thin
  // discs.
  const double t = 0.5 * std::atan2(2 * glm::dot(a, b), glm::dot(a, a) - glm::dot(b, b));
  const glm::dvec3 longest = std::cos(t) * a + std::sin(t) * b, normal = glm::cross(a, b);
  const double length = glm::length(longest), area = glm::length(normal);
  splat.scales = {length, area / length, 0};
  // The rounding of the cross product is about 1e-16 |a| |b|.
  if (!(area > 1e-12 * glm::length(a) * glm::length(b))) {
    splat.scales = glm::dvec3(0);
    splat.rotation = glm::dquat(0, 0, 0, 0);
    return splat;
  }
  const glm::dvec3 x = longest / length, z = normal / area;
  splat.rotation = glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
  return splat;
}

}  // namespace

bool is_octagon_npz(std::span<const std::byte> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (head.size() < 30 || text.substr(0, 4) != "PK\3\4") return false;
  const std::string_view first = text.substr(30, std::size_t(little_number(head, 26, 2)));
  return first.size() >= 4 && first.substr(first.size() - 4) == ".npy";
}

Scene read_octagon_npz(Input input, const ReadOptions& options) {
  const double q = options.octagon_q.value_or(default_octagon_q);
  assert(q > 0);
  ZipArchive archive(std::move(input));
  const NpyArray vertices(archive, "vertices");
  const std::size_t octagons = vertices.rows() / octagon_corners;
  require_shape(vertices, octagons * octagon_corners, 3);
  {
    const PassingMemory passing(archive.budget());
    require_fans(NpyArray(archive, "faces"), octagons);
  }
  const NpyArray colors(archive, "vertex_colors");
  require_shape(colors, vertices.rows(), 4);
  if (!colors.holds_floats()) colors.fail("holds integers instead of floats from 0 to 1");

  SplatBuilder builder(archive.input(), options, Gaussians{.flat = true}, 0, octagons);
  ProgressMeter meter(options);
  for (std::size_t i = 0; i < octagons; ++i) {
    meter.step([&] { return double(i) / double(octagons); });
    const std::size_t first = i * octagon_corners;
    for (std::size_t row = first + 1; row < first + octagon_corners; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        // Not !=, by which NaN would differ from itself; SplatBuilder drops NaN.
        if (colors.at(row, column) < colors.at(first, column) ||
            colors.at(row, column) > colors.at(first, column))
          colors.fail("changes within octagon " + std::to_string(i) + ": rows " +
                      std::to_string(first) + " and " + std::to_string(row));
    SplatValues splat = disc_of(corner(vertices, first), corner(vertices, first + 2),
                                corner(vertices, first + 6), std::sqrt(q));
    glm::vec3 coefficient;
    for (int c = 0; c < 3; ++c)
      coefficient[c] = float((colors.at(first, std::size_t(c)) - 0.5) / harmonics::y00);
    splat.opacity = colors.at(first, 3);
    builder.add(splat, std::span(&coefficient, 1));
  }
  Scene scene = builder.finish(*profile_named("redisplats"), "octagon mesh");
  if (!options.octagon_q) scene.info.remarks.push_back({&remarks::octagon_q_assumed, {{"q", q}}});
  return scene;
}

Scene read_octagon_npz(const std::filesystem::path& path, const ReadOptions& options) {
  return read_octagon_npz(Input::open(path), options);
}

}  // namespace tureen
