// Changes that must not change an image (H1 to H7), and scenes at scale (H8 and H9). H1 to H7 are
// metamorphic relations: they compare two images whose correct pixels are both unknown.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <vector>

#include "oracle/oracle.hpp"
#include "scene/lattice.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {
namespace relations_test {

constexpr int width = 240, height = 180;
constexpr double pixels = double(width) * height;

/// Expects at least a thousand pixels that show a face: every relation holds for empty images.
Drawn drawn(const TriangleSoup& soup, const Camera& camera, glm::dvec3 origin = glm::dvec3(0)) {
  Drawn image = draw(shared_context(), soup, origin, camera);
  EXPECT_GT(shown_pixels(image.faces), 1000);
  return image;
}

/// Different roundings change colours by far less than a step of 8 bits, but may change the
/// resulting byte by one. A change of two steps means a colour change above one step: another face
/// or another texel, not rounding.
constexpr int one_step = 1;

/// Fraction of pixels with a channel that differs by more than `steps` of 8 bits.
double changed(const Image8& a, const Image8& b, int steps = 0) {
  double count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    bool other = false;
    for (int c = 0; c < 3; ++c)
      other = other || std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])) > steps;
    count += other;
  }
  return count / double(a.pixels.size());
}

/// Fraction of pixels whose left or upper neighbour shows another face.
double edges(const Drawn& image) {
  double count = 0;
  for (int y = 1; y < height; ++y)
    for (int x = 1; x < width; ++x) {
      const std::size_t i = std::size_t(y) * width + std::size_t(x);
      count += image.faces[i] != image.faces[i - 1] || image.faces[i] != image.faces[i - width];
    }
  return count / pixels;
}

/// The fraction of pixels that may change if corners move by `apart` pixels between two images. On
/// average, an edge passes as many centres as the area that it sweeps, its length times `apart`.
/// Each pixel along an edge that edges() counts contains an edge length of at most 2 (a diagonal
/// has sqrt(2)). Snapping corners to 1/256 of a pixel does not change the average: a corner that
/// moves by a tenth of a step snaps to another place one time in ten. One pixel is added because
/// the expected number is often below one, and pixels are whole.
double swept(double apart, const Drawn& image) { return 2 * apart * edges(image) + 1 / pixels; }

/// Vertices on a grid of an eighth, so that shifts by powers of two up to 2^20 are exact.
TriangleSoup on_a_grid(Kind kind) {
  TriangleSoup soup = random_soup(81, {.kind = kind, .faces = 150, .size = 0.2, .level = 3});
  for (glm::vec3& p : soup.positions) p = glm::round(p * 8.0f * 8.0f) / 8.0f;
  return soup;
}

Camera camera_about(const glm::dvec3& middle, double scale) {
  return look_at(middle + scale * glm::dvec3(19.5, 11.25, 7.625), middle, {0, 0, 1}, 0.8, width,
                 height);
}

TEST(Numerics, H1_TranslatedImagesAreTheSame) {
  Recorder recorder({.stressed = "soup and camera moved by powers of two: whole images",
                     .parameter = "offset / units",
                     .unit = "fraction of pixels changed"});
  for (int k = 0; k <= 20; ++k) {
    double ours = 0;
    for (const Kind kind : {Kind::face_colors, Kind::lattice_mlp}) {
      const TriangleSoup soup = on_a_grid(kind);
      const glm::vec3 shift = std::ldexp(1.0f, k) * glm::vec3(1, -1, 1);
      TriangleSoup moved = soup;
      for (glm::vec3& p : moved.positions) p += shift;
      // All arithmetic is exact, so every intermediate number is the same.
      const Camera before = camera_about({0, 0, 0}, 1);
      Camera after = before;
      after.view_from_world =
          before.view_from_world * glm::translate(glm::dmat4(1), -glm::dvec3(shift));
      ours = worse(ours, changed(drawn(soup, before).color, drawn(moved, after).color));
    }
    recorder.add({.at = std::ldexp(1.0, k), .ours = ours, .tolerance = 0});
  }
}

const double moved_by_rounding = vertex_rounding(height);  // a vertex, in pixels

