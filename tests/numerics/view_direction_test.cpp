// View directions: cases V1 to V5.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <string>
#include <vector>

#include "oracle/hits.hpp"
#include "oracle/shade.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/texel_store.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/shader_probe.hpp"

namespace tureen::test {
namespace view_direction_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Radians; infinite where either is not a direction.
double angle(const glm::dvec3& a, const glm::dvec3& b) {
  const double result = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  return glm::length(a) > 0 && std::isfinite(result) ? result : infinity;
}

// -- V1 -----------------------------------------------------------------------------------------

/// The direction to the eye from a pixel's points on the near and the far plane, in floats.
glm::dvec3 unprojected(const Camera& camera, double near, double far, const glm::vec2& window) {
  const glm::mat4 clip(clip_from_view(camera, near, far) * camera.view_from_world);
  const glm::mat4 world = glm::inverse(clip);
  const glm::vec2 ndc(2 * window.x / float(camera.width) - 1,
                      2 * window.y / float(camera.height) - 1);
  const glm::vec4 front = world * glm::vec4(ndc, -1, 1), back = world * glm::vec4(ndc, 1, 1);
  return glm::dvec3(glm::normalize(glm::vec3(front) / front.w - glm::vec3(back) / back.w));
}

/// The corners of the image, and random pixels.
std::vector<glm::vec4> window_positions(const Camera& camera) {
  Random random(1);
  std::vector<glm::vec4> windows;
  for (const double x : {0.5, camera.width - 0.5})
    for (const double y : {0.5, camera.height - 0.5}) windows.emplace_back(x, y, 0, 0);
  while (windows.size() < 500)
    windows.emplace_back(random.below(std::uint32_t(camera.width)) + 0.5,
                         random.below(std::uint32_t(camera.height)) + 0.5, 0, 0);
  return windows;
}

/// The results of a function in view_direction.glsl at these positions.
std::vector<glm::vec4> of_shader(const char* function, const Camera& camera,
                                 const std::vector<glm::vec4>& windows) {
  const Probe probe(shared_context().capabilities().api,
                    "#include \"view_direction.glsl\"\n"
                    "vec4 probe(vec4 x) { return vec4(" +
                        std::string(function) + "(x.xy), 0.0); }",
                    {});
  set_rays(probe.program(), camera);
  return probe.run(windows);
}

/// Bound of the rotation of direction_to_eye() by float rounding, in radians. Each step's rounding
/// is relative to its result, per coordinate. For the cameras of V1 below, this is within the 5e-7
/// from the literature for the form with the camera's axes.
double max_angle(const Camera& camera, const glm::dvec2& window) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 column = axes[0] / camera.fx, row = axes[1] / camera.fy,
                   corner = -axes[2] - camera.cx * column - (camera.height - camera.cy) * row,
                   ray = corner + window.x * column + window.y * row;
  const double uniforms = glm::length(corner) + glm::length(window.x * column) +
                          glm::length(window.y * row),
               products = glm::length(window.x * column) + glm::length(window.y * row),
               sums = glm::length(corner + window.x * column) + glm::length(ray);
  // Plus the rounding of products in normalize(). An error of the length does not rotate.
  return epsilon * ((uniforms + products + sums) / glm::length(ray) + 1);
}

struct DirectionErrors {
  double ours = 0, naive = 0, tolerance = 0;
};

DirectionErrors direction_errors(const Camera& camera, double near, double far) {
  const std::vector<glm::vec4> windows = window_positions(camera),
                               results = of_shader("direction_to_eye", camera, windows);
  const TriangleSoup nothing = soup_of({});
  const oracle::Rays rays(nothing, glm::dmat4(1.0), camera);
  DirectionErrors errors;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const glm::dvec3 truth = rays.to_eye(int(windows[i].x), camera.height - 1 - int(windows[i].y));
    errors.ours = worse(errors.ours, angle(results[i], truth));
    errors.naive = worse(errors.naive, angle(unprojected(camera, near, far, windows[i]), truth));
    errors.tolerance = std::max(errors.tolerance, max_angle(camera, glm::vec2(windows[i])));
  }
  return errors;
}

