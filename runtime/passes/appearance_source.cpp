#include "runtime/passes/appearance_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/passes/lattice_source.hpp"
#include "runtime/plan/view_dependence.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Colours as bytes if that is lossless, otherwise as floats.
TexelSource color_source(std::uint64_t count, const char* what,
                         const std::function<glm::vec4(std::uint64_t)>& color) {
  const auto as_byte = [](float value) {
    return std::clamp(std::round(value * 255.0f), 0.0f, 255.0f);
  };
  bool bytes = true;
  for (std::uint64_t i = 0; bytes && i < count; ++i) {
    const glm::vec4 value = color(i);
    for (int c = 0; c < 4; ++c) bytes = bytes && as_byte(value[c]) / 255.0f == value[c];
  }
  if (bytes)
    return {texel_formats::rgba8, count, what,
            [color, as_byte](std::uint64_t first, std::span<std::byte> out) {
              for (std::size_t i = 0; i < out.size(); ++i)
                out[i] = std::byte(as_byte(color(first + i / 4)[int(i % 4)]));
            }};
  return {texel_formats::rgba32f, count, what,
          [color](std::uint64_t first, std::span<std::byte> out) {
            for (std::size_t i = 0; i < out.size() / 16; ++i) {
              const glm::vec4 value = color(first + i);
              std::memcpy(&out[16 * i], &value, 16);
            }
          }};
}

/// The sources keep pointers to the soup and to elements of the plan: the plan may be moved.
class Preparation {
 public:
  Preparation(const TriangleSoup& soup, const SoupPlan& plan, const TexelLayout& layout)
      : soup_(soup), plan_(plan), layout_(layout) {
    result_.constants = {{"ALPHA_THRESHOLD", "0.5"}, {"COLOR_MLP", plan.color_mlp ? "1" : "0"}};
  }

  AppearanceSource run() {
    std::visit([this](const auto& appearance) { prepare(appearance); }, soup_.appearance);
    result_.fit_layout(layout_);
    return std::move(result_);
  }

 private:
  void include(const char* file) { result_.glsl += std::string("#include \"") + file + "\"\n"; }
  void add(const char* name, TexelSource source) {
    result_.samplers.push_back({name, std::move(source)});
  }
  std::uint64_t slots() const { return plan_.faces.size(); }
  /// The soup's face of each slot. Refers to the elements, not to the plan object.
  auto faces() const { return std::span<const std::uint32_t>(plan_.faces); }
  /// A function from a corner of the slots, three a slot, to the soup's vertex.
  auto corner_vertices() const {
    return [faces = faces(), &triangles = soup_.triangles](std::uint64_t corner) {
      return triangles[faces[corner / 3]][int(corner % 3)];
    };
  }

  void add_mlp(const ColorMlp& mlp, const FeatureRanges& ranges) {
    if (!plan_.color_mlp) return;
    result_.mlp = color_mlp_source(plan_.view_direction ? mlp : without_direction(mlp),
                                   plan_.mlp_weights, ranges);
    if (mlp.encoding == DirectionEncoding::harmonics2) result_.constants["HARMONICS_DEGREE"] = "2";
    result_.glsl += result_.mlp.text;
  }

  void prepare_face_colors(const std::function<glm::vec4(std::uint32_t)>& color_of_face) {
    include("appearance_face_colors.glsl");
    add("colors",
        color_source(slots(), "face colours", [faces = faces(), color_of_face](std::uint64_t slot) {
          return color_of_face(faces[slot]);
        }));
  }

  void prepare(const FaceColors& colors) {
    prepare_face_colors([&colors](std::uint32_t face) { return colors.rgba[face]; });
  }

  void prepare(const VertexColors& colors) {
    if (plan_.flat_colors)
      return prepare_face_colors([&colors, &triangles = soup_.triangles](std::uint32_t face) {
        return colors.rgba[triangles[face].x];
      });
    include("appearance_vertex_colors.glsl");
    add("colors", color_source(3 * slots(), "vertex colours",
                               [&colors, vertex_of = corner_vertices()](std::uint64_t corner) {
                                 return colors.rgba[vertex_of(corner)];
                               }));
  }

