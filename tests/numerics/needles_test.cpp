// Needles: their normals (G1b), and their texels when drawn (T1b). At a pixel's centre,
// interpolated barycentrics can lie outside a needle by many times its width: where the covered
// samples lie beside the centre, or where its corners are rounded to the subpixel grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "oracle/hits.hpp"
#include "oracle/shade.hpp"
#include "runtime/renderer.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/shader_probe.hpp"

namespace tureen::test {
namespace needles_test {

constexpr int side = 192;
constexpr double low = 0.4, high = 0.6;  // of all features

/// Shows sigmoid(4 (f - 1/2)) of each of the first three features. The colour has the feature's
/// slope at 1/2, and a smaller slope elsewhere.
ColorMlp one_channel_each() {
  ColorMlp mlp;
  mlp.encoding = DirectionEncoding::none;
  mlp.layers = {
      {.inputs = 3, .outputs = 3, .weights = {4, 0, 0, 0, 4, 0, 0, 0, 4}, .biases = {-2, -2, -2}}};
  return mlp;
}

double shown(double feature) { return 1 / (1 + std::exp(-4 * (feature - 0.5))); }

/// A large triangle, face 0, in front of needles with this width in pixels. Along every face,
/// features go from one end of their range to the other. Every second needle is partly transparent.
TriangleSoup soup_of_needles(double width) {
  Random random(1);
  std::vector<glm::vec3> corners;
  const auto at_pixel = [](const glm::dvec2& p, double depth) {
    return glm::vec3(glm::dvec3((p.x - side / 2.0) / side, (side / 2.0 - p.y) / side, -1) * depth);
  };
  for (const glm::dvec2& p : {glm::dvec2(4.2, 4.1), {60.7, 9.4}, {12.3, 70.6}})
    corners.push_back(at_pixel(p, 0.5));
  constexpr int needles = 2000;
  for (int i = 0; i < needles; ++i) {
    const glm::dvec2 tip(random.uniform(0, side), random.uniform(0, side));
    const double angle = random.uniform(0, 2 * M_PI), length = random.uniform(60, 120);
    const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
    const glm::dvec2 end = tip + length * along;
    std::array<glm::vec3, 3> needle;
    const double depth = 1 + 0.001 * i;  // one behind the other
    needle[0] = at_pixel(tip, depth);
    needle[1] = at_pixel(end - width / 2 * across, depth);
    needle[2] = at_pixel(end + width / 2 * across, depth);
    std::rotate(needle.begin(), needle.begin() + i % 3, needle.end());
    corners.insert(corners.end(), needle.begin(), needle.end());
  }
  TriangleSoup soup = soup_of(corners);
  LatticeTexture texture;
  std::vector<float> texels;
  for (std::uint32_t face = 0; face <= needles; ++face) {
    texture.patches.push_back({3 * face, 0});
    for (std::uint32_t texel = 0; texel < 3; ++texel)
      for (int c = 0; c < LatticeTexture::channels; ++c) {
        const bool up = (face + texel + std::uint32_t(c)) % 3 == 0;
        texels.push_back(c < LatticeTexture::features ? float(up ? high : low)
                         : face % 2 == 1 && up        ? 0.2f
                                                      : 0.9f);
      }
  }
  texture.texels = std::move(texels);
  texture.mlp = one_channel_each();
  soup.appearance = std::move(texture);
  return soup;
}

/// The expected face and colour of each pixel, as documented in visibility.frag: at the point of
/// the face that simplex.glsl computes from the interpolated values.
struct Expected {
  std::vector<std::uint32_t> faces;
  std::vector<glm::dvec3> colors;
};

Expected expected_of(const TriangleSoup& soup, const Camera& camera) {
  Expected result{snapped_oracle(soup, glm::dvec3(0), camera).face,
                  std::vector<glm::dvec3>(std::size_t(side) * side)};
  const oracle::Rays rays(soup, glm::dmat4(1.0), camera, {.coverage = oracle::Coverage::snapped});
  rays.visit_faces(0, side, [&](int x, int y, const oracle::Hit& hit) {
    const std::size_t i = std::size_t(y) * side + std::size_t(x);
    if (hit.face != result.faces[i]) return;
    const double b0 = std::max(hit.b0, 0.0), b1 = std::max(hit.b1, 0.0);
    const double sum = std::max(b0 + b1, 1.0);
    result.colors[i] = oracle::color(soup, {.face = hit.face, .b0 = b0 / sum, .b1 = b1 / sum},
                                     {0, 0, 1}, glm::dvec3(0));
  });
  return result;
}

/// Distance of a channel outside the range that all points of all faces show.
double beyond_all_texels(double channel) {
  return std::isfinite(channel) ? std::max({0.0, shown(low) - channel, channel - shown(high)})
                                : std::numeric_limits<double>::infinity();
}

/// The same at the centres of the pixels that faces cover, without clamping.
double beyond_without_clamp(const TriangleSoup& soup, const Camera& camera) {
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  double most = 0;
  const oracle::Rays rays(soup, glm::dmat4(1.0), camera, {.coverage = oracle::Coverage::snapped});
  rays.visit_faces(0, camera.height, [&](int column, int row, const oracle::Hit& hit) {
    // A face has a constant depth, so barycentrics are affine in pixels.
    const auto pixel = [&](std::size_t k) {
      const glm::dvec3 p(soup.positions[3 * std::size_t(hit.face) + k]);
      return glm::dvec2(camera.cx - camera.fx * p.x / p.z, camera.cy + camera.fy * p.y / p.z);
    };
    const glm::dvec2 c = pixel(2), a = pixel(0) - c, b = pixel(1) - c;
    const glm::dvec2 center = glm::dvec2(column, row) + 0.5 - c;
    const double area = a.x * b.y - a.y * b.x;
    const double b0 = (center.x * b.y - center.y * b.x) / area;
    const double b1 = (a.x * center.y - a.y * center.x) / area;
    const std::size_t first = 3 * std::size_t(hit.face);
    const double feature = b0 * double(texture.value(first, 0)) +
                           b1 * double(texture.value(first + 1, 0)) +
                           (1 - b0 - b1) * double(texture.value(first + 2, 0));
    most = worse(most, beyond_all_texels(shown(feature)));
  });
  return most;
}

TEST(Numerics, T1b_NeedlesShowNothingBeyondTheirTexels) {
  struct Path {
    std::string what;
    ShadingSite site;
  };
  const std::vector<Path> paths = {{"forward.frag", ShadingSite::forward},
                                   {"visibility.frag", ShadingSite::deferred}};
  const Camera camera = straight_camera(side, side, side);
  for (const Path& path : paths) {
    Recorder recorder({.stressed = "needles whose barycentrics are extrapolated: " + path.what,
                       .parameter = "width of the needles / pixels",
                       .unit = "distance of a channel outside the range of all texels",
                       .naive = "sampling at the interpolated point, without clamping"});
    for (const double width : {1e-3, 1e-2, 0.1, 1.0}) {
      const TriangleSoup soup = soup_of_needles(width);
      const Expected expected = expected_of(soup, camera);
      const std::vector<std::uint32_t> faces = faces_of_device(soup, camera);
      double ours = 0;
      for (const bool specialise : {true, false}) {
        // Grey is within the range, so a pixel that a needle partly covers may show it.
        const RenderOptions options{.plan = {.specialise = specialise, .site = path.site},
                                    .background = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f),
                                    .limits = {}};
        shared_context().make_current();
        Renderer renderer = renderer_of(shared_context(), soup, glm::dvec3(0), options);
        renderer.draw({camera});
        const Image8 image = renderer.read_color();
        int by_needles = 0, compared = 0;
        double off = 0;
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x) {
            const glm::u8vec4 pixel = image.at(x, y);
            for (int c = 0; c < 3; ++c) ours = worse(ours, beyond_all_texels(pixel[c] / 255.0));
            // Count pixels right of the large face that are not grey.
            by_needles += x > 75 && std::abs(pixel.r - 127.5) > 2;
            const std::size_t i = std::size_t(y) * side + std::size_t(x);
            const std::uint32_t face = expected.faces[i];
            if (face == no_face || face != faces[i]) continue;
            compared += face != 0;
            for (int c = 0; c < 3; ++c)
              off = worse(off, std::abs(pixel[c] / 255.0 - expected.colors[i][c]));
          }
        EXPECT_GT(by_needles, 20) << path.what << ' ' << width;
        EXPECT_GT(compared, 20);
        // Half a step of 8 bits; two barycentrics of 16 bits in the visibility buffer; and, at the
        // far side of the image, the rounding of two barycentrics' planes, whose slope is 1 /
        // width.
        const double tolerance = 0.5 / 255 + (high - low) * (0x1p-16 + 2 * side / width * epsilon);
        EXPECT_LE(off, tolerance) << path.what << ' ' << width;
      }
      // Half a step of 8 bits, and the same again for the rounding of weights.
      recorder.add({.at = width,
                    .naive = beyond_without_clamp(soup, camera),
                    .ours = ours,
                    .tolerance = 1.0 / 255});
    }
  }
}