/// far / near above which (f + n) / (f - n) is 1 in floats. The far plane then has a w of 0, and
/// the naive method gives no finite number. Below, it is only worse than ours.
constexpr double cliff = 0x1p25;

TEST(Numerics, V1_DirectionsDoNotDependOnTheDepthRange) {
  Recorder recorder({.stressed = "view directions, by the range of depths: view_direction.glsl",
                     .parameter = "far / near",
                     .unit = "radians",
                     .naive = "far point minus near point, by the inverse of the matrix in floats",
                     .naive_fails_from = cliff});
  const Camera camera = look_at({1, 2, 0.5}, {0, 0, 0}, {0, 0, 1}, 0.9, 1280, 720);
  struct Planes {
    double near, far;
  };
  for (const auto& [near, far] :
       {Planes{4, 100}, Planes{0.5, 100}, Planes{0.1, 100}, Planes{0.01, 100}, Planes{0.01, 1e3},
        Planes{0.1, 1e5}, Planes{0.01, 1e5}, Planes{0.01, 1e6}, Planes{1e-3, 1e6}}) {
    const DirectionErrors errors = direction_errors(camera, near, far);
    EXPECT_EQ(std::isinf(errors.naive), far / near > cliff) << far / near;
    recorder.add({.at = far / near,
                  .naive = errors.naive,
                  .ours = errors.ours,
                  .tolerance = errors.tolerance});
  }
}

TEST(Numerics, V1b_DirectionsDoNotDependOnThePlace) {
  Recorder recorder({.stressed = "view directions, by the place of the eye, near 0.5 and far 100: "
                                 "view_direction.glsl",
                     .parameter = "eye's distance from the origin / near",
                     .unit = "radians",
                     .naive = "far point minus near point, by the inverse of the matrix in floats",
                     .naive_fails_from = 20});
  for (int exponent = 0; exponent <= 6; ++exponent) {
    const glm::dvec3 place = std::pow(10.0, exponent) * glm::normalize(glm::dvec3(1, -2, 0.7));
    const Camera camera =
        look_at(place, place + glm::dvec3(-1, 0.3, 0.2), {0, 0, 1}, 0.9, 1280, 720);
    const DirectionErrors errors = direction_errors(camera, 0.5, 100);
    recorder.add({.at = glm::length(place) / 0.5,
                  .naive = errors.naive,
                  .ours = errors.ours,
                  .tolerance = errors.tolerance});
  }
}

TEST(Numerics, V1d_DirectionsKnowThePrincipalPoint) {
  Recorder recorder({.stressed = "view directions, by the principal point, within the image and "
                                 "outside: view_direction.glsl",
                     .parameter = "its distance from the middle / widths",
                     .unit = "radians",
                     .naive = "the principal point taken to be the image's middle",
                     .naive_fails_from = 0.1});
  for (const double widths : {0.0, 0.1, 0.6, 1.0, 3.0, 10.0}) {
    Camera camera = look_at({1, 2, 0.5}, {0, 0, 0}, {0, 0, 1}, 0.9, 1280, 720);
    const Camera centerd = camera;
    camera.cx += widths * camera.width;
    camera.cy -= widths * camera.height;
    const DirectionErrors errors = direction_errors(camera, 0.5, 100);
    const std::vector<glm::vec4> windows = window_positions(camera),
                                 taken = of_shader("direction_to_eye", centerd, windows);
    const TriangleSoup nothing = soup_of({});
    const oracle::Rays rays(nothing, glm::dmat4(1.0), camera);
    double naive = 0;
    for (std::size_t i = 0; i < windows.size(); ++i)
      naive = worse(naive, angle(taken[i], rays.to_eye(int(windows[i].x),
                                                       camera.height - 1 - int(windows[i].y))));
    recorder.add(
        {.at = widths, .naive = naive, .ours = errors.ours, .tolerance = errors.tolerance});
  }
}

