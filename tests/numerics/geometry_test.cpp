// Geometry and projection: cases G1 to G9.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "oracle/hits.hpp"
#include "runtime/renderer.hpp"
#include "scene/lint/lint.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/numerics/vertex_probe.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/debug_view_renderer.hpp"
#include "tests/support/random.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/fragments.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cuda/device_image.hpp"

namespace tureen::test {
namespace geometry_test {

using Faces = std::vector<std::uint32_t>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Pixel coordinates in floats, as in a naive projection: x, y and the depth.
glm::vec3 float_pixel(const Camera& camera, const glm::vec3& p) {
  const glm::vec3 v(glm::mat4(camera.view_from_world) * glm::vec4(p, 1));
  const float w = -v.z;
  return {float(camera.fx) * v.x / w + float(camera.cx),
          float(camera.cy) - float(camera.fy) * v.y / w, w};
}

/// Twice the signed area of a, b and the point, in floats.
float float_edge(const glm::vec3& a, const glm::vec3& b, float x, float y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

// -- G1 -----------------------------------------------------------------------------------------

/// Faces with three corners exactly on a line, with two or three coincident corners, and with
/// corners that are not finite; about `middle`, with extent `size`.
std::vector<glm::vec3> faces_without_area(Random& random, glm::vec3 middle, float size) {
  std::vector<glm::vec3> corners;
  const auto point = [&] {
    // Few bits, so that sums below are exact.
    return glm::vec3(float(random.below(16)) - 8, float(random.below(16)) - 8,
                     float(random.below(16)) - 8) *
           (size / 8);
  };
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 a = middle + point(), step = point() / 4.0f;
    corners.insert(corners.end(), {a, a + step, a + 3.0f * step});
    corners.insert(corners.end(), {a, a, a + step});
    corners.insert(corners.end(), {a, a, a});
    corners.insert(corners.end(), {{float(std::nan("")), 0, -1}, a, a + step});
    corners.insert(corners.end(), {a, {0, float(-infinity), 0}, a + step});
  }
  return corners;
}

TEST(Numerics, G1_FacesWithoutAreaShowNothing) {
  Recorder recorder({.stressed =
                         "faces without area, or with corners that are not finite, before a "
                         "wall: oracle, device and trainer",
                     .parameter = "their size / units",
                     .unit = "pixels changed",
                     .naive = "barycentrics divided by the area, accepted if not outside"});
  Random random(11);
  constexpr int side = 96;
  for (const float size : {0.0625f, 1.0f, 16.0f, 256.0f}) {
    const Camera camera = look_at({0.3, -0.2, 4}, {0, 0.1, 0}, {0.1, 1, 0.2}, 0.9, side, side);
    std::vector<glm::vec3> corners = {{-9, -9, -3}, {9, -9, -3}, {0, 12, -3}};
    const TriangleSoup wall = soup_of(corners);
    const std::vector<glm::vec3> none = faces_without_area(random, {0, 0, 1}, size);
    corners.insert(corners.end(), none.begin(), none.end());
    const TriangleSoup both = soup_of(corners);
    double ours = 0;
    ours += differing(faces_of_oracle(wall, camera), faces_of_oracle(both, camera));
    ours += differing(faces_of_device(wall, camera), faces_of_device(both, camera));
    ours += differing(faces_of_trainer(wall, camera), faces_of_trainer(both, camera));
    // A renderer that first divides, then checks whether a barycentric is outside.
    std::size_t naive = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        bool changed = false;
        for (std::size_t t = 0; t < none.size() && !changed; t += 3) {
          glm::vec3 p[3];
          for (std::size_t k = 0; k < 3; ++k) p[k] = float_pixel(camera, none[t + k]);
          const float area = float_edge(p[0], p[1], p[2].x, p[2].y);
          bool outside = false;
          for (int k = 0; k < 3; ++k)
            outside = outside ||
                      float_edge(p[(k + 1) % 3], p[(k + 2) % 3], float(x) + 0.5f, float(y) + 0.5f) /
                              area <
                          0;
          changed = !outside;
        }
        naive += changed;
      }
    recorder.add({.at = size, .naive = double(naive), .ours = ours, .tolerance = 0});
  }
}

// -- G2 -----------------------------------------------------------------------------------------

TEST(Numerics, G2_NeedlesThatShareEdgesCoverEveryCenterOnce) {
  Recorder recorder({.stressed =
                         "a fan of needles that share edges through pixel centres: oracle and "
                         "device",
                     .parameter = "aspect of the needles",
                     .unit = "pixel centres not covered exactly once",
                     .naive = "each face's own edge functions in floats, >= 0"});
  Recorder cracks({.stressed = "the same in the trainer, where a face covers all of its edges",
                   .parameter = "aspect of the needles",
                   .unit = "pixel centres not covered at all"});
  constexpr int side = 256;
  const Camera camera = straight_camera(side, side, side);
  const auto at_pixel = [&](double x, double y) {
    return glm::vec3((x - camera.cx) / side, (camera.cy - y) / side, -1);
  };
  const glm::vec3 apex = at_pixel(32, 32);
  const double length = 192 * std::sqrt(2.0);
  // Along the line opposite the apex, from its middle, which lies on the diagonal through pixel
  // centres.
  const auto opposite = [&](double pixels) {
    return at_pixel(224.3 + pixels * std::sqrt(0.5), 224.3 - pixels * std::sqrt(0.5));
  };
  for (int exponent = 1; exponent <= 7; ++exponent) {
    const double aspect = std::pow(10.0, exponent), width = length / aspect;
    const int needles = 2 * std::min(500, int(120 / width));
    std::vector<double> places = {-150};
    const int middle = needles / 2;
    for (int i = 0; i <= needles; ++i) places.push_back(width * (i - middle));
    places.push_back(150);
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      corners.insert(corners.end(), {apex, opposite(places[i]), opposite(places[i + 1])});
    const TriangleSoup soup = soup_of(corners);

    // Far enough from the border that roundings do not matter.
    const auto well_within = [&](double x, double y) {
      const double along = (x - 32) + (y - 32), across = std::abs((x - 32) - (y - 32));
      return along < 2 * 192.3 - 4 && across < along * 150 / (192.3 * std::sqrt(2.0)) - 4;
    };
    std::vector<int> counts[2], in_floats(side * side), in_trainer(side * side);
    for (const auto coverage : {oracle::Coverage::exact, oracle::Coverage::snapped}) {
      auto& count = counts[coverage == oracle::Coverage::snapped];
      count.resize(side * side);
      const oracle::Rays rays(soup, glm::dmat4(1.0), camera, {.coverage = coverage});
      rays.visit_faces(
          0, side, [&](int x, int y, const oracle::Hit&) { ++count[std::size_t(y) * side + x]; });
    }
    DebugViewRenderer debug_renderer(shared_context(), soup, glm::dvec3(0));
    debug_renderer.show(DebugView::overdraw);
    debug_renderer.renderer().draw({camera});
    const std::vector<std::uint8_t> on_device = debug_renderer.read_fragment_counts();
    const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), 0.01, 100);
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      trainer::test::for_each_fragment(view, trainer::kernels::project(view, &corners[t].x),
                                       {0, 0, side, side},
                                       [&](const trainer::kernels::Fragment& f) {
                                         ++in_trainer[std::size_t(f.y) * side + f.x];
                                       });
      glm::vec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = float_pixel(camera, corners[t + k]);
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          bool inside = true;
          for (int k = 0; k < 3 && inside; ++k)
            inside = float_edge(p[k], p[(k + 1) % 3], float(x) + 0.5f, float(y) + 0.5f) <= 0;
          in_floats[std::size_t(y) * side + x] += inside;
        }
    }
    double wrong[5] = {};
    int within = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        if (!well_within(x + 0.5, y + 0.5)) continue;
        ++within;
        const auto i = std::size_t(y) * side + x;
        wrong[0] += counts[0][i] != 1;
        wrong[1] += counts[1][i] != 1;
        wrong[2] += on_device[i] != 1;
        wrong[3] += in_floats[i] != 1;
        wrong[4] += in_trainer[i] < 1;
      }
    ASSERT_GT(within, 10'000);
    recorder.add({.at = aspect,
                  .naive = wrong[3],
                  .ours = std::max({wrong[0], wrong[1], wrong[2]}),
                  .tolerance = 0});
    cracks.add({.at = aspect, .ours = wrong[4], .tolerance = 0});
  }
}