TEST(Numerics, G1b_NeedlesHaveANormal) {
  Recorder recorder({.stressed = "the normal of needles whose edges have a product of 0 in floats, "
                                 "but not exactly: face_corners.glsl",
                     .parameter = "the edges' slope",
                     .unit = "the length's difference from 1",
                     .naive = "the product divided by its length",
                     .naive_fails_from = 0.1});
  const Probe probe(shared_context().capabilities().api,
                    "#include \"face_corners.glsl\"\n"
                    "vec4 probe(vec4 x) { return vec4(unit_normal(vec3(1.0, x.x, 0.0), "
                    "vec3(x.y, x.z, 0.0)), 0.0); }",
                    {{"TEXEL_ROW_BITS", "4"}, {"TEXEL_LAYER_BITS", "4"}});
  Random random(12);
  for (const float slope : {0.1f, 0.3f, 0.7f, 0.9f}) {
    std::vector<glm::vec4> needles;
    double naive = std::numeric_limits<double>::infinity();
    while (needles.size() < 100) {
      const auto along = float(random.uniform(0.3, 0.9));
      const float across = slope * along;
      if (double(across) == double(slope) * double(along)) continue;  // the exact area is 0, too
      needles.emplace_back(slope, along, across, 0);
      const double length =
          glm::length(glm::normalize(glm::cross(glm::vec3(1, slope, 0), {along, across, 0})));
      naive = std::min(naive, worse(std::abs(length - 1), 0));
    }
    double ours = 0;
    for (const glm::vec4& normal : probe.run(needles))
      ours = worse(ours, std::abs(glm::length(glm::dvec3(normal)) - 1));
    // As in V1c, on a device that computes a non-zero product by rounding one of two terms.
    recorder.add({.at = slope, .naive = naive, .ours = ours, .tolerance = (3 * 0.5 + 3) * epsilon});
  }
}

}  // namespace needles_test
}  // namespace tureen::test