  void prepare(const Harmonics& sh) {
    include("appearance_harmonics.glsl");
    const bool per_vertex = sh.domain == Harmonics::Domain::vertex;
    const auto stored = std::uint64_t(harmonics::count(sh.degree));
    const auto kept = std::uint64_t(harmonics::count(plan_.harmonics_degree));
    result_.constants["HARMONICS_DEGREE"] = std::to_string(plan_.harmonics_degree);
    result_.constants["HARMONICS_PER_VERTEX"] = per_vertex ? "1" : "0";
    result_.constants["VIEW_SIGN"] = sh.view == ViewConvention::surface_to_eye ? "1.0" : "-1.0";
    const std::uint64_t elements = per_vertex ? 3 * slots() : slots();
    const auto fill_coefficients = [&sh, per_vertex, stored, kept, faces = faces(),
                                    vertex_of = corner_vertices()](std::uint64_t first,
                                                                   std::span<std::byte> out) {
      for (std::size_t i = 0; i < out.size() / 12; ++i) {
        const std::uint64_t texel = first + i, of_element = texel / kept;
        const std::uint64_t element = per_vertex ? vertex_of(of_element) : faces[of_element];
        std::memcpy(&out[12 * i], &sh.coefficients[element * stored + texel % kept], 12);
      }
    };
    add("coefficients", {texel_formats::rgb32f, elements * kept, "harmonics", fill_coefficients});
    const auto fill_anchors = [&soup = soup_, per_vertex, faces = faces(),
                               vertex_of = corner_vertices()](std::uint64_t first,
                                                              std::span<std::byte> out) {
      for (std::size_t i = 0; i < out.size() / 12; ++i) {
        const glm::vec3 point =
            per_vertex ? soup.positions[vertex_of(first + i)] : center(soup, faces[first + i]);
        std::memcpy(&out[12 * i], &point, 12);
      }
    };
    add("anchors", {texel_formats::rgb32f, elements, "harmonics anchors", fill_anchors});
  }

  static glm::vec3 center(const TriangleSoup& soup, std::uint32_t face) {
    glm::dvec3 sum(0.0);
    for (int k = 0; k < 3; ++k) sum += glm::dvec3(soup.positions[soup.triangles[face][k]]);
    return glm::vec3(sum / 3.0);
  }

  void prepare(const LatticeTexture& texture) {
    if (plan_.flat_colors)
      return prepare_face_colors([&texture](std::uint32_t face) {
        const std::uint32_t texel = texture.patches[face].first_texel;
        return glm::vec4(texture.value(texel, 0), texture.value(texel, 1), texture.value(texel, 2),
                         1.0f);
      });
    LatticeSources sources = prepare_lattice(texture, plan_, layout_);
    include("appearance_lattice.glsl");
    result_.constants["LATTICE_LEVEL"] = std::to_string(plan_.lattice.uniform_level);
    add("features0", std::move(sources.features0));
    result_.constants["LATENT_FEATURES"] = plan_.latent_features ? "1" : "0";
    if (plan_.latent_features) add("features1", std::move(sources.features1));
    result_.constants["ALPHA_BY_CELL"] = plan_.lattice.alpha_by_cell ? "1" : "0";
    if (plan_.opaque_count < plan_.faces.size())
      add(plan_.lattice.alpha_by_cell ? "alpha_cells" : "alpha_texels", std::move(sources.alpha));
    if (plan_.lattice.uniform_level < 0) add("patches", std::move(sources.patches));
    if (texture.mlp) add_mlp(*texture.mlp, plan_.feature_ranges);
  }

  void prepare(const UvTextures& textures) {
    include("appearance_uv.glsl");
    result_.constants["VERTEX_TINT"] = textures.vertex_rgba.empty() ? "0" : "1";
    prepare_images(textures);
    add("coordinates",
        {texel_formats::rg32f, 3 * slots(), "texture coordinates",
         [&textures, vertex_of = corner_vertices()](std::uint64_t first, std::span<std::byte> out) {
           for (std::size_t i = 0; i < out.size() / 8; ++i)
             std::memcpy(&out[8 * i], &textures.uv[vertex_of(first + i)], 8);
         }});
    if (!textures.vertex_rgba.empty())
      add("tints", color_source(3 * slots(), "vertex colours",
                                [&textures, vertex_of = corner_vertices()](std::uint64_t corner) {
                                  return textures.vertex_rgba[vertex_of(corner)];
                                }));
    std::vector<std::uint32_t> material_of_slot(slots());
    for (std::size_t slot = 0; slot < slots(); ++slot)
      material_of_slot[slot] = textures.material_of_face[plan_.faces[slot]];
    add("material_of_face",
        TexelSource::of(texel_formats::r32ui, std::move(material_of_slot), "face materials"));
    if (textures.mlp) add_mlp(*textures.mlp, plan_.feature_ranges);
  }

