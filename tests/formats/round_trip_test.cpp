// Every pair of formats that can hold a scene: written as the first, read, written as the second,
// read, and compared with the original within the rounding of both.
#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>
#include <type_traits>

#include "formats/scene_file.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace round_trip_test {

using test::TemporaryFolder;

/// A format of splats, and its largest errors. The scene lies in the unit ball, has scales of 0.01
/// to 0.1, and coefficients of at most 0.7.
struct SplatFormat {
  const char* extension;
  int degree;      // the largest
  bool has_discs;  // and whether only discs
  bool only_discs;
  double center;      // in units of the scene
  double covariance;  // relative, of the matrix
  double color;       // of coefficients of degree 0
  double rest;        // of the others
  double opacity;
  bool has_mip = true;
};

/// The reasons, in the order of the columns: what a half step of the format is.
constexpr SplatFormat splat_formats[] = {
    // Bit for bit.
    {".glb", 4, true, false, 0, 1e-6, 0, 0, 0},
    // Logarithms and logits in single precision.
    {".ply", 4, true, false, 0, 1e-5, 0, 0, 1e-6},
    // 2 / 1023 / 2; 2 * 2.3 / 1023 / 2 of a logarithm and 1 / 1023 of an angle; 1.4 / 255 / 2;
    // 8 / 256 / 2; 1 / 255 / 2.
    {".compressed.ply", 3, true, false, 1e-3, 0.01, 3e-3, 0.016, 2e-3},
    // Exact; parts of quaternions of 1 / 127.5 / 2, four times the anisotropy of up to 10;
    // 1 / 255 / 2 / 0.282.
    {".splat", 0, false, false, 0, 0.05, 7e-3, 0, 2e-3, false},
    // 2^-16; 1 / 16 / 2 of a logarithm twice, as the covariance has squares; 1 / 255 / 2 / 0.15;
    // 16 / 128 / 2.
    {".spz", 4, false, false, 3e-5, 0.08, 0.014, 0.063, 2e-3},
    // 1.4 / 65,535 at a slope of 2; parts of quaternions of 1.4 / 255 / 2; a codebook of 256 for
    // 768
    // values; a codebook of 256 for all coefficients: 1.4 / 256 / 2, and less density at its ends.
    {".sog", 3, true, false, 5e-5, 0.05, 0.01, 0.01, 2e-3},
    // Bit for bit; the transform that turns up to y is baked into what is written next.
    {".usda", 4, true, false, 1e-6, 1e-5, 0, 1e-5, 0, false},
    {".usdz", 4, true, false, 1e-6, 1e-5, 0, 1e-5, 0, false},
    // Corners in single precision, of discs whose centre is the mean of two.
    {".npz", 0, true, true, 1e-6, 1e-4, 1e-6, 0, 0, false},
};

/// Neural densities, bit for bit but for the semi-axes of 0.1 to 1. `semi_axis`: relative.
struct NeuralFormat {
  const char* extension;
  float semi_axis;
};
constexpr NeuralFormat neural_formats[] = {
    {".glb", 0},
    // log(0.1) in single precision, and the rounding to float: (2.3 + 1) * 6e-8.
    {".ply", 2e-7f},
};

/// Several layers with their places.
constexpr const char* layered_formats[] = {".glb", ".usda", ".usdz"};

/// Triangles with a colour in bytes: exact in all of them. A DiffSoup export, a folder, has
/// textures instead (diffsoup_export_test.cpp).
constexpr const char* triangle_formats[] = {".glb", ".off", ".coff", ".ply", ".obj"};

glm::vec4 corner_color(const TriangleSoup& soup, std::size_t triangle, int corner) {
  if (const auto* faces = std::get_if<FaceColors>(&soup.appearance)) return faces->rgba[triangle];
  return std::get<VertexColors>(soup.appearance).rgba[soup.triangles[triangle][corner]];
}

