// What is measured of splats besides their colour, against values computed in double precision from
// the oracle's splats: the point under a pixel, the values of debug views, and their colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

#include "base/error.hpp"
#include "oracle/oracle.hpp"
#include "oracle/splat_kernels.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/renderer.hpp"
#include "scene/clip_range.hpp"
#include "scene/middle_bounds.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/made_once.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace splat_measures_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Splats, a mirrored and smaller layer of windows, and a soup among them.
Scene mixed_scene(const SplatKind& kind, std::size_t count = 1500) {
  Scene scene = scene_of(random_splats(kind, count, 0.15, 2));
  glm::dmat4 place(0.8);
  place[3] = glm::dvec4(0.3, -0.2, 0.1, 1);
  std::swap(place[0], place[1]);
  scene.layers.push_back(
      {.world_from_layer = place, .primitives = random_splats(splat_kinds[0], count / 3, 0.15, 3)});
  scene.layers.push_back({.primitives = random_soup(4, {.faces = 60})});
  return scene;
}

OracleImage oracle_image(const Scene& scene, const Camera& camera) {
  OracleOptions options;
  options.rays.coverage = oracle::Coverage::snapped;
  options.splat_stop = false;  // the device blends every splat
  return render_oracle(scene, {camera}, options);
}

// -- the expected values ------------------------------------------------------------------------

/// A splat of the scene in the order of blending.
struct Ordered {
  double depth;
  std::size_t layer, index;
  const Splats* splats;
  const oracle::SplatView* view;
  std::optional<oracle::SplatInView> in_view;
};

/// The normal of a surface of splat `i` towards the eye, in layer coordinates.
glm::dvec3 normal_in_layer(const Splats& splats, std::size_t i, const glm::dvec3& eye,
                           const glm::dvec3& ray) {
  // Splats without an opacity are solid ellipsoids.
  if (!tureen::opacity_of(splats.kernel)) {
    const SplatEllipsoid ellipsoid = *ellipsoid_of(splats.kernel, i);
    const glm::dmat3 rotation = glm::mat3_cast(ellipsoid.rotation);
    const glm::dvec3& axes = ellipsoid.axes;
    const auto in_sphere = [&](const glm::dvec3& v) { return glm::transpose(rotation) * v / axes; };
    const glm::dvec3 from = in_sphere(eye - ellipsoid.center);
    const glm::dvec3 along = in_sphere(ray);
    const double a = glm::dot(along, along), b = glm::dot(from, along);
    const double t = (-b - std::sqrt(b * b - a * (glm::dot(from, from) - 1))) / a;
    return glm::normalize(rotation * ((from + t * along) / axes));
  }
  glm::dvec3 normal;
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
    const glm::vec3* corners = &windows->corners[3 * i];
    const glm::dvec3 first(corners[0]);
    normal =
        glm::normalize(glm::cross(glm::dvec3(corners[1]) - first, glm::dvec3(corners[2]) - first));
  } else {
    const auto& gaussians = std::get<Gaussians>(splats.kernel);
    glm::vec3 scales = gaussians.scales[i];
    if (gaussians.flat) scales.z = 0;
    const auto thinnest = std::min_element(&scales[0], &scales[0] + 3) - &scales[0];
    normal = glm::mat3_cast(glm::dquat(gaussians.rotations[i]))[int(thinnest)];
  }
  return glm::dot(normal, center(splats, i) - eye) > 0 ? -normal : normal;
}

double opacity_of(const Ordered& splat) {
  if (const auto* ewa = std::get_if<oracle::EwaInView>(&*splat.in_view)) return ewa->opacity();
  const std::vector<float>* opacity = tureen::opacity_of(splat.splats->kernel);
  return opacity ? double((*opacity)[splat.index]) : 0;
}

double sigma_of(const Ordered& splat) {
  const auto* windows = std::get_if<TriangleWindows>(&splat.splats->kernel);
  return windows ? double(windows->sigma[splat.index]) : 0;
}

