#include "runtime/debug_views/debug_view.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/vector_uint4_sized.hpp>
#include <glm/geometric.hpp>

#include "base/decimal_text.hpp"

namespace tureen {

namespace {

constexpr std::array debug_views{
    DebugViewName{DebugView::color, "color", "final colour", "as rendered"},
    DebugViewName{DebugView::depth, "depth", "depth", "distance along the viewing axis",
                  "mean distance along the viewing axis"},
    DebugViewName{DebugView::normals, "normals", "normals", "(n + 1) / 2, towards the eye",
                  "(n + 1) / 2 of the mean, towards the eye"},
    DebugViewName{DebugView::triangle_id, "triangle-id", "triangle id", "one colour a triangle"},
    DebugViewName{DebugView::texels, "texels", "texels", "the nearest texel, not interpolated"},
    DebugViewName{DebugView::alpha, "alpha", "alpha", "including cut-out fragments",
                  "the part of the light that is blocked"},
    DebugViewName{DebugView::mlp_weight, "mlp-weight", "MLP weight", "blend weight of the network"},
    DebugViewName{DebugView::features, "features", "features", "stored texel values"},
    DebugViewName{DebugView::overdraw, "overdraw", "overdraw", "fragments a pixel",
                  "blended splats a pixel"},
    DebugViewName{DebugView::wireframe, "wireframe", "wireframe", "edges over the dimmed colour"},
    DebugViewName{DebugView::holes, "holes", "holes", "uncovered among covered pixels"},
    DebugViewName{DebugView::median_depth, "median-depth", "median depth",
                  "where half of the light is blocked"},
    DebugViewName{DebugView::opacity, "opacity", "opacity", "weighted mean of the splats"},
    DebugViewName{DebugView::sigma, "sigma", "sigma", "weighted mean of the triangle windows"},
    DebugViewName{DebugView::contributions, "contributions", "contributions",
                  "splats a pixel until it is opaque"},
    DebugViewName{DebugView::order, "order", "order", "place of the first splat"},
    DebugViewName{DebugView::quarter, "quarter", "quarter", "a random quarter of the splats"},
};

const ColorMlp* network_of(const TriangleSoup& soup) {
  const std::optional<ColorMlp>* mlp = nullptr;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) mlp = &texture->mlp;
  if (const auto* textures = std::get_if<UvTextures>(&soup.appearance)) mlp = &textures->mlp;
  return mlp && *mlp ? &**mlp : nullptr;
}

std::string stored_instead(const TriangleSoup& soup) {
  return std::string(" (the soup stores ") + appearance_name(soup.appearance) + ")";
}

bool has_texels(const TriangleSoup& soup) {
  const auto* textures = std::get_if<UvTextures>(&soup.appearance);
  return std::holds_alternative<LatticeTexture>(soup.appearance) ||
         (textures && !textures->images.empty());
}

std::uint32_t mixed_bits(std::uint32_t x) {
  // lowbias32 from Chris Wellons' "hash prospector": a bijection of 32 bits, found by a search for
  // minimal bias.
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

glm::u8vec4 bytes(glm::vec3 color) {
  return glm::u8vec4(glm::vec4(glm::clamp(color, 0.0f, 1.0f), 1.0f) * 255.0f + 0.5f);
}

Legend depth_legend(const DepthScale& scale) {
  Legend entries;
  constexpr int last = 4;
  for (int i = 0; i <= last; ++i) {
    const double t = double(i) / last;
    entries.push_back({bytes(heat_ramp(float(1 - t))),
                       short_decimal(scale.near * std::pow(scale.far / scale.near, t), 3)});
  }
  return entries;
}

Legend overdraw_legend() {
  Legend entries;
  for (int count = 1; count <= 128; count *= 2)
    entries.push_back({bytes(overdraw_color(count)), std::to_string(count)});
  entries.push_back({bytes(overdraw_color(max_counted_fragments)),
                     std::to_string(max_counted_fragments) + " or more"});
  return entries;
}

Legend feature_legend(const FeatureChoice& choice) {
  if (choice.count == 1) return {{{0, 0, 0, 255}, "0"}, {{255, 255, 255, 255}, "1"}};
  constexpr std::array<glm::u8vec4, 3> channels{
      {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}}};
  Legend entries;
  for (int i = 0; i < choice.count; ++i)
    entries.push_back({channels[std::size_t(i)], "feature " + std::to_string(choice.first + i)});
  return entries;
}

}  // namespace

std::span<const DebugViewName> debug_view_names() { return debug_views; }

const char* name_of(DebugView what) { return debug_views[std::size_t(what)].name; }

std::optional<DebugView> debug_view_named(std::string_view name) {
  for (const DebugViewName& known : debug_views)
    if (name == known.name) return known.what;
  return std::nullopt;
}

int feature_count(const TriangleSoup& soup) {
  if (std::holds_alternative<LatticeTexture>(soup.appearance)) return LatticeTexture::features;
  return network_of(soup) ? 8 : 0;
}

