// Splat files and splats for tests.
#pragma once

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {

/// A PLY whose elements have scalar properties only, in any encoding.
class PlyFixture {
 public:
  using Columns = std::vector<std::string>;  // "float x"
  explicit PlyFixture(std::string encoding = "binary_little_endian")
      : encoding_(std::move(encoding)), head_("ply\nformat " + encoding_ + " 1.0\n") {}

  PlyFixture& comment(const std::string& text) {
    head_ += "comment " + text + "\n";
    return *this;
  }
  PlyFixture& element(const std::string& name, const Columns& columns,
                      const std::vector<std::vector<double>>& rows) {
    head_ += "element " + name + " " + std::to_string(rows.size()) + "\n";
    for (const std::string& column : columns) head_ += "property " + column + "\n";
    for (const std::vector<double>& row : rows) {
      for (std::size_t i = 0; i < row.size(); ++i) value(columns[i], row[i]);
      if (encoding_ == "ascii") body_ += "\n";
    }
    return *this;
  }
  std::string text() const { return head_ + "end_header\n" + body_; }

 private:
  void value(const std::string& column, double value) {
    if (encoding_ == "ascii") {
      char text[40];
      std::snprintf(text, sizeof text, "%.9g ", value);
      body_ += text;
    } else if (column.rfind("float", 0) == 0) {
      append(static_cast<float>(value));
    } else if (column.rfind("double", 0) == 0) {
      append(value);
    } else if (column.rfind("uchar", 0) == 0) {
      append(static_cast<std::uint8_t>(value));
    } else {
      append(static_cast<std::uint32_t>(value));
    }
  }
  template <class T>
  void append(T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (encoding_ == "binary_big_endian") std::reverse(bytes, bytes + sizeof value);
    body_.append(bytes, sizeof value);
  }

  std::string encoding_, head_, body_;
};

/// The columns of a 3DGS file; with two scales of a 2DGS file.
inline PlyFixture::Columns splat_columns(int rest, int scales) {
  PlyFixture::Columns columns;
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"})
    columns.push_back(std::string("float ") + name);
  const auto add = [&](const char* prefix, int count) {
    for (int i = 0; i < count; ++i) columns.push_back(prefix + std::to_string(i));
  };
  add("float f_rest_", rest);
  columns.push_back("float opacity");
  add("float scale_", scales);
  add("float rot_", 4);
  return columns;
}

/// The 104 columns of splattable neural primitives.
inline PlyFixture::Columns density_columns() {
  PlyFixture::Columns columns = splat_columns(45, 3);
  const auto opacity = std::find(columns.begin(), columns.end(), "float opacity");
  columns.insert(opacity + 1, "float opacity_volr");
  const auto add = [&](const char* prefix, int count) {
    for (int i = 0; i < count; ++i) columns.push_back(prefix + std::to_string(i));
  };
  add("float frequencies_", 24);
  add("float phases_", 8);
  add("float amplitudes_", 8);
  columns.push_back("float offsets");
  return columns;
}

inline glm::vec3 random_vector(Random& random) {
  return {float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), float(random.uniform(-1, 1))};
}

inline glm::quat random_rotation(Random& random) {
  const glm::dquat q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                     random.uniform(-1, 1));
  return glm::quat(glm::normalize(q));
}

inline SplatColor random_splat_color(Random& random, int degree, std::size_t count) {
  SplatColor color{degree};
  for (std::size_t i = 0; i < count * std::size_t(harmonics::count(degree)); ++i)
    color.coefficients.push_back(random_vector(random));
  return color;
}

inline Splats random_gaussians(unsigned seed, std::size_t count, const char* profile, int degree,
                               bool flat = false) {
  Random random(seed);
  Gaussians gaussians;
  gaussians.flat = flat;
  for (std::size_t i = 0; i < count; ++i) {
    gaussians.centers.push_back(random_vector(random));
    gaussians.scales.emplace_back(std::exp(random.uniform(-8, 2)), std::exp(random.uniform(-8, 2)),
                                  flat ? 0.0 : std::exp(random.uniform(-8, 2)));
    gaussians.rotations.push_back(random_rotation(random));
    gaussians.opacity.push_back(float(random.uniform(0, 1)));
  }
  return {gaussians, random_splat_color(random, degree, count), *profile_named(profile)};
}

inline Splats random_densities(unsigned seed, std::size_t count, int degree) {
  Random random(seed);
  NeuralDensities densities;
  for (std::size_t i = 0; i < count; ++i) {
    densities.centers.push_back(random_vector(random));
    densities.semi_axes.emplace_back(std::exp(random.uniform(-8, 2)),
                                     std::exp(random.uniform(-8, 2)),
                                     std::exp(random.uniform(-8, 2)));
    densities.rotations.push_back(random_rotation(random));
    for (std::size_t k = 0; k < NeuralDensities::parameters; ++k)
      densities.networks.push_back(float(random.uniform(-3, 3)));
  }
  return {densities, random_splat_color(random, degree, count), *profile_named("splatnet")};
}

inline const Splats& only_splats(const Scene& scene) {
  return std::get<Splats>(only_layer(scene).primitives);
}
inline const Gaussians& only_gaussians(const Scene& scene) {
  return std::get<Gaussians>(only_splats(scene).kernel);
}

}  // namespace tureen::test