/// Error of the eye of a camera about a place at distance `offset`, in pixels of a point 24 units
/// in front of it. The camera's translation is three products of the offset, and the eye is
/// computed from it the same way: twelve roundings to doubles per axis.
double eye_rounding(const Camera& camera, double offset) {
  return std::sqrt(3.0) * 12 * offset * 0x1p-53 / 24 * camera.fy;
}

// An eye exact in floats would not need its low half.
TEST(Numerics, H1c_AnEyeBetweenFloatsSeesTheSame) {
  Recorder recorder({.stressed =
                         "soup and camera moved by powers of two, from an eye not exact in floats: "
                         "whole images",
                     .parameter = "offset / units",
                     .unit = "fraction of pixels changed by more than a step of 8 bits"});
  const TriangleSoup soup = on_a_grid(Kind::lattice_mlp);
  const Camera before = look_at({19.5 + 1.0 / 3, 11.25 + 1.0 / 7, 7.625 - 1.0 / 9}, {0, 0, 0},
                                {0, 0, 1}, 0.8, width, height);
  const Drawn expected = drawn(soup, before);
  for (int k = 0; k <= 20; ++k) {
    const glm::vec3 shift = std::ldexp(1.0f, k) * glm::vec3(1, -1, 1);
    TriangleSoup moved = soup;
    for (glm::vec3& p : moved.positions) p += shift;
    Camera after = before;
    after.view_from_world =
        before.view_from_world * glm::translate(glm::dmat4(1), -glm::dvec3(shift));
    // Both images round a vertex again. The eye's low half is rounded by far less.
    const double apart = eye_rounding(before, std::ldexp(1.0, k)) + 2 * moved_by_rounding;
    recorder.add({.at = std::ldexp(1.0, k),
                  .ours = changed(expected.color, drawn(moved, after).color, one_step),
                  .tolerance = swept(apart, expected)});
  }
}

TEST(Numerics, H1b_AnOriginMovesNothing) {
  Recorder recorder({.stressed = "the layer's origin and the camera moved together: whole images",
                     .parameter = "offset / units",
                     .unit = "fraction of pixels changed by more than a step of 8 bits"});
  const TriangleSoup soup = on_a_grid(Kind::lattice_mlp);
  const Camera before = camera_about({0, 0, 0}, 1);
  const Drawn expected = drawn(soup, before);
  for (int k = 0; k <= 40; k += 8) {
    const glm::dvec3 shift = std::ldexp(1.0, k) * glm::dvec3(1, -1, 1);
    Camera after = before;
    after.view_from_world = before.view_from_world * glm::translate(glm::dmat4(1), -shift);
    // The vertices are the same numbers in both images. The error of the eye rounds them again,
    // once.
    const double apart = eye_rounding(before, std::ldexp(1.0, k)) + moved_by_rounding;
    recorder.add({.at = std::ldexp(1.0, k),
                  .ours = changed(expected.color, drawn(soup, after, shift).color, one_step),
                  .tolerance = swept(apart, expected)});
  }
}

TEST(Numerics, H2_ScaledImagesAreTheSame) {
  Recorder recorder({.stressed = "soup and camera scaled by powers of two: whole images",
                     .parameter = "scale",
                     .unit = "fraction of pixels changed"});
  for (const int k : {-20, -10, -3, 3, 10, 20}) {
    double ours = 0;
    for (const Kind kind : {Kind::vertex_colors, Kind::lattice_mlp, Kind::vertex_harmonics}) {
      const TriangleSoup soup = on_a_grid(kind);
      TriangleSoup scaled = soup;
      const double scale = std::ldexp(1.0, k);
      for (glm::vec3& p : scaled.positions) p *= float(scale);
      const Camera before = camera_about({0, 0, 0}, 1);
      Camera after = before;
      after.view_from_world[3] = glm::dvec4(scale * glm::dvec3(before.view_from_world[3]), 1);
      ours = worse(ours, changed(drawn(soup, before).color, drawn(scaled, after).color));
    }
    recorder.add({.at = std::ldexp(1.0, k), .ours = ours, .tolerance = 0});
  }
}