/// What is expected at a pixel. Sums are those over the splats alone.
struct Measured {
  double alpha = 0, depth_sum = 0, opacity_sum = 0, sigma_sum = 0, median_depth = infinity;
  glm::dvec3 normal_sum{0.0};
  int count = 0, contributions = 0, first = -1;
};

class Expected {
 public:
  Expected(const Scene& scene, const Camera& camera) : scene_(scene), camera_(camera) {
    std::vector<LayerPlace> boxes;
    for (const Layer& layer : scene.layers)
      boxes.push_back({bounds(layer), layer.world_from_layer});
    const double near = clip_range(boxes, camera, DepthStorage::reversed_float).near;
    views_.reserve(scene.layers.size());
    for (std::size_t l = 0; l < scene.layers.size(); ++l) {
      const auto* splats = std::get_if<Splats>(&scene.layers[l].primitives);
      views_.emplace_back(scene.layers[l].world_from_layer, camera, near);
      if (!splats) continue;
      for (const std::uint32_t i : make_splat_plan(*splats).drawn)
        order_.push_back({views_[l].point(center(*splats, i)).z, l, i, splats, &views_[l],
                          oracle::project(*splats, i, views_[l])});
    }
    std::sort(order_.begin(), order_.end(), [](const Ordered& a, const Ordered& b) {
      return std::tie(a.depth, a.layer, a.index) < std::tie(b.depth, b.layer, b.index);
    });
  }

  Measured at(int column, int row, double opaque_depth) const {
    Measured result;
    const glm::dvec2 pixel(column + 0.5, row + 0.5);
    double through = 1;
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const Ordered& each = order_[place];
      if (!each.in_view) continue;
      const oracle::ImageBox& box = oracle::box_of(*each.in_view);
      if (pixel.x < box.low.x - 1 || pixel.y < box.low.y - 1 || pixel.x > box.high.x + 1 ||
          pixel.y > box.high.y + 1)
        continue;
      const oracle::SplatSample there = oracle::sample(*each.in_view, pixel, opaque_depth);
      if (!(there.alpha > 0)) continue;
      const double weight = through * there.alpha, next = through - weight;
      const glm::dmat3 linear(scene_.layers[each.layer].world_from_layer);
      const glm::dvec3 normal =
          normal_in_layer(*each.splats, each.index, each.view->eye(),
                          each.view->direction_in_layer(each.view->ray(pixel)));
      result.depth_sum += weight * there.depth;
      result.opacity_sum += weight * opacity_of(each);
      result.sigma_sum += weight * sigma_of(each);
      result.normal_sum += weight * glm::normalize(linear * normal);
      if (through > 0.5 && next <= 0.5) result.median_depth = there.depth;
      if (result.first < 0) result.first = int(place);
      ++result.count;
      if (next >= 1e-4) ++result.contributions;
      through = next;
    }
    result.alpha = 1 - through;
    return result;
  }

 private:
  const Scene& scene_;
  const Camera& camera_;
  std::vector<oracle::SplatView> views_;
  std::vector<Ordered> order_;
};

/// The normal of the soup's face towards the eye, in world coordinates.
glm::dvec3 face_normal(const Scene& scene, const OracleImage& image, std::size_t pixel,
                       const glm::dvec3& eye) {
  const Layer& layer = scene.layers[image.layer[pixel]];
  const auto& soup = std::get<TriangleSoup>(layer.primitives);
  glm::dvec3 corners[3];
  for (int k = 0; k < 3; ++k)
    corners[k] = glm::dvec3(
        layer.world_from_layer *
        glm::dvec4(glm::dvec3(soup.positions[soup.triangles[image.face[pixel]][k]]), 1.0));
  const glm::dvec3 normal =
      glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  return glm::dot(normal, corners[0] - eye) > 0 ? -normal : normal;
}

// -- comparisons --------------------------------------------------------------------------------

class MeasuredSplats : public testing::TestWithParam<InContext<SplatKind>> {
 protected:
  gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  SplatKind kind = std::get<1>(GetParam());
};