// -- G3 -----------------------------------------------------------------------------------------

TEST(Numerics, G3_VerticesFarFromTheOriginStayInPlace) {
  Recorder recorder({.stressed = "soup and camera far from the origin, 1920x1080: geometry.vert",
                     .parameter = "offset / units",
                     .unit = "pixels",
                     .naive = "one matrix in floats, including the translation",
                     // The catalogue measured 6e-3 pixels here, growing in proportion to the
                     // offset.
                     .naive_fails_from = 100});
  Random random(3);
  for (int k = 0; k <= 20; ++k) {
    const double offset = std::ldexp(1.0, k);
    const glm::dvec3 shift = offset * glm::dvec3(1, -0.5, 0.75);
    Camera camera = look_at(shift + glm::dvec3(5, 1.3, 0.4), shift, {0, 0, 1}, 0.9, 1920, 1080);
    std::vector<glm::vec3> positions;  // rounded at their place, as in a file
    for (int i = 0; i < 1000; ++i)
      positions.emplace_back(
          shift + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    const glm::dmat4 projection = clip_from_view_reversed(camera, 0.01);
    const std::vector<glm::vec4> clip =
        clip_positions({camera, camera.eye(), {0.01, 100}}, projection, positions);
    const glm::dmat4 exact = projection * camera.view_from_world;
    const glm::mat4 in_floats(exact);
    const auto pixel = [&](const glm::dvec4& p) {
      return glm::dvec2(camera.width / 2.0 * p.x / p.w, camera.height / 2.0 * p.y / p.w);
    };
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const glm::dvec2 truth = pixel(exact * glm::dvec4(positions[i], 1));
      ours = worse(ours, glm::length(pixel(clip[i]) - truth));
      naive = worse(naive, glm::length(pixel(in_floats * glm::vec4(positions[i], 1)) - truth));
    }
    // x of a clip position is three products of rounded factors and two sums: at most five
    // roundings of a value whose terms add up to 2 w. The same holds for w. Before that, the
    // difference to the eye is rounded on three axes. Half the width, 960 pixels, corresponds to w;
    // the sum is 2 w + 2 w + sqrt(3) w.
    const double tolerance = 960 * (5 * 2 + 5 * 2 + std::sqrt(3.0)) * epsilon;
    recorder.add({.at = offset, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

TEST(Numerics, G3b_CoarseVerticesAreToldOf) {
  Recorder recorder({.stressed = "vertices stored far from the origin, unless `lint` reports them",
                     .parameter = "offset / extents",
                     .unit = "rounding of a vertex / extents",
                     .naive = "no report"});
  Random random(4);
  for (int k = 0; k <= 22; k += 2) {
    const double offset = std::ldexp(1.0, k);
    std::vector<glm::vec3> corners;
    double rounding = 0;
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 p(offset + random.uniform(), random.uniform(), random.uniform());
      corners.emplace_back(p);
      rounding = std::max(rounding, std::abs(double(corners.back().x) - p.x));
    }
    const bool told = lint(soup_of(corners)).find(LintFinding::Id::far_from_origin);
    // The bounds of the unit cube measure sqrt(3). At a ratio of 2e-4, half a step of floats, at
    // most 2^-24 of the offset, is 1 / 3355 of that.
    recorder.add({.at = offset,
                  .naive = rounding,
                  .ours = told ? 0 : rounding,
                  .tolerance = std::sqrt(3.0) / 2e-4 * epsilon});
  }
}

// -- G4, G5 -------------------------------------------------------------------------------------

TEST(Numerics, G4_AFloorThroughTheCameraIsClippedNotDropped) {
  Recorder recorder({.stressed =
                         "a floor that begins behind the eye: device and trainer against the "
                         "oracle",
                     .parameter = "distance behind the eye / units",
                     .unit = "pixels wrong away from edges",
                     .naive = "faces with a corner behind the eye are dropped"});
  constexpr int side = 128;
  const Camera camera = straight_camera(side, side, 100);
  for (const float behind : {1.0f, 30.0f, 1e3f, 1e5f}) {
    // A wall at the far end, which the naive method shows through the floor; then the floor.
    const std::vector<glm::vec3> wall = {{-90, -60, -61}, {90, -60, -61}, {0, 90, -61}};
    std::vector<glm::vec3> corners = wall;
    for (int i = -4; i < 4; ++i) {
      const float x0 = float(i) * 3, x1 = x0 + 3;
      corners.insert(corners.end(), {{x0, -1, behind}, {x1, -1, behind}, {x0, -1.2f, -60}});
      corners.insert(corners.end(), {{x1, -1, behind}, {x1, -1.2f, -60}, {x0, -1.2f, -60}});
    }
    const TriangleSoup soup = soup_of(corners);
    const Faces expected = faces_of_oracle(soup, camera);
    ASSERT_GT(shown_pixels(expected), side * side / 4);
    const double device =
        differing_away_from_edges(expected, faces_of_device(soup, camera), side, side);
    const double trained =
        differing_away_from_edges(faces_of_oracle(soup, camera, oracle::Coverage::exact),
                                  faces_of_trainer(soup, camera, 0.01, 1e5), side, side);
    std::vector<glm::vec3> kept;
    for (std::size_t t = 0; t < corners.size(); t += 3)
      if (std::all_of(&corners[t], &corners[t] + 3, [](const glm::vec3& p) { return p.z < 0; }))
        kept.insert(kept.end(), &corners[t], &corners[t] + 3);
    ASSERT_EQ(kept, wall);  // so that faces keep their names
    const double naive =
        differing_away_from_edges(expected, faces_of_device(soup_of(kept), camera), side, side);
    recorder.add({.at = behind, .naive = naive, .ours = std::max(device, trained), .tolerance = 0});
  }
}

TEST(Numerics, G5_CornersInTheEyesPlaneKeepTheirPixels) {
  Recorder recorder({.stressed = "a corner at w = 0 or next to it: the trainer's rectangles",
                     .parameter = "|w| of the corner",
                     .unit = "covered pixels outside of the rectangle",
                     .naive = "all corners divided by w + 1e-7"});
  constexpr int side = 64;
  const Camera camera = straight_camera(side, side, 64);
  const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), 1e-3, 100);
  // The crossing of edges with the near plane is computed in doubles, from a quotient and a sum of
  // depths of at most 2, with four roundings. The oracle's depth has as many. Closer to the plane,
  // either side is acceptable.
  const double near = view.near + 2 * 4 * 2 * 0x1p-53;
  Random random(5);
  for (const float w : {0.0f, 1e-30f, 1e-7f, 1e-3f, 1.0f}) {
    double ours = 0, naive = 0;
    int covered = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const auto coordinate = [&] { return float(random.uniform(-1, 1)); };
      const float sign = random.chance(0.5) ? 1.0f : -1.0f;
      const std::vector<glm::vec3> corners = {{coordinate(), coordinate(), sign * w},
                                              {coordinate(), coordinate(), -1},
                                              {coordinate(), coordinate(), -2}};
      const trainer::kernels::ProjectedFace face = trainer::kernels::project(view, &corners[0].x);
      float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f};
      for (const glm::vec3& p : corners)
        for (int axis = 0; axis < 2; ++axis) {
          const float at = 64 * (axis ? -p.y : p.x) / (-p.z + 1e-7f) + 32;
          low[axis] = std::min(low[axis], at);
          high[axis] = std::max(high[axis], at);
        }
      const TriangleSoup soup = soup_of(corners);
      oracle::Rays(soup, glm::dmat4(1.0), camera)
          .visit_faces(0, side, [&](int x, int y, const oracle::Hit& hit) {
            if (hit.depth < near) return;
            ++covered;
            ours += x < face.x0 || x >= face.x1 || y < face.y0 || y >= face.y1;
            naive += float(x) + 0.5f < low[0] || float(x) + 0.5f > high[0] ||
                     float(y) + 0.5f < low[1] || float(y) + 0.5f > high[1];
          });
    }
    ASSERT_GT(covered, 1000);
    recorder.add({.at = w, .naive = naive, .ours = ours, .tolerance = 0});
  }
}