/// 256 splats, for which a palette of SOG holds all harmonics.
Splats splats_of(int degree, bool flat) {
  std::mt19937_64 random(11);
  const auto between = [&](double low, double high) {
    return float(low + (high - low) * std::uniform_real_distribution<double>()(random));
  };
  Gaussians gaussians{.flat = flat};
  Splats splats;
  splats.color.degree = degree;
  for (int i = 0; i < 256; ++i) {
    gaussians.centers.emplace_back(between(-0.57, 0.57), between(-0.57, 0.57),
                                   between(-0.57, 0.57));
    gaussians.scales.emplace_back(std::exp(between(-4.6, -2.3)), std::exp(between(-4.6, -2.3)),
                                  flat ? 0 : std::exp(between(-4.6, -2.3)));
    gaussians.rotations.push_back(
        glm::normalize(glm::quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1))));
    gaussians.opacity.push_back(between(0.05, 0.95));
    for (int k = 0; k < harmonics::count(degree); ++k)
      splats.color.coefficients.emplace_back(between(-0.7, 0.7), between(-0.7, 0.7),
                                             between(-0.7, 0.7));
  }
  splats.kernel = std::move(gaussians);
  splats.profile = *profile_named(flat ? "2dgs" : "3dgs");
  return splats;
}

glm::dmat3 covariance(const Gaussians& gaussians, std::size_t i) {
  glm::dvec3 scales(gaussians.scales[i]);
  if (gaussians.flat) scales.z = 0;
  glm::dmat3 half = glm::mat3_cast(glm::dquat(gaussians.rotations[i]));
  for (int k = 0; k < 3; ++k) half[k] *= scales[k];
  return half * glm::transpose(half);
}

double size_of(const glm::dmat3& matrix) {
  return std::sqrt(glm::dot(matrix[0], matrix[0]) + glm::dot(matrix[1], matrix[1]) +
                   glm::dot(matrix[2], matrix[2]));
}

Scene stored_as(const Scene& scene, const TemporaryFolder& folder, const char* extension) {
  const auto path = folder / (std::string("scene") + extension);
  write_scene(scene, path);
  ReadOptions options;
  options.octagon_q = 4;
  return read_scene(path, options);
}

const Splats& splats_in(const Scene& scene, std::size_t layer = 0) {
  return std::get<Splats>(scene.layers.at(layer).primitives);
}

const Gaussians& gaussians_of(const Scene& scene) {
  return std::get<Gaussians>(splats_in(scene).kernel);
}

/// Expects each splat of `before` in `after`, within the sum of the errors of two formats.
void expect_within(const Splats& before, const Splats& after, const SplatFormat& a,
                   const SplatFormat& b) {
  const auto &expected = std::get<Gaussians>(before.kernel),
             &found = std::get<Gaussians>(after.kernel);
  ASSERT_EQ(found.centers.size(), expected.centers.size());
  EXPECT_EQ(found.flat, expected.flat && a.has_discs && b.has_discs);
  const int degree = std::min({before.color.degree, a.degree, b.degree});
  ASSERT_EQ(after.color.degree, degree);
  const std::size_t each = harmonics::count(degree),
                    each_before = harmonics::count(before.color.degree);
  double center = 0, relative = 0, color = 0, rest = 0, opacity = 0;
  for (std::size_t i = 0; i < expected.centers.size(); ++i) {
    std::size_t j = 0;
    for (std::size_t k = 1; k < found.centers.size(); ++k)
      if (glm::distance(found.centers[k], expected.centers[i]) <
          glm::distance(found.centers[j], expected.centers[i]))
        j = k;
    const glm::vec3 moved = glm::abs(found.centers[j] - expected.centers[i]);
    center = std::max({center, double(moved.x), double(moved.y), double(moved.z)});
    const glm::dmat3 shape = covariance(expected, i);
    relative = std::max(relative, size_of(covariance(found, j) - shape) / size_of(shape));
    opacity = std::max(opacity, std::abs(double(found.opacity[j]) - double(expected.opacity[i])));
    for (std::size_t k = 0; k < each; ++k) {
      const glm::vec3 off = glm::abs(after.color.coefficients[each * j + k] -
                                     before.color.coefficients[each_before * i + k]);
      double& worst = k == 0 ? color : rest;
      worst = std::max({worst, double(off.x), double(off.y), double(off.z)});
    }
  }
  EXPECT_LE(center, a.center + b.center + 1e-7);
  EXPECT_LE(relative, a.covariance + b.covariance);
  EXPECT_LE(color, a.color + b.color + 1e-6);
  EXPECT_LE(rest, a.rest + b.rest + 1e-6);
  EXPECT_LE(opacity, a.opacity + b.opacity + 1e-7);
}