class PickedSplats : public MeasuredSplats {};

TEST_P(PickedSplats, HaveTheirMedianDepth) {
  const Scene scene = mixed_scene(kind);
  Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities())));
  int compared = 0, off = 0, on_splats = 0;
  for (const double distance : {3.0, 0.5}) {
    const Camera camera = camera_of_ball(distance, 80, 60);
    const OracleImage& expected = made_once(std::pair(std::string(kind.name), distance),
                                            [&] { return oracle_image(scene, camera); });
    renderer.draw({camera});
    for (int row = 1; row < camera.height; row += 13)
      for (int column = 2; column < camera.width; column += 19) {
        const std::size_t i = std::size_t(row) * std::size_t(camera.width) + std::size_t(column);
        const auto point = renderer.point_at({column + 0.5, row + 0.5});
        const double depth = std::min(expected.splat_depth[i], expected.depth[i]);
        ++compared;
        if (!point || !std::isfinite(depth)) {
          off += point.has_value() != std::isfinite(depth);
          continue;
        }
        on_splats += depth == expected.splat_depth[i];
        const double picked = glm::dot(*point - camera.eye(), forward_of(camera));
        // Floats near planes seen edge-on; the depth buffer has 24 bits in some contexts.
        off += std::abs(picked - depth) > 1e-4 * depth;
      }
  }
  EXPECT_GT(on_splats, compared / 3);
  // None was off of 162 per kind and context. The bound allows one where the transmittance is 1/2
  // but for rounding.
  EXPECT_LE(off, 1);
}

/// A scene with its debug views on a device.
struct Shown {
  Shown(const gl::Context& context, const Scene& scene, const RenderOptions& options = {})
      : views(placed_layers(scene)),
        renderer(context,
                 prepare_debug_views(placed_layers(scene), device_limits(context.capabilities())),
                 options) {}
  std::vector<glm::vec4> measure(DebugView what, const Camera& camera) {
    views.measure(renderer, what);
    renderer.draw({camera});
    return views.read_values();
  }
  DebugViews views;
  Renderer renderer;
};

/// The expected value of a view, or nullopt where nothing is visible.
using Value = std::function<std::optional<glm::dvec3>(const Measured&, std::size_t pixel)>;

/// The oracle's image of a scene, and what is expected at its pixels.
struct Truth {
  Truth(const Scene& scene, const Camera& camera) : image(oracle_image(scene, camera)) {
    const Expected expected(scene, camera);
    for (int row = 0; row < camera.height; ++row)
      for (int column = 0; column < camera.width; ++column)
        pixels.push_back(expected.at(column, row, image.depth[pixels.size()]));
  }
  OracleImage image;
  std::vector<Measured> pixels;
};

/// Measures a scene on a device, and compares with the expected values. No other scene may have its
/// name.
class Comparison {
 public:
  Comparison(const gl::Context& context, const Scene& scene, const std::string& name)
      : scene_(scene),
        truth_(made_once(name, [&] { return Truth(scene, camera_); })),
        shown_(context, scene) {}