std::optional<std::string> why_not(DebugView what, const TriangleSoup& soup) {
  const ColorMlp* network = network_of(soup);
  switch (what) {
    case DebugView::texels:
      if (!has_texels(soup)) return "There are no texels" + stored_instead(soup) + ".";
      break;
    case DebugView::alpha:
      if (std::holds_alternative<Harmonics>(soup.appearance))
        return "There is no alpha: every triangle is opaque" + stored_instead(soup) + ".";
      break;
    case DebugView::mlp_weight:
      if (!network) return "There is no color MLP" + stored_instead(soup) + ".";
      if (!network->blend_channel)
        return "The color MLP has no blend weight: it computes the whole colour.";
      break;
    case DebugView::features:
      if (feature_count(soup) == 0) return "There are no features" + stored_instead(soup) + ".";
      break;
    case DebugView::opacity:
    case DebugView::sigma:
    case DebugView::contributions:
    case DebugView::order:
    case DebugView::quarter:
      return "It shows splats, not triangles.";
    default:
      break;
  }
  return std::nullopt;
}

std::string with_capital(std::string text) {
  text[0] = char(std::toupper(text[0]));
  return text;
}

std::optional<std::string> why_not(DebugView what, const Splats& splats) {
  switch (what) {
    case DebugView::triangle_id:
    case DebugView::texels:
    case DebugView::mlp_weight:
    case DebugView::features:
    case DebugView::wireframe:
    case DebugView::holes:
      return "It shows triangles, not splats.";
    case DebugView::opacity:
      if (opacity_of(splats.kernel)) break;
      return with_capital(kernel_name(splats.kernel)) + " have no opacity.";
    case DebugView::sigma:
      if (std::holds_alternative<TriangleWindows>(splats.kernel)) break;
      return std::string("There is no sigma (the layer has ") + kernel_name(splats.kernel) + ").";
    default:
      break;
  }
  return std::nullopt;
}

std::optional<std::string> why_not(DebugView what, const Primitives& primitives) {
  return std::visit([&](const auto& each) { return why_not(what, each); }, primitives);
}

std::optional<std::string> why_not(const FeatureChoice& choice, int feature_count) {
  if (choice.count < 1 || choice.count > 3) return "A debug view shows one, two or three features.";
  if (choice.first < 0 || choice.first + choice.count > feature_count)
    return "Features are numbered from 0 to " + std::to_string(feature_count - 1) + ".";
  return std::nullopt;
}

glm::vec3 triangle_color(std::uint32_t face, std::uint32_t layer) {
  const std::uint32_t h = mixed_bits(face + 1 + layer * 0x9e3779b9u);
  return 0.25f + 0.75f / 255.0f * glm::vec3(h & 255, h >> 8 & 255, h >> 16 & 255);
}

double DepthScale::position(double depth) const {
  return std::clamp(std::log(depth / near) / std::log(far / near), 0.0, 1.0);
}

DepthScale depth_scale(const Bounds& bounds, glm::dvec3 eye) {
  // A soup of a single point also needs a range.
  const double radius = std::max(bounds.radius(), 1e-6);
  const double distance = glm::length(bounds.center() - eye);
  const double far = distance + radius;
  return {std::max(distance - radius, far / 50), far};
}

glm::vec3 overdraw_color(int count) { return heat_ramp(std::log2(float(count)) / 8.0f); }

glm::vec3 cut_out_color(float part_of_threshold) {
  return glm::mix(glm::vec3(0.22f, 0.08f, 0.36f), glm::vec3(0.78f, 0.42f, 0.70f),
                  part_of_threshold);
}

Legend legend(DebugView what, const DepthScale& scale, const FeatureChoice& choice,
              Subjects subjects) {
  constexpr glm::u8vec4 black{0, 0, 0, 255}, grey{128, 128, 128, 255}, white{255, 255, 255, 255};
  switch (what) {
    case DebugView::depth:
    case DebugView::median_depth:
      return depth_legend(scale);
    case DebugView::normals:
      return {
          {{255, 128, 128, 255}, "x"}, {{128, 255, 128, 255}, "y"}, {{128, 128, 255, 255}, "z"}};
    case DebugView::alpha:
      if (subjects == Subjects::splats) return {{black, "0"}, {white, "1"}};
      return {{bytes(cut_out_color(0)), "0, cut out"},
              {bytes(cut_out_color(1)), "just cut out"},
              {grey, "just kept"},
              {white, "1"}};
    case DebugView::mlp_weight:
      return {{black, "base colour"}, {white, "network"}};
    case DebugView::features:
      return feature_legend(choice);
    case DebugView::overdraw:
    case DebugView::contributions:
      return overdraw_legend();
    case DebugView::holes:
      return {{bytes(hole_color), "hole"}};
    case DebugView::opacity:
      return {{black, "0"}, {white, "1"}};
    case DebugView::sigma:
      return {{black, "0, a solid triangle"}, {grey, "1"}, {white, "above 100"}};
    case DebugView::order:
      return {{bytes(heat_ramp(1)), "first"}, {bytes(heat_ramp(0)), "last"}};
    default:
      return {};
  }
}

}  // namespace tureen