// An angle does not include the length; an error of it changes networks and harmonics as much.
TEST(Numerics, V1c_DirectionsHaveALengthOfOne) {
  Recorder recorder({.stressed = "the length of view directions: view_direction.glsl",
                     .parameter = "vertical field of view / degrees",
                     .unit = "difference from 1",
                     .naive = "the ray at a depth of 1, not normalised"});
  for (const double degrees : {1.0, 20.0, 60.0, 100.0, 140.0, 170.0}) {
    const Camera camera =
        look_at({1, 2, 0.5}, {0, 0, 0}, {0, 0, 1}, glm::radians(degrees), 1280, 720);
    const std::vector<glm::vec4> windows = window_positions(camera),
                                 rays = of_shader("ray_through", camera, windows),
                                 results = of_shader("direction_to_eye", camera, windows);
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      ours = worse(ours, std::abs(glm::length(glm::dvec3(results[i])) - 1));
      naive = worse(naive, std::abs(glm::length(glm::dvec3(rays[i])) - 1));
    }
    // Three roundings of the sum of squares, halved by the root; one of the root, one of its
    // inverse, one of the product with a coordinate.
    recorder.add(
        {.at = degrees, .naive = naive, .ours = ours, .tolerance = (3 * 0.5 + 3) * epsilon});
  }
}

// -- V2 -----------------------------------------------------------------------------------------

TEST(Numerics, V2_UpIsUpForTheNetwork) {
  Recorder recorder({.stressed = "the direction that the network gets, from its colour: device",
                     .parameter = "vertical field of view / degrees",
                     .unit = "length of the difference from the true unit direction",
                     .naive = "rows counted from the wrong end"});
  // A network of one layer that shows sigmoid(gain d).
  constexpr float gain = 1.5f;
  ColorMlp network;
  network.encoding = DirectionEncoding::xyz;
  network.layers = {{.inputs = 3,
                     .outputs = 3,
                     .weights = {gain, 0, 0, 0, gain, 0, 0, 0, gain},
                     .biases = {0, 0, 0}}};
  constexpr int side = 64;
  for (const double degrees : {20.0, 60.0, 100.0, 140.0}) {
    TriangleSoup soup = soup_of({{-1e3f, -1e3f, -5}, {1e3f, -1e3f, -5}, {0, 2e3f, -5}});
    LatticeTexture texture;
    texture.patches = {{0, 0}};
    texture.texels = std::vector<float>(3 * LatticeTexture::channels, 1.0f);
    texture.mlp = network;
    soup.appearance = texture;
    const Camera camera =
        straight_camera(side, side, side / 2.0 / std::tan(glm::radians(degrees) / 2));
    const Drawn drawn = draw(shared_context(), soup, glm::dvec3(0), camera);
    const oracle::Rays rays(soup, glm::dmat4(1.0), camera);
    double ours = 0, naive = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        glm::dvec3 seen;
        for (int c = 0; c < 3; ++c) {
          const double shown = drawn.color.at(x, y)[c] / 255.0;
          seen[c] = std::log(shown / (1 - shown)) / double(gain);
        }
        ours = worse(ours, glm::length(seen - rays.to_eye(x, y)));
        naive = worse(naive, glm::length(seen - rays.to_eye(x, side - 1 - y)));
      }
    // Half a step of 8 bits divided by the sigmoid's slope, which is smallest at |d| = 1, for three
    // channels.
    const double edge = 1 / (1 + std::exp(-double(gain)));
    const double tolerance = std::sqrt(3.0) * 0.5 / 255 / (double(gain) * edge * (1 - edge));
    recorder.add({.at = degrees, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

// -- V3, V4 -------------------------------------------------------------------------------------

TEST(Numerics, V3_TurningTheDirectionTurnsTheOddBands) {
  Recorder recorder({.stressed = "harmonics with the other convention and their odd bands negated: "
                                 "device and oracle",
                     .parameter = "degree",
                     .unit = "largest change of a channel",
                     .naive = "the other convention alone"});
  Random random(3);
  const Camera camera = random_camera(random, 96, 72);
  for (int degree = 0; degree <= 4; ++degree) {
    const TriangleSoup soup = random_soup(30, {.kind = Kind::face_harmonics, .degree = degree});
    TriangleSoup turned = soup, forgotten = soup;
    auto& sh = std::get<Harmonics>(turned.appearance);
    sh.view = ViewConvention::surface_to_eye;
    std::get<Harmonics>(forgotten.appearance).view = ViewConvention::surface_to_eye;
    const auto count = std::size_t(harmonics::count(degree));
    for (std::size_t i = 0; i < sh.coefficients.size(); ++i) {
      const std::size_t k = i % count;
      const bool odd = (k >= 1 && k < 4) || (k >= 9 && k < 16);
      if (odd) sh.coefficients[i] = -sh.coefficients[i];
    }
    const auto image = [&](const TriangleSoup& of) {
      return draw(shared_context(), of, glm::dvec3(0), camera).color;
    };
    const auto change = [](const Image8& a, const Image8& b) {
      int most = 0;
      for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
          most = std::max(most, std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])));
      return most / 255.0;
    };
    const Image8 first = image(soup);
    double in_oracle = 0;
    const OracleImage expected = snapped_oracle(soup, glm::dvec3(0), camera),
                      other = snapped_oracle(turned, glm::dvec3(0), camera);
    for (std::size_t i = 0; i < expected.color.pixels.size(); ++i)
      in_oracle = std::max(in_oracle,
                           double(glm::length(expected.color.pixels[i] - other.color.pixels[i])));
    // Products of negated factors are the same products: nothing changes, not even by rounding.
    recorder.add({.at = double(degree),
                  .naive = change(first, image(forgotten)),
                  .ours = std::max(change(first, image(turned)), in_oracle),
                  .tolerance = 0});
  }
}