  bool solid(std::size_t i) const { return image_.face[i] != no_face; }
  bool there(const Measured& m, std::size_t i) const { return m.count > 0 || solid(i); }
  /// The weight of the soup.
  double through(const Measured& m, std::size_t i) const { return solid(i) ? 1 - m.alpha : 0.0; }
  glm::dvec3 soup_normal(std::size_t i) const {
    return solid(i) ? face_normal(scene_, image_, i, camera_.eye()) : glm::dvec3(0);
  }
  const OracleImage& image() const { return image_; }
  /// In dB, over the pixels with splats. Without a stop at a small transmittance, it is about 110.
  double alpha_psnr() {
    const std::vector<glm::vec4> actual = shown_.measure(DebugView::alpha, camera_);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      if (image_.splat_alpha[i] == 0) continue;
      sum += std::pow(double(actual[i].x) - image_.splat_alpha[i], 2);
      ++count;
    }
    return -10 * std::log10(sum / count);
  }

  /// Expects errors relative to the value of at most `tolerance` for 99 % of the pixels.
  void expect(DebugView what, double tolerance, const Value& value) {
    const std::vector<glm::vec4> actual = shown_.measure(what, camera_);
    ASSERT_EQ(actual.size(), pixels_.size());
    std::vector<double> errors;
    std::size_t only_one = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      const auto wanted = value(pixels_[i], i);
      if (wanted.has_value() != (actual[i].w > 0))
        ++only_one;
      else if (wanted)
        errors.push_back(glm::length(glm::dvec3(actual[i]) - *wanted) /
                         std::max(glm::length(*wanted), 1e-9));
    }
    // The edge of a soup, and of a splat at min_alpha, may fall on either side of a pixel's centre.
    EXPECT_LE(only_one, pixels_.size() / 300) << name_of(what);
    ASSERT_GT(errors.size(), pixels_.size() / 3) << name_of(what);
    std::sort(errors.begin(), errors.end());
    const std::size_t last = errors.size() - 1;
    EXPECT_LE(errors[last * 99 / 100], tolerance) << name_of(what);
  }

 private:
  const Scene& scene_;
  Camera camera_ = camera_of_ball(2.5, 64, 48);
  const Truth& truth_;
  const OracleImage& image_ = truth_.image;
  const std::vector<Measured>& pixels_ = truth_.pixels;
  Shown shown_;
};

std::optional<glm::dvec3> when(bool there, double value) {
  return there ? std::optional(glm::dvec3(value)) : std::nullopt;
}

// Tolerances: sums of floats and splats seen edge-on. The largest 99th percentile of any kind is
// 1.3e-6 for depths, 9e-6 for normals and sigma, 2e-5 for alpha. Counts and places are exact,
// except where a splat's alpha is min_alpha but for rounding.
TEST_P(MeasuredSplats, HaveTheExpectedValuesAmongSoups) {
  const Scene scene = mixed_scene(kind, 600);
  Comparison compared(context, scene, std::string("among soups, ") + kind.name);
  const OracleImage& image = compared.image();
  compared.expect(DebugView::depth, 1e-4, [&](const Measured& m, std::size_t i) {
    const double through = compared.through(m, i);
    const double behind = through > 0 ? through * image.depth[i] : 0.0;
    return when(compared.there(m, i), (m.depth_sum + behind) / (m.alpha + through));
  });
  compared.expect(DebugView::median_depth, 1e-4, [&](const Measured& m, std::size_t i) {
    const double depth = std::min(m.median_depth, image.depth[i]);
    return when(std::isfinite(depth), depth);
  });
  compared.expect(DebugView::normals, 1e-3, [&](const Measured& m, std::size_t i) {
    const glm::dvec3 sum = m.normal_sum + compared.through(m, i) * compared.soup_normal(i);
    return compared.there(m, i) ? std::optional(glm::normalize(sum)) : std::nullopt;
  });
  compared.expect(DebugView::alpha, 1e-4, [&](const Measured& m, std::size_t i) {
    return when(compared.there(m, i), compared.solid(i) ? 1.0 : m.alpha);
  });
}

TEST_P(MeasuredSplats, HaveTheExpectedValuesAlone) {
  const Scene scene = scene_of(random_splats(kind, 1500, 0.15, 2));
  Comparison compared(context, scene, std::string("alone, ") + kind.name);
  compared.expect(DebugView::alpha, 1e-4, [&](const Measured& m, std::size_t i) {
    EXPECT_NEAR(m.alpha, compared.image().splat_alpha[i], 1e-12);
    return when(m.count > 0, m.alpha);
  });
  EXPECT_GE(compared.alpha_psnr(), 75);
  compared.expect(DebugView::overdraw, 0,
                  [&](const Measured& m, std::size_t) { return when(m.count > 0, m.count); });
  compared.expect(DebugView::contributions, 0, [&](const Measured& m, std::size_t) {
    return when(m.count > 0, m.contributions);
  });
  compared.expect(DebugView::order, 0,
                  [&](const Measured& m, std::size_t) { return when(m.count > 0, m.first); });
  if (tureen::opacity_of(std::get<Splats>(scene.layers[0].primitives).kernel))
    compared.expect(DebugView::opacity, 1e-4, [&](const Measured& m, std::size_t) {
      return when(m.count > 0, m.opacity_sum / m.alpha);
    });
  if (kind.kernel == SplatKind::Kernel::windows)
    compared.expect(DebugView::sigma, 1e-4, [&](const Measured& m, std::size_t) {
      return when(m.count > 0, m.sigma_sum / m.alpha);
    });
}