  /// Adds one store with all images, or two with latent features, and the store of materials. Each
  /// material has three texels with the place and the sampling of its image.
  /// shaders/appearance_uv.glsl defines the flags.
  void prepare_images(const UvTextures& textures) {
    std::vector<glm::uvec4> table;
    std::vector<const Image8*> firsts, seconds;
    std::vector<std::uint64_t> starts;
    std::uint64_t texels = 0;
    for (const UvMaterial& material : textures.materials) {
      glm::uvec4 entry(0, 1, 1, 0);
      if (!material.images.empty()) {
        const Image8* image = &textures.images[material.images[0]];
        // Materials that share their images share the texels.
        const Image8* second = textures.mlp ? &textures.images[material.images[1]] : nullptr;
        std::size_t known = 0;
        while (known < firsts.size() && (firsts[known] != image || seconds[known] != second))
          ++known;
        if (known == firsts.size()) {
          firsts.push_back(image);
          seconds.push_back(second);
          starts.push_back(texels);
          texels += image->pixels.size();
        }
        entry = glm::uvec4(std::uint32_t(starts[known]), image->width, image->height, 1u);
      }
      if (material.filter == UvMaterial::Filter::linear) entry.w |= 2u;
      entry.w |= std::uint32_t(material.wrap_u) << 2 | std::uint32_t(material.wrap_v) << 4 |
                 std::uint32_t(material.mask_channel) << 6;
      glm::uvec4 factor;
      std::memcpy(&factor, &material.factor, sizeof factor);
      glm::uvec4 threshold(0);
      std::memcpy(&threshold.x, &material.mask_threshold, sizeof threshold.x);
      table.insert(table.end(), {entry, factor, threshold});
    }
    add("texels0", image_source(firsts, starts, texels));
    result_.constants["LATENT_FEATURES"] = plan_.latent_features ? "1" : "0";
    if (plan_.latent_features) add("texels1", image_source(seconds, starts, texels));
    add("materials", TexelSource::of(texel_formats::rgba32ui, std::move(table), "materials"));
  }

  static TexelSource image_source(const std::vector<const Image8*>& images,
                                  const std::vector<std::uint64_t>& starts, std::uint64_t texels) {
    const auto fill = [images, starts](std::uint64_t first, std::span<std::byte> out) {
      std::uint64_t count = out.size() / 4;
      std::byte* destination = out.data();
      auto image =
          std::size_t(std::upper_bound(starts.begin(), starts.end(), first) - starts.begin()) - 1;
      while (count > 0) {
        const auto& pixels = images[image]->pixels;
        const std::uint64_t offset = first - starts[image];
        const std::uint64_t n = std::min<std::uint64_t>(count, pixels.size() - offset);
        std::memcpy(destination, &pixels[offset], n * 4);
        destination += n * 4;
        first += n;
        count -= n;
        ++image;
      }
    };
    return {texel_formats::rgba8, texels, "texture images", fill};
  }

  const TriangleSoup& soup_;
  const SoupPlan& plan_;
  const TexelLayout& layout_;
  AppearanceSource result_;
};

}  // namespace

void AppearanceSource::fit_layout(const TexelLayout& device) {
  std::uint64_t most = 0;
  for (const Sampler& sampler : samplers) most = std::max(most, sampler.source.count);
  layout = device.fitted(most);
  constants["TEXEL_ROW_BITS"] = std::to_string(layout.row_bits);
  constants["TEXEL_LAYER_BITS"] = std::to_string(layout.layer_bits);
}

AppearanceSource prepare_appearance(const TriangleSoup& soup, const SoupPlan& plan,
                                    const TexelLayout& layout) {
  return Preparation(soup, plan, layout).run();
}

}  // namespace tureen