// V3 also holds if both conventions are swapped. This test compares each with a colour computed
// without our basis and without our oracle.
TEST(Numerics, V3b_EachConventionHasItsOwnSign) {
  Recorder recorder({.stressed =
                         "harmonics of degree 1 in both conventions, colours by the formula of "
                         "Plenoxels and 3DGS: device and oracle",
                     .parameter = "angle of the face off the viewing axis / degrees",
                     .unit = "largest difference of a channel",
                     .naive = "the other convention"});
  const Camera camera = straight_camera(96, 96, 48);
  // Red depends on y alone, green on z, blue on x.
  const glm::vec3 by_y(0.6f, 0, 0), by_z(0, 0.5f, 0), by_x(0, 0, 0.7f);
  for (const double degrees : {0.0, 10.0, 20.0, 40.0})
    for (const ViewConvention view :
         {ViewConvention::eye_to_surface, ViewConvention::surface_to_eye}) {
      // The centroid of a face that faces the eye: up and to the right, seen from the origin.
      const double angle = glm::radians(degrees);
      const glm::dvec3 middle =
          4.0 * glm::dvec3(0.8 * std::sin(angle), 0.6 * std::sin(angle), -std::cos(angle));
      TriangleSoup soup =
          soup_of({middle + glm::dvec3(-0.5, -0.5, 0), middle + glm::dvec3(0.5, -0.5, 0),
                   middle + glm::dvec3(0, 1, 0)});
      Harmonics sh;
      sh.degree = 1;
      sh.view = view;
      sh.coefficients = {{0, 0, 0}, by_y, by_z, by_x};
      soup.appearance = sh;
      // C = 1/2 + sqrt(3 / 4 pi) (-y c1 + z c2 - x c3).
      const auto formula = [&](const glm::dvec3& d) {
        const double scale = std::sqrt(3 / (4 * M_PI));
        return 0.5 + scale * glm::dvec3(-0.6 * d.y, 0.5 * d.z, -0.7 * d.x);
      };
      const glm::dvec3 from_eye = glm::normalize(middle);
      const bool towards_surface = view == ViewConvention::eye_to_surface;
      const glm::dvec3 expected = formula(towards_surface ? from_eye : -from_eye),
                       other = formula(towards_surface ? -from_eye : from_eye);
      const int x = int(48 - 48 * middle.x / middle.z), y = int(48 + 48 * middle.y / middle.z);
      const glm::dvec3 shown =
          glm::dvec3(draw(shared_context(), soup, glm::dvec3(0), camera).color.at(x, y)) / 255.0;
      const glm::dvec3 in_oracle(snapped_oracle(soup, glm::dvec3(0), camera).color.at(x, y));
      const auto off = [&](const glm::dvec3& truth) {
        double most = 0;
        for (int c = 0; c < 3; ++c)
          most =
              worse(most, worse(std::abs(shown[c] - truth[c]), std::abs(in_oracle[c] - truth[c])));
        return most;
      };
      // Half a step of 8 bits, and float roundings relative to `terms`: the stored centroid, a
      // component of the direction (V1c), its products with the scale and a coefficient, and three
      // sums.
      const double terms = 0.5 + std::sqrt(3 / (4 * M_PI)) * (0.6 + 0.5 + 0.7);
      recorder.add({.at = degrees,
                    .naive = off(other),
                    .ours = off(expected),
                    .tolerance = 0.5 / 255 + (1 + 3 * 0.5 + 3 + 2 + 3) * terms * epsilon});
    }
}