// -- G6, G7 -------------------------------------------------------------------------------------

TEST(Numerics, G6_ADollyPastALargeFaceIsContinuous) {
  Recorder recorder({.stressed = "a dolly along a wall whose middle passes the eye: device",
                     .parameter = "depth of the wall's middle / units",
                     .unit = "mean change of a pixel from one frame to the next",
                     .naive = "faces are dropped when their centroid is nearer than 0.2"});
  constexpr int side = 128;
  const Camera straight = straight_camera(side, side, 64);
  // Walls on the left: squares of 8 units, from behind the eye to far in front of it.
  std::vector<glm::vec3> corners = {{-1, -4, 4}, {-1, 4, 4},  {-1, -4, -4},
                                    {-1, 4, 4},  {-1, 4, -4}, {-1, -4, -4}};
  TriangleSoup soup = soup_of(corners);
  soup.appearance = FaceColors{{glm::vec4(1), glm::vec4(1)}};
  Renderer renderer =
      renderer_of(shared_context(), soup, glm::dvec3(0), {.plan = {.site = ShadingSite::deferred}});
  std::vector<double> before, naive_before;
  constexpr double stride = 0.05;
  for (int step = 0; step <= 100; ++step) {
    const double eye = 2.5 - step * stride;  // along -z
    Camera camera = straight;
    camera.view_from_world[3] = glm::dvec4(0, 0, -eye, 1);
    renderer.draw({camera});
    const Faces faces = faces_of(renderer);
    ASSERT_EQ(faces.size(), std::size_t(side * side));
    std::vector<double> now, naive_now;
    for (const std::uint32_t face : faces) {
      now.push_back(face == no_face ? 0 : 1);
      bool dropped = false;
      if (face != no_face) {
        const double centroid =
            (double(corners[3 * face].z) + corners[3 * face + 1].z + corners[3 * face + 2].z) / 3;
        dropped = eye - centroid < 0.2;
      }
      naive_now.push_back(dropped ? 0 : now.back());
    }
    const auto change = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]) / double(a.size());
      return sum;
    };
    // Only the far end of the wall's outline moves. It is an upright line one unit off the axis: it
    // crosses the pixels of this many columns, and of one more, depending on their centres.
    const double end = eye + 4;  // its depth
    const double columns = straight.fx / end - straight.fx / (end + stride) + 1;
    if (step > 0)
      recorder.add({.at = eye,
                    .naive = change(naive_before, naive_now),
                    .ours = change(before, now),
                    .tolerance = columns / side});
    before = now;
    naive_before = naive_now;
  }
}