/// Distance of corners between two images of a soup on a grid, one with its vertices rounded again.
/// Rounding changes each axis by half a unit of 8, at a distance of at least 15. Each image adds
/// the roundings of the transformation.
double apart_by_new_vertices(const Camera& camera) {
  return std::sqrt(3.0) * 8 * epsilon / 15 * camera.fy + 2 * moved_by_rounding;
}

// No factor is a power of two, so every intermediate number is rounded differently.
TEST(Numerics, H2b_ScaledByAnythingTheyAreAlmost) {
  Recorder recorder({.stressed = "soup and camera scaled by other factors: whole images",
                     .parameter = "scale",
                     .unit = "fraction of pixels changed by more than a step of 8 bits"});
  const Camera before = camera_about({0, 0, 0}, 1);
  for (const double scale : {1e-3, 1e3, 1e6}) {
    Measurement worst{.at = scale};
    for (const Kind kind : {Kind::vertex_colors, Kind::lattice_mlp, Kind::vertex_harmonics}) {
      const TriangleSoup soup = on_a_grid(kind);
      const Drawn expected = drawn(soup, before);
      TriangleSoup scaled = soup;
      for (glm::vec3& p : scaled.positions) p = glm::vec3(scale * glm::dvec3(p));
      Camera after = before;
      after.view_from_world[3] = glm::dvec4(scale * glm::dvec3(before.view_from_world[3]), 1);
      const double ours = changed(expected.color, drawn(scaled, after).color, one_step);
      const double tolerance = swept(apart_by_new_vertices(before), expected);
      if (worst.tolerance == 0 || ours / tolerance > worst.ours / worst.tolerance) {
        worst.ours = ours;
        worst.tolerance = tolerance;
      }
    }
    recorder.add(worst);
  }
}

TEST(Numerics, H3_TurnedImagesAreTheSame) {
  Recorder recorder({.stressed = "soup and camera rotated together: whole images",
                     .parameter = "angle / degrees",
                     .unit = "fraction of pixels changed by more than a step of 8 bits"});
  const TriangleSoup soup = on_a_grid(Kind::lattice);
  const Camera before = camera_about({0, 0, 0}, 1);
  const Drawn expected = drawn(soup, before);
  for (const double degrees : {1.0, 30.0, 90.0, 137.0, 180.0}) {
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(glm::dvec3(1, 2, -1.5)));
    TriangleSoup turned = soup;
    for (glm::vec3& p : turned.positions) p = glm::vec3(turn * glm::dvec4(p, 1));
    Camera after = before;
    after.view_from_world = before.view_from_world * glm::transpose(turn);
    recorder.add({.at = degrees,
                  .ours = changed(expected.color, drawn(turned, after).color, one_step),
                  .tolerance = swept(apart_by_new_vertices(before), expected)});
  }
}

/// The faces in another order, with their appearance.
TriangleSoup permuted(const TriangleSoup& soup, const std::vector<std::uint32_t>& order) {
  TriangleSoup result = soup;
  for (std::size_t t = 0; t < order.size(); ++t) {
    result.triangles[t] = soup.triangles[order[t]];
    if (auto* texture = std::get_if<LatticeTexture>(&result.appearance))
      texture->patches[t] = std::get<LatticeTexture>(soup.appearance).patches[order[t]];
    if (auto* colors = std::get_if<FaceColors>(&result.appearance))
      colors->rgba[t] = std::get<FaceColors>(soup.appearance).rgba[order[t]];
  }
  return result;
}

TEST(Numerics, H4_PermutedFacesMakeTheSameImage) {
  Recorder recorder({.stressed = "faces in another order: whole images",
                     .parameter = "permutation",
                     .unit = "fraction of pixels changed"});
  Random random(4);
  for (int trial = 1; trial <= 4; ++trial) {
    double ours = 0;
    for (const Kind kind : {Kind::face_colors, Kind::lattice_mlp}) {
      // Off the grid, so that no two depths are the same.
      const TriangleSoup soup = random_soup(84, {.kind = kind, .faces = 150, .size = 0.2});
      const Camera camera = look_at({3, 1.5, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
      std::vector<std::uint32_t> order(soup.triangles.size());
      std::iota(order.begin(), order.end(), 0u);
      for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.below(std::uint32_t(i))]);
      ours = std::max(
          ours, changed(drawn(soup, camera).color, drawn(permuted(soup, order), camera).color));
    }
    recorder.add({.at = double(trial), .ours = ours, .tolerance = 0});
  }
}