TEST(RoundTrip, OfGaussiansThroughEveryPair) {
  const TemporaryFolder folder;
  for (const int degree : {0, 3, 4}) {
    const Splats splats = splats_of(degree, false);
    for (const SplatFormat& a : splat_formats) {
      if (a.only_discs) continue;
      const Scene first = stored_as(scene_of(splats), folder, a.extension);
      for (const SplatFormat& b : splat_formats) {
        if (b.only_discs) continue;
        SCOPED_TRACE(std::string(a.extension) + " to " + b.extension + ", degree " +
                     std::to_string(degree));
        expect_within(splats, splats_in(stored_as(first, folder, b.extension)), a, b);
      }
    }
  }
}

TEST(RoundTrip, OfDiscsThroughEveryPair) {
  const TemporaryFolder folder;
  const Splats splats = splats_of(1, true);
  for (const SplatFormat& a : splat_formats) {
    if (!a.has_discs) continue;
    const Scene first = stored_as(scene_of(splats), folder, a.extension);
    for (const SplatFormat& b : splat_formats) {
      SCOPED_TRACE(std::string(a.extension) + " to " + b.extension);
      const Scene second = stored_as(first, folder, b.extension);
      if (b.has_discs) {
        expect_within(splats, splats_in(second), a, b);
      } else {
        EXPECT_EQ(gaussians_of(second).centers.size(), splats.color.coefficients.size() / 4);
      }
    }
  }
}

TEST(RoundTrip, ProfilesStayWhereFormatsHoldThem) {
  const TemporaryFolder folder;
  Splats splats = splats_of(0, false);
  splats.profile = *profile_named("mip");
  for (const SplatFormat& format : splat_formats) {
    if (format.only_discs) continue;
    const Scene read = stored_as(scene_of(splats), folder, format.extension);
    EXPECT_EQ(std::get<Splats>(read.layers.at(0).primitives).profile.low_pass,
              format.has_mip ? SplatProfile::LowPass::mip : SplatProfile::LowPass::dilation)
        << format.extension;
  }
}

TEST(RoundTrip, OfSpzVersion3) {
  const TemporaryFolder folder;
  const Splats splats = splats_of(3, false);
  write_scene(scene_of(splats), folder / "a.spz", {.spz_version = 3});
  expect_within(splats, splats_in(read_scene(folder / "a.spz")), splat_formats[0],
                splat_formats[4]);
}

TEST(RoundTrip, OfNeuralDensitiesThroughEveryPair) {
  const TemporaryFolder folder;
  for (const int degree : {3, 4}) {
    Splats splats = test::RandomScene(7).neural_densities(40, degree);
    auto& before = std::get<NeuralDensities>(splats.kernel);
    before.omega = NeuralDensities{}.omega;  // PLY holds no other
    // In double, as readers do: only a length within 6e-8 of 1 keeps its bits.
    for (glm::quat& rotation : before.rotations)
      rotation = glm::quat(glm::normalize(glm::dquat(rotation)));
    for (const NeuralFormat& a : neural_formats)
      for (const NeuralFormat& b : neural_formats) {
        SCOPED_TRACE(std::string(a.extension) + " to " + b.extension + ", degree " +
                     std::to_string(degree));
        const Scene scene =
            stored_as(stored_as(scene_of(splats), folder, a.extension), folder, b.extension);
        const Splats& found = splats_in(scene);
        const auto& after = std::get<NeuralDensities>(found.kernel);
        ASSERT_EQ(after.centers.size(), before.centers.size());
        EXPECT_EQ(after.omega, before.omega);
        EXPECT_EQ(found.profile, splats.profile);
        ASSERT_EQ(found.color.degree, degree);
        for (std::size_t i = 0; i < before.centers.size(); ++i) {
          const auto place = std::ranges::find(after.centers, before.centers[i]);
          ASSERT_NE(place, after.centers.end()) << i;
          const auto j = std::size_t(place - after.centers.begin());
          EXPECT_EQ(after.rotations[j], before.rotations[i]);
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(after.semi_axes[j][k], before.semi_axes[i][k],
                        (a.semi_axis + b.semi_axis) * before.semi_axes[i][k]);
          const auto equal = [&](const auto& x, const auto& y, std::size_t each) {
            return std::equal(&x[each * i], &x[each * i] + each, &y[each * j]);
          };
          EXPECT_TRUE(equal(before.networks, after.networks, NeuralDensities::parameters)) << i;
          EXPECT_TRUE(
              equal(splats.color.coefficients, found.color.coefficients, harmonics::count(degree)))
              << i;
        }
      }
  }
}

