#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "base/error.hpp"
#include "base/output.hpp"
#include "formats/archive/zip_writer.hpp"
#include "formats/splat/octagon_npz.hpp"
#include "formats/splat/splat_writing.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr std::size_t written_corners = 8, written_faces = 6;
/// The square of the corners' distance in standard deviations: the Q that readers assume.
constexpr double written_q = 4;

/// The bytes of an .npy file, version 1.0: rows of `columns` values of the type `descr`.
template <class Value>
std::vector<std::byte> npy_of(const std::vector<Value>& values, const char* descr,
                              std::size_t columns) {
  std::string head = std::string("{'descr': '") + descr + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(values.size() / columns) + ", " + std::to_string(columns) +
                     "), }";
  // The data begin at a multiple of 64 bytes, after a line feed.
  head.resize((10 + head.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  head += '\n';
  std::string text =
      std::string("\x93NUMPY\x01\0", 8) + char(head.size() & 255) + char(head.size() >> 8) + head;
  std::vector<std::byte> bytes(text.size() + values.size() * sizeof(Value));
  std::memcpy(bytes.data(), text.data(), text.size());
  std::memcpy(bytes.data() + text.size(), values.data(), values.size() * sizeof(Value));
  return bytes;
}

}  // namespace

std::vector<std::string> write_octagon_npz(const Scene& scene, const std::filesystem::path& path) {
  StoredGaussians stored = gaussians_for(
      scene,
      {.name = "octagon mesh", .max_degree = 0, .has_flat = true, .flat_profile = "redisplats"});
  const Gaussians& discs = stored.gaussians();
  if (!discs.flat)
    throw UsageError("an octagon mesh holds only discs, and this scene has ellipsoids",
                     "write .ply or .glb");
  std::vector<float> vertices, colors;
  std::vector<std::int32_t> faces;
  std::uint64_t clipped = 0;
  for (std::size_t i = 0; i < discs.centers.size(); ++i) {
    const glm::dmat3 axes = glm::mat3_cast(glm::dquat(discs.rotations[i]));
    const glm::dvec3 x = axes[0] * double(discs.scales[i].x) * std::sqrt(written_q),
                     y = axes[1] * double(discs.scales[i].y) * std::sqrt(written_q);
    std::array<float, 4> rgba;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value =
          0.5 + harmonics::y00 * double(stored.splats.color.coefficients[i][int(c)]);
      if (value < 0 || value > 1) ++clipped;
      rgba[c] = float(std::clamp(value, 0.0, 1.0));
    }
    rgba[3] = discs.opacity[i];
    for (std::size_t k = 0; k < written_corners; ++k) {
      const double angle = double(k) * std::numbers::pi / 4;
      const glm::vec3 corner(glm::dvec3(discs.centers[i]) + std::cos(angle) * x +
                             std::sin(angle) * y);
      vertices.insert(vertices.end(), {corner.x, corner.y, corner.z});
      colors.insert(colors.end(), rgba.begin(), rgba.end());
    }
    const auto first = std::int32_t(written_corners * i);
    for (std::int32_t k = 1; k <= std::int32_t(written_faces); ++k)
      faces.insert(faces.end(), {first, first + k, first + k + 1});
  }
  Output output(path);
  ZipWriter zip(output);
  zip.add("vertices.npy", npy_of(vertices, "<f4", 3));
  zip.add("faces.npy", npy_of(faces, "<i4", 3));
  zip.add("vertex_colors.npy", npy_of(colors, "<f4", 4));
  zip.finish();
  output.commit();
  if (clipped > 0)
    stored.lost.push_back(std::to_string(clipped) + " colours are outside 0 to 1: clipped.");
  return stored.lost;
}

}  // namespace tureen