TEST(Numerics, G7_TrianglesBelowAPixelKeepTheirShareOfTheLight) {
  Recorder recorder({.stressed = "a wall of triangles below a pixel, half of them missing: device",
                     .parameter = "size of a triangle / pixels",
                     .unit = "relative change of the mean intensity at a quarter of the size",
                     .naive = "triangles of less than a pixel are dropped"});
  Random random(7);
  constexpr int side = 512, small = side / 4;
  for (const double pixels : {0.5, 1.0, 2.0, 4.0}) {
    // The size at a quarter of the resolution.
    const int cells = int(side / (4 * pixels));
    std::vector<glm::vec3> corners;
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const auto corner = [&](int i, int j) {
          return glm::vec3(double(x + i) / cells - 0.5, double(y + j) / cells - 0.5, -1);
        };
        if (random.chance(0.5))
          corners.insert(corners.end(), {corner(0, 0), corner(1, 0), corner(1, 1)});
        if (random.chance(0.5))
          corners.insert(corners.end(), {corner(0, 0), corner(1, 1), corner(0, 1)});
      }
    const TriangleSoup soup = soup_of(corners);
    const auto intensity = [](const TriangleSoup& of, int size) {
      return shown_pixels(faces_of_device(of, straight_camera(size, size, size))) / size / size;
    };
    const double full = intensity(soup, side), quarter = intensity(soup, small);
    // Triangles whose box is less than a pixel wide or high become points, which cover nothing.
    std::vector<glm::vec3> large = corners;
    const Camera small_camera = straight_camera(small, small, small);
    for (std::size_t t = 0; t < large.size(); t += 3) {
      glm::vec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = float_pixel(small_camera, large[t + k]);
      const glm::vec3 box =
          glm::max(p[0], glm::max(p[1], p[2])) - glm::min(p[0], glm::min(p[1], p[2]));
      if (std::min(box.x, box.y) < 1) large[t + 1] = large[t + 2] = large[t];
    }
    const double without_small = intensity(soup_of(large), small);
    // The catalogue's bound of 2 %. If samples were independent, a mean of 16384 zeros and ones
    // would have a deviation of 0.4 %, or 0.8 % of a mean of one half; 2 % is 2.6 times that. The
    // wall's triangles lie in rows, which reduces the deviation, and the seed is fixed.
    recorder.add({.at = pixels,
                  .naive = std::abs(without_small / full - 1),
                  .ours = std::abs(quarter / full - 1),
                  .tolerance = 0.02});
  }
}

