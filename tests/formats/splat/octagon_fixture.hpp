// Octagon meshes of REdiSplats in .npz archives, byte by byte.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/formats/torch_fixture.hpp"

namespace tureen::test {

inline std::string npy(const std::string& header, const std::string& data, unsigned version = 1) {
  std::string out = "\x93NUMPY";
  append_little(out, version, 1);
  append_little(out, 0, 1);
  append_little(out, header.size(), version == 1 ? 2 : 4);
  return out + header + data;
}

/// The header that numpy writes, without its blanks.
inline std::string npy_header(const std::string& type, std::size_t rows, std::size_t columns) {
  return "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(rows) +
         ", " + std::to_string(columns) + "), }\n";
}

template <class T, class Values>
std::string raw_values(const Values& values) {
  std::string out;
  for (const auto& value : values) {
    const T converted = static_cast<T>(value);
    out.append(reinterpret_cast<const char*>(&converted), sizeof converted);
  }
  return out;
}

struct OctagonFixture {
  std::vector<double> vertices, colors;  // rows of 3 and of 4
  std::vector<std::int64_t> faces;       // rows of 3

  /// The octagon of a disc whose axes, times the standard deviations, are x and y.
  OctagonFixture& add(const glm::dvec3& center, const glm::dvec3& x, const glm::dvec3& y,
                      const glm::dvec4& color, double q = 4) {
    const auto first = std::int64_t(vertices.size() / 3);
    for (int k = 0; k < 8; ++k) {
      const double angle = k * std::numbers::pi / 4;
      const glm::dvec3 corner = center + std::sqrt(q) * (std::cos(angle) * x + std::sin(angle) * y);
      for (int i = 0; i < 3; ++i) vertices.push_back(corner[i]);
      for (int i = 0; i < 4; ++i) colors.push_back(color[i]);
    }
    for (int k = 1; k < 7; ++k) faces.insert(faces.end(), {first, first + k, first + k + 1});
    return *this;
  }

  /// The entries as numpy.savez writes them for the authors' program.
  ZipFixture zip() const {
    ZipFixture zip;
    const auto entry = [&](const char* name, const char* type, std::size_t columns,
                           std::size_t count, const std::string& data) {
      zip.entries.push_back(
          {std::string(name) + ".npy", npy(npy_header(type, count / columns, columns), data)});
    };
    entry("vertices", "<f8", 3, vertices.size(), raw_values<double>(vertices));
    entry("faces", "<i8", 3, faces.size(), raw_values<std::int64_t>(faces));
    entry("vertex_colors", "<f4", 4, colors.size(), raw_values<float>(colors));
    return zip;
  }
  std::string bytes() const { return zip().bytes(); }
};

inline OctagonFixture two_octagons() {
  return OctagonFixture()
      .add({1, 2, 3}, {0.5, 0, 0}, {0, 0.25, 0}, {1, 0, 0.5, 0.75})
      .add({-1, 0, 2}, {0, 0.3, 0.4}, {0.1, 0, 0}, {0.2, 0.4, 0.6, 1});
}

}  // namespace tureen::test