TEST(Numerics, V4_HarmonicsOfUnitDirectionsKeepTheirPower) {
  Recorder recorder({.stressed = "the sum of squares of a band's harmonics, the worst of bands 0 "
                                 "to 4: soup and harmonics.glsl",
                     .parameter = "length of the direction before it is normalised",
                     .unit = "relative error of (2 l + 1) / 4 pi",
                     .naive = "directions that are not normalised"});
  Random random(4);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 500; ++i) directions.push_back(random.direction());
  // Each band separately: errors of different bands could cancel in a total.
  constexpr int bands = 5;
  const auto band_error = [](double sum, int band) {
    return std::abs(sum / ((2 * band + 1) / (4 * M_PI)) - 1);
  };
  const auto power_error = [&](const auto& basis) {
    double worst = 0;
    for (int band = 0; band < bands; ++band) {
      double sum = 0;
      for (int i = band * band; i < (band + 1) * (band + 1); ++i)
        sum += double(basis[std::size_t(i)]) * double(basis[std::size_t(i)]);
      worst = worse(worst, band_error(sum, band));
    }
    return worst;
  };
  // A probe returns four numbers.
  const auto on_device = [](int first_band, const std::vector<glm::vec4>& inputs) {
    return Probe(shared_context().capabilities().api,
                 "#include \"harmonics.glsl\"\n"
                 "vec4 probe(vec4 x) { float basis[HARMONICS_COUNT]; "
                 "harmonics_basis(normalize(x.xyz), basis); vec4 sums = vec4(0.0); "
                 "for (int i = 0; i < HARMONICS_COUNT; ++i) { "
                 "int band = i < 1 ? 0 : i < 4 ? 1 : i < 9 ? 2 : i < 16 ? 3 : 4; "
                 "if (band >= FIRST_BAND && band < FIRST_BAND + 4) "
                 "sums[band - FIRST_BAND] += basis[i] * basis[i]; } return sums; }",
                 {{"HARMONICS_DEGREE", "4"}, {"FIRST_BAND", std::to_string(first_band)}})
        .run(inputs);
  };
  for (const double length : {0.5, 0.99, 1.0, 1.01, 2.0}) {
    double ours = 0, naive = 0;
    std::vector<glm::vec4> inputs;
    for (const glm::dvec3& d : directions) {
      const glm::dvec3 long_one = length * d;
      ours = worse(ours, power_error(harmonics::basis(glm::normalize(glm::vec3(long_one)))));
      naive = worse(naive, power_error(harmonics::basis(long_one)));
      inputs.emplace_back(glm::vec3(long_one), 0);
    }
    for (const int first_band : {0, 1})
      for (const glm::vec4& sums : on_device(first_band, inputs))
        for (int i = 0; i < 4; ++i) ours = worse(ours, band_error(double(sums[i]), first_band + i));
    // Degree 4 multiplies four components of the direction, each with three roundings. Terms that
    // nearly cancel sum to at most 35 + 30 + 3 in place of 8 (the middle one at the pole, which
    // there is its whole band). A direction's length has two roundings, which count eight times in
    // the square. Nine terms are summed.
    recorder.add({.at = length,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = (8 * 2 + 2 * 4 * 3 * (35.0 + 30 + 3) / 8 + 9) * epsilon});
  }
}