/// Every face cut at its edges' midpoints into four. Each has the quarter of the lattice that it
/// covers, one level lower: the same texels at the same places.
TriangleSoup split_in_four(const TriangleSoup& soup) {
  const auto& from = std::get<LatticeTexture>(soup.appearance);
  TriangleSoup result;
  LatticeTexture to;
  std::vector<float> texels;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const LatticePatch patch = from.patches[t];
    const int n = lattice::resolution(int(patch.level)), half = n / 2;
    // Corners of the four as (x, y) on the parent's lattice, in the order of vertices 0, 1, 2.
    const std::array<std::array<glm::ivec2, 3>, 4> children = {
        {{{{n, 0}, {half, half}, {half, 0}}},
         {{{half, half}, {0, n}, {0, half}}},
         {{{half, 0}, {0, half}, {0, 0}}},
         {{{0, half}, {half, 0}, {half, half}}}}};
    for (const auto& child : children) {
      const auto first = std::uint32_t(result.positions.size());
      for (const glm::ivec2& at : child) {
        const double b0 = double(at.x) / n, b1 = double(at.y) / n;
        const glm::uvec3& corners = soup.triangles[t];
        result.positions.emplace_back(b0 * glm::dvec3(soup.positions[corners[0]]) +
                                      b1 * glm::dvec3(soup.positions[corners[1]]) +
                                      (1 - b0 - b1) * glm::dvec3(soup.positions[corners[2]]));
      }
      result.triangles.emplace_back(first, first + 1, first + 2);
      to.patches.push_back(
          {std::uint32_t(texels.size() / LatticeTexture::channels), patch.level - 1});
      for (std::uint32_t i = 0; i < lattice::texel_count(int(patch.level) - 1); ++i) {
        const auto [x, y] = lattice::texel_coordinates(i);
        const glm::ivec2 at = (x * child[0] + y * child[1] + (half - x - y) * child[2]) / half;
        const std::size_t texel = patch.first_texel + lattice::texel_index(at.x, at.y);
        for (int c = 0; c < LatticeTexture::channels; ++c) texels.push_back(from.value(texel, c));
      }
    }
  }
  to.texels = texels;
  to.mlp = from.mlp;
  result.appearance = to;
  return result;
}

