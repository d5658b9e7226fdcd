#include "examples/still_life.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "examples/noise.hpp"
#include "examples/paints.hpp"
#include "examples/shapes.hpp"

namespace tureen::example {
namespace {

using std::numbers::pi;
constexpr int segments = 96;  // around surfaces of revolution, except small ones

/// Makes porcelain oval: wider from handle to handle.
const glm::dmat3 oval(1.14, 0, 0, 0, 1, 0, 0, 0, 1);

Curve profile(std::initializer_list<glm::dvec2> points) {
  std::vector<glm::dvec3> at;
  for (const glm::dvec2& p : points) at.emplace_back(p, 0.0);
  return Curve(std::move(at));
}

struct Vessel {
  double widest;  // radius at the pattern
  int rows;
  int columns = segments;
};

void add_porcelain(Model& model, const Curve& curve, Vessel vessel,
                   Paint (*paint)(glm::dvec2, Turned)) {
  const Turned measure{curve.length(), 2 * pi * vessel.widest * 1.07};
  model.add({.position = turned(curve, {.center = {0, 0, 0}, .frame = oval}),
             .paint = [=](const SurfacePoint& at) { return paint(at.uv, measure); },
             .columns = vessel.columns,
             .rows = vessel.rows,
             .closed = true});
}

void add_table(Model& model) {
  const double r = table_radius;
  model.add({.position = disc(r - 0.05, {}),
             .paint = [](const SurfacePoint& at) { return wood(at.position); },
             .columns = segments / 4,
             .rows = segments / 4});
  // The rim begins slightly below the top, so that the two overlap without a gap.
  model.add({.position = turned(profile({{r - 0.14, -0.17},
                                         {r - 0.06, -0.165},
                                         {r - 0.005, -0.125},
                                         {r, -0.075},
                                         {r - 0.012, -0.025},
                                         {r - 0.052, -0.0006}}),
                                {}),
             .paint =
                 [](const SurfacePoint& at) {
                   Paint paint = wood(at.position);
                   paint.albedo *= 0.9;
                   return paint;
                 },
             .columns = segments,
             .rows = 3,
             .closed = true});
  // Visible only from below.
  model.add({.position = turned(profile({{0.0, -0.17}, {r - 0.139, -0.17}}), {}),
             .paint = [](const SurfacePoint& at) { return wood(at.position); },
             .columns = segments,
             .rows = 1,
             .closed = true});
}

void add_doily(Model& model) {
  const double inner = 1.15, outer = 1.66;
  const Turned measure{outer - inner, 2 * pi * outer * 1.07};
  // The height above the wood is sufficient for a depth buffer, but not visible.
  model.add({.position = ring(inner, outer, {.center = {0, 0.012, 0}, .frame = oval}),
             .paint = [=](const SurfacePoint& at) { return lace(at.uv, measure); },
             .columns = 48,
             .rows = 2,
             .closed = true,
             .cut_out = true});
}

void add_tureen(Model& model) {
  add_porcelain(model,
                profile({{0.55, 0.022},
                         {0.86, 0.05},
                         {1.15, 0.11},
                         {1.36, 0.185},
                         {1.385, 0.208},
                         {1.36, 0.222},
                         {1.15, 0.150},
                         {0.86, 0.088},
                         {0.40, 0.075}}),
                {.widest = 1.36, .rows = 9}, platter);
  add_porcelain(
      model,
      profile(
          {{0.66, 0.075}, {0.675, 0.10}, {0.62, 0.15}, {0.49, 0.22}, {0.445, 0.29}, {0.50, 0.35}}),
      {.widest = 0.6, .rows = 5}, tureen_foot);
  add_porcelain(model,
                profile({{0.42, 0.315},
                         {0.62, 0.375},
                         {0.84, 0.50},
                         {0.985, 0.69},
                         {1.02, 0.90},
                         {0.975, 1.10},
                         {0.935, 1.21},
                         {0.965, 1.285},
                         {0.985, 1.315}}),
                {.widest = 1.0, .rows = 12}, tureen_body);
  add_porcelain(model,
                profile({{0.965, 1.290},
                         {1.005, 1.325},
                         {0.985, 1.365},
                         {0.88, 1.45},
                         {0.70, 1.565},
                         {0.47, 1.665},
                         {0.24, 1.725},
                         {0.10, 1.75}}),
                {.widest = 0.97, .rows = 8}, tureen_lid);
  add_porcelain(model,
                profile({{0.17, 1.735},
                         {0.105, 1.765},
                         {0.075, 1.81},
                         {0.12, 1.865},
                         {0.185, 1.93},
                         {0.185, 2.01},
                         {0.11, 2.075},
                         {0.0, 2.098}}),
                {.widest = 0.18, .rows = 9, .columns = 18}, tureen_knob);
  for (const double side : {-1.0, 1.0}) {
    // A handle: out from the body, up, and back into it.
    const Curve ear({glm::dvec3(side * 1.02, 0.70, 0), glm::dvec3(side * 1.24, 0.71, 0),
                     glm::dvec3(side * 1.47, 0.86, 0), glm::dvec3(side * 1.50, 1.08, 0),
                     glm::dvec3(side * 1.34, 1.20, 0), glm::dvec3(side * 1.17, 1.13, 0),
                     glm::dvec3(side * 1.02, 1.08, 0)});
    model.add(
        {.position =
             tube(ear, [](double v) { return 0.055 + 0.035 * std::pow(std::abs(2 * v - 1), 3.0); }),
         .paint = [](const SurfacePoint& at) { return tureen_handle(at.uv); },
         .columns = 9,
         .rows = 16,
         .closed = true});
  }
}

void add_lemon(Model& model, glm::dvec3 center, glm::dvec3 axis) {
  const Curve skin = profile({{0.0, -0.375},
                              {0.052, -0.36},
                              {0.085, -0.315},
                              {0.175, -0.235},
                              {0.245, -0.10},
                              {0.255, 0.02},
                              {0.215, 0.165},
                              {0.125, 0.265},
                              {0.072, 0.32},
                              {0.045, 0.362},
                              {0.0, 0.375}});
  model.add({.position = turned(skin, {center, frame_along(axis)}),
             .paint = [](const SurfacePoint& at) { return lemon_skin(at.uv); },
             .columns = 18,
             .rows = 11,
             .closed = true});
}

/// `axis` is the normal of the cut, pointing outwards.
void add_half_lemon(Model& model, glm::dvec3 center, glm::dvec3 axis) {
  const Placement placement{center, frame_along(axis)};
  constexpr double radius = 0.262;
  model.add({.position = turned(profile({{0.0, -0.355},
                                         {0.05, -0.34},
                                         {0.085, -0.295},
                                         {0.175, -0.215},
                                         {0.24, -0.10},
                                         {radius - 0.003, 0.0}}),
                                placement),
             .paint =
                 [](const SurfacePoint& at) {
                   return lemon_skin({at.uv.x, at.uv.y * 0.5});
                 },
             .columns = 26,
             .rows = 6,
             .closed = true});
  model.add({.position = disc(radius, placement),
             .paint =
                 [](const SurfacePoint& at) {
                   const Shape unit = disc(1.0, {});
                   const glm::dvec3 p = unit(at.uv);
                   return lemon_flesh({p.x, p.z});
                 },
             .columns = 8,
             .rows = 8});
}

void add_leaf(Model& model, glm::dvec3 root, glm::dvec3 direction, double length, double droop,
              std::uint64_t seed) {
  const glm::dvec2 size(0.46 * length, length);
  const glm::dvec3 lift(0, 1, 0);
  const Curve middle({root, root + direction * (0.35 * length) + lift * (0.05 * length),
                      root + direction * (0.7 * length) + lift * (0.03 * length - 0.35 * droop),
                      root + direction * length - lift * droop});
  model.add({.position = strip(middle, size.x, 0.28),
             .paint = [=](const SurfacePoint& at) { return leaf(at.uv, size, seed); },
             .columns = 2,
             .rows = 4,
             .cut_out = true,
             .translucency = 0.35});
}

void add_blossom(Model& model, glm::dvec3 center, double radius, double turn) {
  for (int i = 0; i < 5; ++i) {
    const double angle = turn + 2 * pi * i / 5;
    const glm::dvec3 out(std::cos(angle), 0, std::sin(angle));
    const glm::dvec2 size(0.78 * radius, radius);
    // Petals overlap: each is slightly higher than its neighbour.
    const glm::dvec3 root = center + out * 0.008 + glm::dvec3(0, 0.004 * i, 0);
    const Curve middle({root, root + out * (0.45 * radius) + glm::dvec3(0, 0.30 * radius, 0),
                        root + out * radius + glm::dvec3(0, 0.34 * radius, 0)});
    model.add({.position = strip(middle, size.x, 0.25),
               .paint = [=](const SurfacePoint& at) { return petal(at.uv, size); },
               .columns = 2,
               .rows = 2,
               .cut_out = true,
               .translucency = 0.5});
  }
  model.add({.position = turned(profile({{0.035, 0.0}, {0.036, 0.035}, {0.022, 0.062}, {0, 0.07}}),
                                {.center = center}),
             .paint = [](const SurfacePoint&) { return blossom_heart(); },
             .columns = 8,
             .rows = 3,
             .closed = true});
}

/// A twig along `points` with leaves on both sides, larger in the middle, and one at its end.
void add_branch(Model& model, std::vector<glm::dvec3> points, int leaves, std::uint64_t seed) {
  const Curve twig(std::move(points));
  Random random(seed);
  model.add({.position = tube(twig, [](double v) { return 0.026 - 0.015 * v; }),
             .paint = [](const SurfacePoint& at) { return bark(at.uv); },
             .columns = 5,
             .rows = 9,
             .closed = true});
  for (int i = 0; i < leaves; ++i) {
    const double t = 0.12 + 0.86 * i / (leaves - 1);
    const bool last = i == leaves - 1;
    const double side = i % 2 == 0 ? 1 : -1;
    const glm::dvec3 forward = twig.tangent(t);
    const glm::dvec3 across = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    const double turn = last ? 0.05 : random.uniform(0.75, 1.05);
    glm::dvec3 direction = std::cos(turn) * forward + side * std::sin(turn) * across;
    direction.y = random.uniform(0.02, 0.30);
    const double length = (0.40 + 0.16 * std::sin(pi * t)) * random.uniform(0.9, 1.1);
    const glm::dvec3 root = twig.at(t);
    // The tip hangs down, but stays above the table.
    const double highest = root.y + direction.y * length;
    const double droop = std::min(random.uniform(0.05, 0.22), highest - 0.045);
    add_leaf(model, root, direction, length, droop, mixed(seed + i));
  }
}

}  // namespace

Model still_life() {
  Model model;
  add_table(model);
  add_doily(model);
  add_tureen(model);
  add_lemon(model, {1.32, 0.250, 1.36}, {0.9, 0.10, 0.35});
  add_lemon(model, {-1.55, 0.250, -1.05}, {0.3, 0.05, 0.9});
  add_half_lemon(model, {0.80, 0.245, 1.72}, {-0.25, 0.42, 0.87});
  add_branch(model,
             {{-1.98, 0.05, 0.55}, {-1.62, 0.16, 1.02}, {-1.12, 0.17, 1.50}, {-0.45, 0.10, 1.88}},
             11, 3);
  add_branch(model, {{1.78, 0.10, 1.08}, {1.93, 0.13, 0.72}, {2.02, 0.10, 0.25}}, 6, 12);
  add_branch(model, {{-1.35, 0.08, -1.42}, {-0.9, 0.14, -1.75}, {-0.30, 0.09, -1.95}}, 7, 5);
  add_blossom(model, {-1.28, 0.20, 1.36}, 0.17, 0.3);
  add_blossom(model, {-1.02, 0.16, 1.66}, 0.14, 1.1);
  return model;
}

}  // namespace tureen::example