INSTANTIATE_TEST_SUITE_P(, MeasuredSplats, in_contexts(splat_kinds), name_in_context);
// The views of MeasuredSplats show the same depths in the other contexts.
INSTANTIATE_TEST_SUITE_P(, PickedSplats,
                         testing::Combine(in_osmesa(), testing::ValuesIn(splat_kinds)),
                         name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, PickedSplats,
                         testing::Combine(in_the_others(), testing::ValuesIn(splat_kinds)),
                         name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, MeasuredSplats, in_other_contexts(splat_kinds), name_in_context);

// -- colours ------------------------------------------------------------------------------------

class ViewsOfSplats : public testing::TestWithParam<NamedContext> {
 protected:
  gl::Context context = gl::Context::create(GetParam().request);
};

/// Three Gaussians that cover the image, at depths of 9, 10 and 11 from (0, 0, 10).
Scene three_gaussians() {
  Gaussians gaussians;
  for (int i = 0; i < 3; ++i) {
    gaussians.centers.emplace_back(0, 0, 1 - i);
    gaussians.scales.emplace_back(1e4f, 1e4f, 1e-3f);  // facing the eye
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(i == 0 ? 0.25f : i == 1 ? 0.5f : 0.75f);
  }
  return scene_of(Splats{.kernel = std::move(gaussians),
                         .color = {.coefficients = std::vector<glm::vec3>(3)},
                         .profile = *profile_named("3dgs")});
}

TEST_P(ViewsOfSplats, HaveTheColoursOfTheirValues) {
  const Scene scene = three_gaussians();
  const Camera camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.1, 9, 9);
  Shown shown(context, scene, {.background = {0.2f, 0.3f, 0.4f, 1}});
  const DepthScale scale =
      depth_scale(middle_bounds(std::get<Splats>(scene.layers[0].primitives)), camera.eye());
  const auto expect = [&](DebugView what, const glm::vec3& color) {
    shown.views.show(shown.renderer, what);
    shown.renderer.draw({camera});
    const glm::u8vec4 pixel = shown.renderer.read_color().at(4, 4);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(double(pixel[c]), 255 * double(std::clamp(color[c], 0.0f, 1.0f)), 0.52)
          << name_of(what);
    EXPECT_EQ(pixel.a, 255);
  };
  const double weights[3] = {0.25, 0.75 * 0.5, 0.375 * 0.75};
  const double alpha = weights[0] + weights[1] + weights[2];
  const double depth = (9 * weights[0] + 10 * weights[1] + 11 * weights[2]) / alpha;
  const double opacity = (0.25 * weights[0] + 0.5 * weights[1] + 0.75 * weights[2]) / alpha;
  const auto of_depth = [&](double z) { return heat_ramp(float(1 - scale.position(z))); };
  expect(DebugView::depth, of_depth(depth));
  expect(DebugView::median_depth, of_depth(10));
  expect(DebugView::normals, {0.5f, 0.5f, 1});
  expect(DebugView::alpha, glm::vec3(float(alpha)));
  expect(DebugView::opacity, glm::vec3(float(opacity)));
  expect(DebugView::overdraw, overdraw_color(3));
  expect(DebugView::contributions, overdraw_color(3));
  expect(DebugView::order, heat_ramp(1));
  // The colour is 1/2 over the background.
  expect(DebugView::color,
         float(alpha) * glm::vec3(0.5f) + float(1 - alpha) * glm::vec3(0.2f, 0.3f, 0.4f));
}