// -- V5 -----------------------------------------------------------------------------------------

TEST(Numerics, V5_APrimitiveAtTheEyeHasAColour) {
  Recorder recorder({.stressed = "harmonics of a primitive at the eye or next to it: "
                                 "appearance_harmonics.glsl",
                     .parameter = "its distance / units",
                     .unit = "largest difference of a channel from the oracle",
                     .naive = "the offset divided by its length"});
  const gl::Api api = shared_context().capabilities().api;
  Harmonics sh;
  sh.degree = 1;
  sh.coefficients = {
      {0.2f, 0.1f, -0.3f}, {0.3f, -0.2f, 0.1f}, {0.25f, 0.3f, -0.1f}, {-0.2f, 0.1f, 0.3f}};
  const TexelLayout layout{.row_bits = 4, .layer_bits = 1, .max_layers = 8};
  std::vector<glm::vec4> padded;
  for (const glm::vec3& c : sh.coefficients) padded.emplace_back(c, 0);
  const TexelStore coefficients(layout,
                                TexelSource::of(texel_formats::rgba32f, padded, "coefficients"));
  const glm::dvec3 eye(0.0);
  for (const double distance : {0.0, 1e-15, 1e-8, 1e-3, 1.0}) {
    // A face whose corners coincide: its centroid is this point.
    const glm::vec3 point(distance * glm::normalize(glm::dvec3(1, 2, -2)));
    const TexelStore anchors(layout, TexelSource::of(texel_formats::rgba32f,
                                                     std::vector<glm::vec4>{{point, 0}}, "anchor"));
    const Probe probe(api,
                      "#include \"appearance_harmonics.glsl\"\n"
                      "vec4 probe(vec4 x) { return vec4(element_color(0u), 0.0); }",
                      {{"TEXEL_ROW_BITS", "4"},
                       {"TEXEL_LAYER_BITS", "1"},
                       {"HARMONICS_DEGREE", "1"},
                       {"HARMONICS_PER_VERTEX", "0"},
                       {"VIEW_SIGN", "-1.0"}});
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, coefficients.texture());
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D_ARRAY, anchors.texture());
    probe.program().set("coefficients", 1);
    probe.program().set("anchors", 2);
    set_eye(probe.program(), eye);
    const glm::dvec3 shown(probe.run({glm::vec4(0)})[0]);

    TriangleSoup soup = soup_of({point, point, point});
    soup.appearance = sh;
    const glm::dvec3 expected = oracle::color(soup, {.face = 0, .b0 = 0, .b1 = 0}, {0, 0, 1}, eye);
    double ours = 0;
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(shown[c] - expected[c]);
      ours = std::isnan(difference) ? infinity : std::max(ours, difference);
    }
    const glm::vec3 divided = point / glm::length(point);
    const bool a_direction = std::abs(glm::length(divided) - 1) < 1e-3;
    // Four terms of at most 0.3 x 0.49, and one half, with five roundings each.
    recorder.add({.at = distance,
                  .naive = a_direction ? 0.0 : infinity,
                  .ours = ours,
                  .tolerance = 5 * (4 * 0.3 * 0.49 + 0.5) * epsilon});
  }
}

}  // namespace view_direction_test
}  // namespace tureen::test
