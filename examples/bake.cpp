#include "bake.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <tuple>

#include "glaze.hpp"
#include "light.hpp"
#include "noise.hpp"
#include "ray_caster.hpp"
#include "soup/lattice.hpp"
#include "training.hpp"

namespace tureen::example {
namespace {

/// What training needs to know about one glossy texel beyond its bytes.
struct GlossyTexel {
  std::uint32_t texel;
  glm::dvec3 diffuse, normal;
};

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

struct LitTexels {
  LatticeTexture texture;
  std::vector<GlossyTexel> glossy;
};

LitTexels light_texels(const Model& model, const BakeOptions& options) {
  const RayCaster caster(model);
  const Light light(model, caster);
  LitTexels lit;
  auto& texels = lit.texture.texels.emplace<std::vector<std::uint8_t>>();
  // Neighbouring faces share the points on their edges: lit once, they are the same to the bit.
  std::map<std::tuple<std::uint32_t, std::int64_t, std::int64_t>, glm::dvec3> known;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const Face& face = model.faces[f];
    const auto first = static_cast<std::uint32_t>(texels.size() / LatticeTexture::channels);
    lit.texture.patches.push_back({first, static_cast<std::uint32_t>(face.level)});
    for (std::uint32_t i = 0; i < lattice::texel_count(face.level); ++i) {
      const auto [x, y] = lattice::texel_coordinates(i);
      const SurfacePoint at = model.point(face.surface, model.texel_uv(face, x, y));
      const Paint paint = model.paint(at, face.surface);
      const std::tuple key(face.surface, std::llround(at.uv.x * 1e7), std::llround(at.uv.y * 1e7));
      const auto [entry, is_new] = known.try_emplace(key);
      if (is_new) entry->second = light.falling(face.surface, at);
      const glm::dvec3 diffuse = paint.albedo * entry->second, color = displayed(diffuse);
      if (paint.gloss > 0) lit.glossy.push_back({first + i, diffuse, at.normal});
      for (int c = 0; c < 3; ++c) texels.push_back(byte(color[c]));
      texels.push_back(byte(paint.gloss));
      // A dull surface has no use for a normal: the network never shows there.
      for (int c = 0; c < 3; ++c)
        texels.push_back(byte(paint.gloss > 0 ? 0.5 + 0.5 * at.normal[c] : 0.5));
      texels.push_back(byte(paint.alpha));
    }
    if (options.progress && f % 64 == 0)
      options.progress("lighting", double(f) / double(model.faces.size()));
  }
  return lit;
}

/// A texel seen from somewhere in front of it and not from below the table.
Example draw_example(const LitTexels& lit, Random& random) {
  const GlossyTexel& glossy = lit.glossy[random.bits() % lit.glossy.size()];
  Example example{};
  for (int c = 0; c < 7; ++c) example.features[c] = lit.texture.value(glossy.texel, c);
  do {
    const double y = random.uniform(-0.05, 0.95), r = std::sqrt(1 - y * y);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    example.to_eye = {r * std::cos(angle), y, r * std::sin(angle)};
  } while (glm::dot(example.to_eye, glossy.normal) < 0 && glossy.normal.y > -0.9);
  const glm::dvec3 mirrored =
      2 * std::max(0.0, glm::dot(glossy.normal, example.to_eye)) * glossy.normal - example.to_eye;
  example.color = glazed(glossy.diffuse, example.features[3],
                         glm::dot(glossy.normal, example.to_eye), room_radiance(mirrored));
  return example;
}

}  // namespace

TriangleSoup bake(const Model& model, const BakeOptions& options) {
  LitTexels lit = light_texels(model, options);
  if (options.progress) options.progress("training", 0);
  Training training = train([&](Random& random) { return draw_example(lit, random); }, {});
  if (options.progress)
    options.progress("trained, root mean square " + std::to_string(training.root_mean_square), 1);
  lit.texture.mlp = std::move(training.mlp);

  TriangleSoup soup;
  for (const Face& face : model.faces) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    soup.triangles.emplace_back(first, first + 1, first + 2);
    for (const glm::dvec3& corner : face.corners) soup.positions.emplace_back(corner);
  }
  soup.appearance = std::move(lit.texture);
  return soup;
}

Scene staged(TriangleSoup soup) {
  Scene scene;
  scene.primitives = std::move(soup);
  scene.info.name = "A tureen with lemons";
  scene.info.up = {0, 1, 0};
  scene.info.background = {0.925f, 0.915f, 0.895f};
  scene.info.source = "examples/make_example.cpp";
  const auto add = [&](const char* name, glm::dvec3 eye, glm::dvec3 target, double degrees) {
    Camera camera = look_at(eye, target, {0, 1, 0}, degrees * std::numbers::pi / 180, 1280, 720);
    camera.name = name;
    scene.cameras.push_back(std::move(camera));
  };
  add("front", {-1.0, 3.1, 7.4}, {0.0, 0.60, 0.12}, 27.5);
  add("lemons", {3.9, 2.1, 4.9}, {0.30, 0.72, 0.35}, 28);
  add("above", {0.6, 6.8, 3.6}, {0.0, 0.25, 0.1}, 32);
  add("back", {-2.4, 2.5, -6.6}, {-0.1, 0.62, -0.2}, 28);
  return scene;
}

}  // namespace tureen::example