// -- G8, G9 -------------------------------------------------------------------------------------

TEST(Numerics, G8_DepthKeysAreInTheOrderOfDepths) {
  Recorder recorder({.stressed = "depths as the bits of an integer: the trainer's keys on a GPU",
                     .parameter = "range of depths / decades",
                     .unit = "neighbours in the wrong order of 100,000",
                     .naive = "the bits of a depth that may be negative"});
  Random random(8);
  for (const double decades : {1.0, 4.0, 16.0, 37.0}) {
    std::vector<float> depths, signed_depths;
    for (int i = 0; i <= 100'000; ++i) {
      depths.push_back(float(std::pow(10.0, random.uniform(-decades, decades))));
      signed_depths.push_back(random.chance(0.5) ? -depths.back() : depths.back());
    }
    depths.insert(depths.end(),
                  {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::min(),
                   std::numeric_limits<float>::max()});
    std::sort(depths.begin(), depths.end());
    std::sort(signed_depths.begin(), signed_depths.end());
    const auto key = [&](float depth) {
      return trainer::cuda::visible_key(depth, random.below(1000));
    };
    const auto bits = [](float value) {
      std::uint32_t result;
      std::memcpy(&result, &value, sizeof result);
      return result;
    };
    double ours = 0, naive = 0;
    for (std::size_t i = 1; i < depths.size(); ++i) {
      ours += depths[i] > depths[i - 1] && key(depths[i]) <= key(depths[i - 1]);
      // Of two equal depths the lower face is nearer.
      ours += trainer::cuda::visible_key(depths[i], 7) <= trainer::cuda::visible_key(depths[i], 8);
    }
    for (std::size_t i = 1; i < signed_depths.size(); ++i)
      naive += signed_depths[i] > signed_depths[i - 1] &&
               bits(signed_depths[i]) <= bits(signed_depths[i - 1]);
    recorder.add({.at = decades, .naive = naive, .ours = ours, .tolerance = 0});
  }
  // Inverse depths that become keys are above 0, for faces through the eye's plane and far away.
  const Camera camera = straight_camera(64, 64, 64);
  for (const float near : {1e-6f, 0.01f, 1.0f}) {
    int fragments = 0;
    for (const float reach : {1.0f, 1e6f, 1e30f}) {
      const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), near, 1e35);
      const float corners[] = {-reach, -reach, reach, reach, -reach, -reach, 0, reach, -reach};
      trainer::test::for_each_fragment(view, trainer::kernels::project(view, corners),
                                       {0, 0, 64, 64}, [&](const trainer::kernels::Fragment& f) {
                                         ++fragments;
                                         EXPECT_GT(f.inverse_depth, 0) << near << ", " << reach;
                                         EXPECT_LE(f.inverse_depth, 1 / near * 1.000001f);
                                       });
    }
    EXPECT_GT(fragments, 100) << near;
  }
}

