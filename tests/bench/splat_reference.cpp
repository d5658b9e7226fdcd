// splat_reference SCENE OUT: the image of a layer of Gaussians in double precision, by the rules of
// 3DGS or with the deviations of web viewers. `./dev bench viewers` compares their images with it.
//
// OUT: for each pixel, row by row from the top, four floats: red, green, blue over black, and the
// transmittance.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/output.hpp"
#include "formats/scene_file.hpp"
#include "oracle/splat_kernels.hpp"
#include "tests/bench/run_program.hpp"

namespace tureen::test {
namespace {

struct Rules {
  bool quarter_dilation = false;
  bool mip = false;
  bool radial = false;
  bool renormalised = false;
  bool clamp_colors = false;
  double cut = std::numeric_limits<double>::infinity();
  double min_alpha = 1.0 / 255;
  double max_alpha = 0.99;
  double min_width = 0;
};

struct View {
  std::vector<double> eye, target, up;
  double fov = 50;
  int width = 1280, height = 720;
};

/// A Gaussian in the image: its centre in pixels, its variances in px^2, and the unit vector along
/// the larger one.
struct Ellipse {
  glm::dvec2 center;
  glm::dvec2 major;
  double largest, smallest;

  double squared_distance(const glm::dvec2& pixel) const {
    const glm::dvec2 d = pixel - center;
    const double u = glm::dot(d, major), v = d.y * major.x - d.x * major.y;
    return u * u / largest + v * v / smallest;
  }
};

/// `scale`: pixels of the oracle's image per pixel of ours. nullopt: `rules` drop the splat.
std::optional<Ellipse> ellipse_of(const oracle::EwaInView& splat, int scale, const Rules& rules) {
  // The quadratic form, from its values; its inverse is the covariance.
  const double a = splat.squared_distance(splat.center() + glm::dvec2(1, 0));
  const double c = splat.squared_distance(splat.center() + glm::dvec2(0, 1));
  const double b = 0.5 * (splat.squared_distance(splat.center() + glm::dvec2(1, 1)) - a - c);
  const double det = (a * c - b * b) * scale * scale;
  const double xx = c / det, xy = -b / det, yy = a / det;
  const double mean = 0.5 * (xx + yy);
  const double difference = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
  const Ellipse ellipse{.center = splat.center() / double(scale),
                        // Half the angle of the deviation (2 xy, xx - yy).
                        .major = glm::dvec2(std::cos(0.5 * std::atan2(2 * xy, xx - yy)),
                                            std::sin(0.5 * std::atan2(2 * xy, xx - yy))),
                        .largest = mean + difference,
                        .smallest = mean - difference};
  if (!(ellipse.smallest > 0) || 2 * std::sqrt(2 * ellipse.largest) < rules.min_width) return {};
  return ellipse;
}

/// The kernel at squared distance `q`, or 0 beyond the cut.
double kernel(double q, const Rules& rules) {
  if (q > rules.cut) return 0;
  if (!rules.renormalised) return std::exp(-0.5 * q);
  const double at_cut = std::exp(-0.5 * rules.cut);
  return (std::exp(-0.5 * q) - at_cut) / (1 - at_cut);
}

std::vector<float> draw(const Layer& layer, const View& view, const Rules& rules) {
  const Splats& splats = std::get<Splats>(layer.primitives);
  const auto& gaussians = std::get<Gaussians>(splats.kernel);
  SplatProfile profile = *profile_named(rules.mip ? "mip" : "3dgs");
  profile.min_alpha = float(rules.min_alpha);
  // The oracle adds 0.3 px^2: at twice the resolution, that is a quarter of it.
  const int scale = rules.quarter_dilation ? 2 : 1;
  const auto vector = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  const Camera camera = look_at(vector(view.eye), vector(view.target), vector(view.up),
                                glm::radians(view.fov), scale * view.width, scale * view.height);
  const oracle::SplatView in_layer(layer.world_from_layer, camera, published_center_depth);

  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < count(splats); ++i) {
    const glm::dvec3 center = in_layer.point(gaussians.centers[i]);
    order.emplace_back(rules.radial ? glm::length(center) : center.z, i);
  }
  std::sort(order.begin(), order.end());