/// Where there are no splats, the background.
TEST_P(ViewsOfSplats, KeepTheBackground) {
  const Scene scene = three_gaussians();
  const Camera away = look_at({0, 0, 10}, {0, 0, 20}, {0, 1, 0}, 0.1, 9, 9);
  Shown shown(context, scene, {.background = {0, 1, 0, 1}});
  for (const DebugViewName& name : debug_view_names()) {
    if (why_not(name.what, scene.layers[0].primitives)) continue;
    shown.views.show(shown.renderer, name.what);
    shown.renderer.draw({away});
    EXPECT_EQ(shown.renderer.read_color().at(4, 4), glm::u8vec4(0, 255, 0, 255)) << name.name;
  }
}

/// Soups have their colours in front of splats.
TEST_P(ViewsOfSplats, ShowSoupsInFront) {
  Scene scene = three_gaussians();
  TriangleSoup soup;
  soup.positions = {{-9, -9, 5}, {9, -9, 5}, {0, 18, 5}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1, 0.5f, 0, 1)}};
  scene.layers.push_back({.primitives = std::move(soup)});
  const Camera camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.1, 9, 9);
  Shown shown(context, scene);
  EXPECT_FLOAT_EQ(shown.measure(DebugView::depth, camera)[40].x, 5);
  EXPECT_FLOAT_EQ(shown.measure(DebugView::median_depth, camera)[40].x, 5);
  EXPECT_EQ(shown.measure(DebugView::alpha, camera)[40].x, 1);
  EXPECT_EQ(shown.measure(DebugView::overdraw, camera)[40].x, 1);
  EXPECT_EQ(shown.measure(DebugView::normals, camera)[40], glm::vec4(0, 0, 1, 1));
  shown.views.show(shown.renderer, DebugView::alpha);
  shown.renderer.draw({camera});
  EXPECT_EQ(shown.renderer.read_color().at(4, 4), glm::u8vec4(255));
  EXPECT_THROW(shown.views.require(DebugView::opacity), UsageError);
  EXPECT_THROW(shown.views.require(DebugView::wireframe), UsageError);
}

TEST_P(ViewsOfSplats, AQuarterOfTheSplatsIsAboutAQuarter) {
  const Scene scene = scene_of(random_splats(splat_kinds[1], 200, 0.005, 1));
  Shown shown(context, scene);
  const auto sum = [&](DebugView what) {
    shown.views.show(shown.renderer, what);
    shown.renderer.draw({camera_of_ball(3, 160, 120)});
    double total = 0;
    for (const glm::u8vec4& pixel : shown.renderer.read_color().pixels)
      total += pixel.r + pixel.g + pixel.b;
    return total;
  };
  // Few of these splats overlap. The share has a standard deviation of 0.03.
  EXPECT_NEAR(sum(DebugView::quarter) / sum(DebugView::color), shown_fraction, 0.12);
}

INSTANTIATE_TEST_SUITE_P(, ViewsOfSplats, testing::ValuesIn(every_context),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(DebugViewsOfSplats, AreRefusedWithAReason) {
  for (const SplatKind& kind : splat_kinds) {
    const Splats splats = random_splats(kind, 3, 0.1, 1);
    const bool windows = kind.kernel == SplatKind::Kernel::windows;
    EXPECT_EQ(why_not(DebugView::sigma, splats).has_value(), !windows) << kind.name;
    EXPECT_EQ(why_not(DebugView::opacity, splats).has_value(), !tureen::opacity_of(splats.kernel))
        << kind.name;
    EXPECT_TRUE(why_not(DebugView::triangle_id, splats));
    EXPECT_FALSE(why_not(DebugView::median_depth, splats));
  }
}

}  // namespace splat_measures_test
}  // namespace tureen::test