TEST(RoundTrip, OfSeveralLayersThroughEveryPair) {
  const TemporaryFolder folder;
  Scene scene = scene_of(splats_of(4, false), {1e6 / 3, 2, 3});
  scene.layers.push_back(scene_of(splats_of(1, true)).layers[0]);
  scene.layers[0].name = "house";
  scene.layers[1].name = "fox";
  scene.layers[1].visible = false;
  scene.layers[1].world_from_layer = at_origin({5, 0, 0}) *
                                     glm::mat4_cast(glm::dquat(0.5, 0.5, -0.5, 0.5)) *
                                     glm::dmat4(glm::dmat3(0.25));
  scene.info.up = {0, 0, 1};  // USD turns others to y
  const auto format = [](const char* extension) {
    return *std::ranges::find_if(splat_formats, [&](const SplatFormat& each) {
      return std::string_view(each.extension) == extension;
    });
  };
  for (const char* a : layered_formats)
    for (const char* b : layered_formats) {
      SCOPED_TRACE(std::string(a) + " to " + b);
      const Scene found = stored_as(stored_as(scene, folder, a), folder, b);
      ASSERT_EQ(found.layers.size(), scene.layers.size());
      EXPECT_EQ(found.info.up, scene.info.up);
      for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        EXPECT_EQ(found.layers[i].name, scene.layers[i].name);
        EXPECT_EQ(found.layers[i].visible, scene.layers[i].visible);
        EXPECT_EQ(found.layers[i].world_from_layer, scene.layers[i].world_from_layer) << i;
        expect_within(splats_in(scene, i), splats_in(found, i), format(a), format(b));
      }
    }
}

TEST(RoundTrip, OfColouredTrianglesThroughEveryPair) {
  const TemporaryFolder folder;
  TriangleSoup soup;
  FaceColors colors;
  std::mt19937 random(3);
  for (std::uint32_t i = 0; i < 50; ++i) {
    for (int k = 0; k < 3; ++k)
      soup.positions.emplace_back(float(random() % 1000) / 7, float(random() % 1000) / 3, float(i));
    soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    colors.rgba.push_back(glm::vec4(random() % 256, random() % 256, random() % 256, 255) / 255.0f);
  }
  soup.appearance = colors;
  for (const char* a : triangle_formats)
    for (const char* b : triangle_formats) {
      SCOPED_TRACE(std::string(a) + " to " + b);
      const Scene scene = stored_as(stored_as(scene_of(soup), folder, a), folder, b);
      const TriangleSoup& found = only_soup(scene);
      ASSERT_EQ(found.triangles.size(), soup.triangles.size());
      for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
          EXPECT_EQ(found.positions[found.triangles[t][k]], soup.positions[3 * t + std::size_t(k)]);
          EXPECT_EQ(corner_color(found, t, k), colors.rgba[t]);
        }
    }
}

// A format that can be written is in a table of this test.
TEST(RoundTrip, KnowsEveryFormat) {
  for (const FormatInfo& format : known_formats())
    for (const std::string& extension : format.written_extensions) {
      const auto is_it = [&](const auto& entry) {
        if constexpr (std::is_same_v<decltype(entry), const SplatFormat&>)
          return extension == entry.extension;
        else
          return extension == entry;
      };
      EXPECT_TRUE(std::ranges::any_of(splat_formats, is_it) ||
                  std::ranges::any_of(triangle_formats, is_it))
          << extension;
    }
}

}  // namespace round_trip_test
}  // namespace tureen