  const std::size_t pixels = std::size_t(view.width) * view.height;
  std::vector<glm::dvec4> image(pixels, glm::dvec4(0, 0, 0, 1));
  std::vector<bool> ended(pixels);
  for (const auto& [key, i] : order) {
    const auto splat = oracle::EwaInView::project(gaussians, i, profile, in_layer);
    if (!splat) continue;
    const auto ellipse = ellipse_of(*splat, scale, rules);
    if (!ellipse) continue;
    glm::dvec3 color = oracle::SplatColorInView(splats, i, in_layer.eye()).at(*splat, {});
    if (rules.clamp_colors) color = glm::min(color, 1.0);
    const double last = std::min(rules.cut, 2 * std::log(splat->opacity() / rules.min_alpha));
    const double radius = std::sqrt(last * ellipse->largest) + 1;
    const glm::dvec2 low = ellipse->center - radius, high = ellipse->center + radius;
    const int first_row = int(std::clamp(low.y, 0.0, double(view.height)));
    const int end_row = int(std::clamp(high.y + 1, 0.0, double(view.height)));
    const int first_column = int(std::clamp(low.x, 0.0, double(view.width)));
    const int end_column = int(std::clamp(high.x + 1, 0.0, double(view.width)));
    for (int row = first_row; row < end_row; ++row)
      for (int column = first_column; column < end_column; ++column) {
        const std::size_t at = std::size_t(row) * view.width + column;
        const double q = ellipse->squared_distance({column + 0.5, row + 0.5});
        const double alpha = std::min(rules.max_alpha, splat->opacity() * kernel(q, rules));
        if (ended[at] || alpha < rules.min_alpha) continue;
        const double next = image[at].a * (1 - alpha);
        if (next < double(profile.stop_transmittance)) {
          ended[at] = true;
          continue;
        }
        image[at] = glm::dvec4(glm::dvec3(image[at]) + image[at].a * alpha * color, next);
      }
  }
  std::vector<float> floats;
  for (const glm::dvec4& pixel : image)
    for (int channel = 0; channel < 4; ++channel) floats.push_back(float(pixel[channel]));
  return floats;
}

int run(int argc, char** argv) {
  CLI::App app("Draws Gaussians in double precision, by the rules of 3DGS or of web viewers.");
  std::string in, out;
  View view;
  Rules rules;
  app.add_option("SCENE", in, "scene with one layer of Gaussians")->required();
  app.add_option("OUT", out, "file to write: four floats a pixel")->required();
  app.add_option("--eye", view.eye)->required()->expected(3)->delimiter(',');
  app.add_option("--target", view.target)->required()->expected(3)->delimiter(',');
  app.add_option("--up", view.up)->required()->expected(3)->delimiter(',');
  app.add_option("--fov", view.fov, "vertical angle in degrees");
  app.add_option("--width", view.width);
  app.add_option("--height", view.height);
  app.add_flag("--quarter-dilation", rules.quarter_dilation, "add 0.075 px^2, not 0.3");
  app.add_flag("--mip", rules.mip, "lower the opacity, so that it keeps its integral");
  app.add_flag("--radial", rules.radial, "order by the distance from the eye");
  app.add_flag("--renormalised", rules.renormalised, "subtract the kernel's value at the cut");
  app.add_flag("--clamp-colors", rules.clamp_colors, "limit the colours of splats to 1");
  app.add_option("--cut", rules.cut, "largest squared distance in standard deviations");
  app.add_option("--min-alpha", rules.min_alpha, "smaller values are not blended");
  app.add_option("--max-alpha", rules.max_alpha, "larger values are clamped");
  app.add_option("--min-width", rules.min_width,
                 "drop splats if 2 sqrt(2 v) is smaller, where v is the larger variance in px^2");
  CLI11_PARSE(app, argc, argv);

  const Scene scene = read_scene(in);
  const Layer& layer = only_layer(scene);
  const auto* splats = std::get_if<Splats>(&layer.primitives);
  if (!splats || !std::get_if<Gaussians>(&splats->kernel))
    throw UsageError(in + " has no Gaussians");
  const std::vector<float> image = draw(layer, view, rules);
  write_file(out, std::as_bytes(std::span(image)));
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("splat_reference", tureen::test::run, argc, argv);
}