TEST(Numerics, H5_SplitFacesShowTheSameTexture) {
  Recorder recorder(
      {.stressed = "faces split in four with the texels that they cover: whole images",
       .parameter = "level before",
       .unit = "fraction of pixels changed by more than a step of 8 bits"});
  for (const int level : {1, 3, 5}) {
    const TriangleSoup soup = random_soup(
        85,
        {.kind = Kind::lattice, .faces = 40, .size = 0.5, .level = level, .float_texels = true});
    const Camera camera = look_at({4, 1.5, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
    const Drawn before = drawn(soup, camera);
    // Midpoints are snapped to 1/256 of a pixel: an outline moves by at most half of that, a
    // quarter on average. The edges in alpha move by roundings alone.
    recorder.add({.at = double(level),
                  .ours = changed(before.color, drawn(split_in_four(soup), camera).color, one_step),
                  .tolerance = swept(0.25 / 256, before)});
  }
}

TEST(Numerics, H6_TransparentDuplicatesChangeNothing) {
  Recorder recorder({.stressed = "every face duplicated, the copy first, with an alpha of 0: whole "
                                 "images",
                     .parameter = "faces",
                     .unit = "fraction of pixels changed"});
  for (const int faces : {20, 100, 400}) {
    double ours = 0;
    for (const Kind kind : {Kind::face_colors, Kind::lattice_mlp}) {
      const TriangleSoup soup = random_soup(
          86, {.kind = kind, .faces = faces, .size = 0.2, .level = 2, .float_texels = true});
      TriangleSoup doubled = soup;
      doubled.triangles.clear();
      for (const glm::uvec3& triangle : soup.triangles)
        doubled.triangles.insert(doubled.triangles.end(), 2, triangle);
      if (auto* colors = std::get_if<FaceColors>(&doubled.appearance)) {
        const std::vector<glm::vec4> rgba = colors->rgba;
        colors->rgba.clear();
        for (const glm::vec4& color : rgba)
          colors->rgba.insert(colors->rgba.end(), {glm::vec4(1, 1, 1, 0), color});
      } else {
        auto& texture = std::get<LatticeTexture>(doubled.appearance);
        const std::vector<LatticePatch> patches = texture.patches;
        auto& texels = std::get<std::vector<float>>(texture.texels);
        const auto transparent = std::uint32_t(texels.size() / LatticeTexture::channels);
        for (std::uint32_t i = 0; i < lattice::texel_count(2); ++i)
          for (int c = 0; c < LatticeTexture::channels; ++c)
            texels.push_back(c == LatticeTexture::features ? 0.0f : 1.0f);
        texture.patches.clear();
        for (const LatticePatch& patch : patches)
          texture.patches.insert(texture.patches.end(), {{transparent, 2}, patch});
      }
      const Camera camera = look_at({3, 1.5, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
      ours = worse(ours, changed(drawn(soup, camera).color, drawn(doubled, camera).color));
    }
    recorder.add({.at = double(faces), .ours = ours, .tolerance = 0});
  }
}

TEST(Numerics, H7_MirroredScenesMakeMirroredImages) {
  Recorder recorder({.stressed = "soup and camera mirrored: whole images, mirrored back",
                     .parameter = "seed",
                     .unit = "fraction of pixels changed by more than a step of 8 bits"});
  for (const int seed : {1, 2, 3}) {
    const TriangleSoup soup = random_soup(
        870 + std::uint64_t(seed), {.kind = Kind::lattice, .faces = 150, .size = 0.2, .level = 3});
    TriangleSoup mirrored = soup;
    for (glm::vec3& p : mirrored.positions) p.x = -p.x;
    const Camera camera = look_at({0, 0.4, 3.5}, {0, 0, 0}, {0, 1, 0}, 0.8, width, height);
    const Drawn before = drawn(soup, camera);
    Image8 after = drawn(mirrored, camera).color;
    for (int y = 0; y < height; ++y)
      std::reverse(after.pixels.begin() + y * width, after.pixels.begin() + (y + 1) * width);
    // Negated numbers have the same roundings, but coordinates from the left border differ, so each
    // image has its own roundings. (A coordinate exactly half way between two steps of 1/256 would
    // be snapped to the other side; this seed has none.)
    recorder.add({.at = double(seed),
                  .ours = changed(before.color, after, one_step),
                  .tolerance = swept(2 * moved_by_rounding, before)});
  }
}

TEST(Numerics, H8_OneTriangleAroundTheEye) {
  Recorder recorder({.stressed =
                         "one triangle of size 1 close before the eye, filling the view: device "
                         "and oracle",
                     .parameter = "its distance / its size",
                     .unit = "pixels from the image's border to the innermost that it does not "
                             "cover",
                     .naive = "near at a thousandth of the radius, for 24 bits"});
  const Camera camera = straight_camera(width, height, height);
  for (const double distance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const auto z = float(-distance);
    const TriangleSoup soup = soup_of({{-0.7f, -0.5f, z}, {0.7f, -0.5f, z}, {0, 0.9f, z}});
    const auto innermost_hole = [](const std::vector<std::uint32_t>& faces) {
      double most = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          if (faces[std::size_t(y) * width + std::size_t(x)] == no_face)
            most = std::max(most, std::min({x + 0.5, y + 0.5, width - x - 0.5, height - y - 0.5}));
      return most;
    };
    const std::vector<std::uint32_t> with_24_bits = faces_of_device(soup, camera, false);
    const double ours = innermost_hole(faces_of_device(soup, camera)),
                 naive = innermost_hole(with_24_bits);
    EXPECT_EQ(innermost_hole(faces_of_oracle(soup, camera)), 0) << distance;
    // Where an edge meets a border of the image, its corner is a + t (b - a), with b - a up to 1.4
    // and t about a half. Two distances to the border, their quotient t, b - a and the product make
    // five roundings of a value of 0.7. Their signs are random, so they add up as the root of their
    // number. The image enlarges them by this distance. A centre is half a pixel from the border: a
    // narrower band makes no hole.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = std::sqrt(5.0) * 0.7 * epsilon / distance * camera.fx});
    // As in C4: 24 bits hide everything nearer than a thousandth of the radius, and nothing else.
    if (distance < 1e-3 * bounds(soup).radius()) {
      EXPECT_EQ(shown_pixels(with_24_bits), 0) << distance;
    } else {
      EXPECT_EQ(naive, ours) << distance;
    }
  }
}

/// A slanted plane over a square of 12 units about the origin, cut into cells of two faces each.
struct CutPlane {
  static constexpr double side = 12;
  static constexpr glm::dvec2 slope{0.3, -0.2};
  int cells = 0;

  glm::dvec3 at(const glm::dvec2& place) const { return {place, glm::dot(slope, place)}; }

  TriangleSoup soup() const {
    TriangleSoup soup;
    Random random(9);
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x)
        soup.positions.emplace_back(at(side * glm::dvec2(x, y) / double(cells) - side / 2));
    FaceColors colors;
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const auto at = [&](int i, int j) { return std::uint32_t((y + j) * (cells + 1) + x + i); };
        soup.triangles.emplace_back(at(0, 0), at(1, 0), at(1, 1));
        soup.triangles.emplace_back(at(0, 0), at(1, 1), at(0, 1));
        for (int i = 0; i < 2; ++i)
          colors.rgba.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1);
      }
    soup.appearance = colors;
    return soup;
  }

  /// The face where the ray through a point of the image meets the plane. The plane fills the
  /// image.
  std::uint32_t face_at(const Camera& camera, double x, double y) const {
    const glm::dvec3 ray =
        camera.world_from_view_rotation() *
        glm::dvec3((x - camera.cx) / camera.fx, (camera.cy - y) / camera.fy, -1.0);
    const glm::dvec3 eye = camera.eye(), normal(-slope, 1);
    const glm::dvec3 hit = eye - glm::dot(normal, eye) / glm::dot(normal, ray) * ray;
    const glm::dvec2 place = (glm::dvec2(hit) + side / 2) / side * double(cells);
    const glm::dvec2 cell = glm::floor(place), within = place - cell;
    return 2 * std::uint32_t(cell.y * cells + cell.x) + (within.y > within.x);
  }
};

TEST(Numerics, H9_AMillionCoplanarFaces) {
  Recorder recorder(
      {.stressed = "a plane cut into faces that share edges, seen at an angle: device",
       .parameter = "faces",
       .unit = "of 43200 pixels are holes, or away from edges show another face than that "
               "on their ray"});
  const Camera camera = look_at({0.4, -1.2, 1.5}, {0, 0, 0}, {0, 0, 1}, 0.7, width, height);
  for (const int cells : {70, 224, 708}) {  // 1e4, 1e5, 1e6 faces
    const CutPlane plane{cells};
    const Drawn image = drawn(plane.soup(), camera);
    // The largest error of a corner: half a step of 1/256 of a pixel, the roundings of the
    // transformation (G3), and the roundings of its three coordinates, half a unit of 8 each, seen
    // from a distance of at least 1.
    const double moved = 0.5 / 256 + moved_by_rounding + std::sqrt(3.0) * 4 * epsilon * camera.fy;
    double wrong = 0, away_from_edges = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::uint32_t shown = image.faces[std::size_t(y) * width + std::size_t(x)];
        // A face that contains the square's four corners contains the square.
        const double left = x + 0.5 - moved, right = x + 0.5 + moved;
        const double top = y + 0.5 - moved, bottom = y + 0.5 + moved;
        const std::uint32_t face = plane.face_at(camera, left, top);
        const bool away = face == plane.face_at(camera, right, top) &&
                          face == plane.face_at(camera, left, bottom) &&
                          face == plane.face_at(camera, right, bottom);
        away_from_edges += away;
        wrong += shown == no_face || (away && shown != face);
      }
    ASSERT_GT(away_from_edges, 0.95 * pixels);
    recorder.add({.at = 2.0 * cells * cells, .ours = wrong, .tolerance = 0});
  }
}

}  // namespace relations_test
}  // namespace tureen::test