/// A depth buffer that accepts equal depths: in this order, the last face wins.
Faces last_of_equals(const std::vector<glm::vec3>& corners, const Camera& camera,
                     const std::vector<std::uint32_t>& order) {
  const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), 0.01, 100);
  Faces winner(std::size_t(camera.width) * std::size_t(camera.height), no_face);
  std::vector<float> nearest(winner.size(), 0);
  for (const std::uint32_t face : order)
    trainer::test::for_each_fragment(
        view, trainer::kernels::project(view, &corners[3 * face].x),
        {0, 0, camera.width, camera.height}, [&](const trainer::kernels::Fragment& f) {
          const std::size_t i = std::size_t(f.y) * std::size_t(camera.width) + std::size_t(f.x);
          if (f.inverse_depth < nearest[i]) return;
          nearest[i] = f.inverse_depth;
          winner[i] = face;
        });
  return winner;
}

TEST(Numerics, G9_OfCoincidentFacesTheLowerOneShowsEveryTime) {
  Recorder recorder({.stressed = "coincident faces, 100 frames each: device and trainer",
                     .parameter = "faces at one place",
                     .unit = "pixels of 100 frames that show another face than the oracle, and "
                             "than in the first frame",
                     .naive = "the last to arrive wins, in an order that changes"});
  Random random(9);
  constexpr int side = 48;
  for (const int copies : {2, 5, 20}) {
    // No centre is nearer to an edge than 0.03 pixels, far more than the device's grid and
    // roundings of floats. On an edge, the trainer and the oracle choose different owners.
    std::vector<glm::vec3> corners;
    for (int i = 0; i < copies; ++i)
      corners.insert(corners.end(),
                     {{-0.91f, -1.06f, -2}, {0.95f, -0.8f, -2.5f}, {0.28f, 0.94f, -1.7f}});
    const TriangleSoup soup = soup_of(corners);
    const Camera camera = straight_camera(side, side, side);
    // On the device's grid and off it; the lowest face wherever a face covers the centre.
    const Faces on_grid = faces_of_oracle(soup, camera);
    const Faces exact = faces_of_oracle(soup, camera, oracle::Coverage::exact);
    ASSERT_GT(std::count(on_grid.begin(), on_grid.end(), 0u), side * side / 8);
    ASSERT_EQ(std::count(on_grid.begin(), on_grid.end(), 0u), shown_pixels(on_grid));
    // With normal frames, where opaque faces hide the copies behind them before anything is drawn,
    // and with all copies drawn.
    Renderer renderer = renderer_of(shared_context(), soup, glm::dvec3(0),
                                    {.plan = {.site = ShadingSite::deferred}});
    Renderer of_all = renderer_of(shared_context(), soup, glm::dvec3(0),
                                  {.plan = {.specialise = false, .site = ShadingSite::deferred}});
    std::vector<std::uint32_t> order(static_cast<std::size_t>(copies));
    std::iota(order.begin(), order.end(), 0u);
    Faces first[4];
    double ours = 0, naive = 0;
    for (int run = 0; run < 100; ++run) {
      renderer.draw({camera});
      of_all.draw({camera});
      for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[random.below(std::uint32_t(i))]);
      const Faces frame[4] = {faces_of(renderer), faces_of(of_all), faces_of_trainer(soup, camera),
                              last_of_equals(corners, camera, order)};
      if (run == 0) std::copy(std::begin(frame), std::end(frame), first);
      for (std::size_t i = 0; i < 4; ++i)
        (i < 3 ? ours : naive) +=
            differing(i < 2 ? on_grid : exact, frame[i]) + differing(first[i], frame[i]);
    }
    recorder.add({.at = double(copies), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

}  // namespace geometry_test
}  // namespace tureen::test
