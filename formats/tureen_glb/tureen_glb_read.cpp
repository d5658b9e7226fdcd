// Reads TUREEN_triangle_soup. The JSON locates each array, and the reader copies it directly into
// the scene. Files of our writer are read in file order.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <variant>

#include "base/crc32.hpp"
#include "base/json/json_vector.hpp"
#include "formats/glb/glb_arrays.hpp"
#include "formats/tureen_glb/compressed_geometry.hpp"
#include "formats/tureen_glb/compressed_texels.hpp"
#include "formats/tureen_glb/texel_strips.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_geometry.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
#include "formats/tureen_glb/tureen_glb_quality.hpp"
#include "formats/tureen_glb/tureen_glb_remarks.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "image/png.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/lattice.hpp"
#include "scene/scene_remarks.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

namespace layout = glb_layout;

class Reader {
 public:
  Reader(Input& input, const GlbContainer& glb, const ReadOptions& options)
      : input_(input),
        arrays_(input, glb, options.progress),
        extension_(tureen_extension_of(arrays_)),
        options_(options) {}

  Scene scene() {
    Scene scene;
    read_info(extension_, scene);
    if (has_layers(extension_))
      read_layers(scene);
    else
      read_only_layer(scene);
    return scene;
  }

 private:
  /// Versions 1 and 3: the root's extension is the layer.
  void read_only_layer(Scene& scene) {
    Layer& layer = scene.layers.emplace_back(read_layer_at_origin(extension_));
    scene.info.compressed = extension_.find("slim_geometry").has_value();
    TriangleSoup soup;
    read_geometry(soup);
    const Edits edits = read_preset(scene, soup);
    layer.primitives = primitives(extension_, std::move(soup));
    layer.material = read_layer_material(arrays_, extension_);
    if (edits == Edits{}) return;
    if (auto* edited_soup = std::get_if<TriangleSoup>(&layer.primitives))
      *edited_soup = with_edits(std::move(*edited_soup), edits, scene.info.remarks);
    else
      scene.info.remarks.push_back({&remarks::preset_dropped});
  }

  /// Versions 4 and 5: each layer is a node with an extension.
  void read_layers(Scene& scene) {
    if (const auto preset = extension_.find("preset"))
      scene.quality = tureen::read_preset(*preset).quality;
    const JsonView layers = extension_["layers"];
    if (layers.size() == 0) layers.fail("the file has no layer");
    if (layers.size() > max_layers)
      layers.fail("the file has " + std::to_string(layers.size()) + " layers; at most " +
                  std::to_string(max_layers) + " are supported");
    const auto node = [&](std::size_t i) {
      return arrays_.root()["nodes"].at(GlbArrays::index(layers.at(i)));
    };
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      // A layer without them is rejected when it is read.
      const auto extensions = node(i).find("extensions");
      const auto extension = extensions ? extensions->find(tureen_extension) : std::nullopt;
      const auto count = extension ? extension->find("splat_count") : std::nullopt;
      if (!count) continue;
      all_splats_ += count->natural(GlbArrays::max_count);
      bytes += splat_bytes(arrays_, node(i), *count);
    }
    // A false count is rejected later.
    if (all_splats_ > 0 && bytes <= input_.size() && options_.found_splats)
      options_.found_splats(all_splats_, bytes);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      arrays_.begin_layer();
      scene.layers.push_back(layer(node(i)));
    }
    if (kept_splats_ < all_splats_)
      scene.info.remarks.push_back(
          {&remarks::splats_limited, {{"kept", kept_splats_}, {"all", all_splats_}}});
  }

  Layer layer(const JsonView& node) {
    Layer result = read_layer_of_node(node);
    const JsonView extension = node["extensions"][tureen_extension];
    if (extension.find("splat_count")) {
      const std::uint64_t number = extension["splat_count"].natural(GlbArrays::max_count);
      SplatPart part;
      if (options_.max_splats && *options_.max_splats < all_splats_)
        part.max_splats = share_of(number, read_splats_, *options_.max_splats, all_splats_);
      Splats splats = read_splats(arrays_, node, extension["splat_count"], part);
      read_splats_ += number;
      kept_splats_ += count(splats);
      result.primitives = std::move(splats);
      return result;
    }
    TriangleSoup soup;
    tureen::read_geometry(arrays_, geometry_layout(arrays_, extension), soup);
    result.primitives = primitives(extension, std::move(soup));
    result.material = read_layer_material(arrays_, extension);
    return result;
  }

  /// The appearance in `extension`, of the root or of a layer, for the given geometry.
  Primitives primitives(const JsonView& extension, TriangleSoup soup) {
    const JsonView appearance = extension["appearance"];
    if (appearance["type"].text() == "soft_triangles")
      return soft_triangles(extension, std::move(soup));
    soup.appearance = read_appearance(appearance, soup);
    if (extension.find("normals"))
      soup.normals = arrays_.read<glm::vec3>(extension, "normals", soup.positions.size(),
                                             glb_formats::vec3_float);
    if (const auto reason = defect(soup)) extension.fail(*reason);
    return soup;
  }

  std::vector<glm::vec4> colors(const JsonView& holder, std::uint64_t count) {
    const auto reference = holder.find("rgba");
    if (!reference ||
        arrays_.accessor(*reference)["componentType"].natural() == std::uint64_t(layout::float32))
      return arrays_.read<glm::vec4>(holder, "rgba", count, glb_formats::vec4_float);
    input_.seek(arrays_.location(holder, "rgba", count, glb_formats::vec4_unorm8).offset);
    input_.take_memory(count, sizeof(glm::vec4), "rgba");
    std::vector<glm::vec4> result(static_cast<std::size_t>(count));
    // Block by block, so that bytes and floats are never both in memory as a whole.
    std::array<glm::u8vec4, 4096> block;
    for (std::size_t done = 0; done < result.size();) {
      const std::size_t n = std::min(block.size(), result.size() - done);
      input_.read(std::as_writable_bytes(std::span(block).first(n)), "rgba");
      for (std::size_t i = 0; i < n; ++i) result[done + i] = glm::vec4(block[i]) / 255.0f;
      done += n;
    }
    arrays_.tell_progress();
    return result;
  }

  void read_geometry(TriangleSoup& soup) {
    if (!extension_.find("slim_geometry")) {
      tureen::read_geometry(arrays_, geometry_layout(arrays_, extension_), soup);
      return;
    }
    PassingMemory passing(input_.budget());
    CompressedGeometry geometry = decode_compressed_geometry(
        coded(extension_, "slim_geometry"), arrays_.index(extension_["vertex_count"]),
        arrays_.index(extension_["face_count"]), arrays_.file(), input_.budget());
    passing.keep(geometry.positions.capacity() * sizeof geometry.positions[0] +
                 geometry.triangles.capacity() * sizeof geometry.triangles[0]);
    soup.positions = std::move(geometry.positions);
    soup.triangles = std::move(geometry.triangles);
  }

  /// The entropy-coded bytes of an array, checked against their checksum: most damaged bytes would
  /// decode without an error.
  std::vector<std::byte> coded(const JsonView& holder, const std::string& key) {
    const JsonView view = holder[key.c_str()];
    auto bytes = arrays_.read_at<std::byte>(arrays_.view_location(view), "compressed bytes");
    const auto sum = holder.find((key + "_crc32").c_str());
    if (sum && sum->natural(0xffffffffu) != crc32_of(bytes))
      view.fail("it is damaged: its checksum is not that of its bytes");
    return bytes;
  }

  /// Sets the scene's quality. Returns the edits, which only files of earlier versions have.
  Edits read_preset(Scene& scene, const TriangleSoup& soup) {
    const auto view = extension_.find("preset");
    if (!view) return {};
    StoredPreset preset = tureen::read_preset(*view);
    scene.quality = preset.quality;
    if (view->find("keeps_face"))
      preset.edits.keeps_face = arrays_.read<std::uint8_t>(
          *view, "keeps_face", soup.triangles.size(), glb_formats::scalar_u8);
    if (const auto reason = defect(preset.edits, soup)) view->fail(*reason);
    if (!preset.ignored.empty())
      scene.info.remarks.push_back({&remarks::preset_keys_ignored, {{"keys", preset.ignored}}});
    return std::move(preset.edits);
  }

  /// The number of texels with all lattice levels limited to `level`. Faces that share all texels
  /// continue to share them.
  static std::uint64_t texels_at_most(const LatticeTexture& texture, int level) {
    std::vector<std::uint64_t> patches;
    for (const LatticePatch& patch : texture.patches)
      patches.push_back(std::uint64_t(patch.first_texel) << 3 | patch.level);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    std::uint64_t texels = 0;
    for (const std::uint64_t patch : patches)
      texels += lattice::texel_count(std::min(int(patch & 7), level));
    return texels;
  }

  TriangleSoup with_edits(TriangleSoup soup, const Edits& edits, std::vector<Remark>& remarks) {
    if (edits == Edits{}) return soup;
    PassingMemory passing(input_.budget());
    input_.take_memory(byte_size(soup), 1, "the scene after the edits of the file's preset");
    if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance))
      input_.take_memory(texels_at_most(*texture, edits.lattice_level),
                         LatticeTexture::channels * (texture->is_float() ? 4 : 1),
                         "the texels after the edits of the file's preset");
    remarks.push_back({&remarks::preset_applied, {{"edits", names_of(edits)}}});
    return edited(std::move(soup), edits);
  }

  Appearance read_appearance(const JsonView& view, const TriangleSoup& soup) {
    static constexpr const char* types[] = {"face_colors", "vertex_colors", "harmonics",
                                            "lattice_texture", "uv_textures"};
    switch (view["type"].one_of(types)) {
      case 0:
        return FaceColors{colors(view, soup.triangles.size())};
      case 1:
        return VertexColors{colors(view, soup.positions.size())};
      case 2:
        return harmonics(view, soup);
      case 3:
        return lattice_texture(view, soup);
      default:
        return uv_textures(view, soup);
    }
  }

  static int degree(const JsonView& view) {
    return int(view["degree"].natural(harmonics::max_degree));
  }

  std::vector<glm::vec3> coefficients(const JsonView& view, int degree, std::uint64_t elements) {
    return arrays_.read<glm::vec3>(view, "coefficients",
                                   elements * std::uint64_t(harmonics::count(degree)),
                                   glb_formats::vec3_float);
  }

  Harmonics harmonics(const JsonView& view, const TriangleSoup& soup) {
    Harmonics sh;
    sh.domain = Harmonics::Domain(view["domain"].one_of(layout::domains));
    sh.degree = degree(view);
    sh.view = ViewConvention(view["view"].one_of(view_conventions));
    const std::size_t elements =
        sh.domain == Harmonics::Domain::face ? soup.triangles.size() : soup.positions.size();
    sh.coefficients = coefficients(view, sh.degree, elements);
    return sh;
  }

  Splats soft_triangles(const JsonView& extension, TriangleSoup soup) {
    const JsonView view = extension["appearance"];
    const std::size_t faces = soup.triangles.size();
    if (extension.find("triangles")) extension.fail("soft triangles share no vertices");
    Splats splats{.profile = *profile_named("triangle-splatting")};
    if (const auto profile = view.find("profile")) splats.profile = read_splat_profile(*profile);
    splats.color.degree = degree(view);
    if (const auto domain = view.find("domain"))
      splats.color.per_corner =
          Harmonics::Domain(domain->one_of(layout::domains)) == Harmonics::Domain::vertex;
    splats.color.coefficients =
        coefficients(view, splats.color.degree, splats.color.per_corner ? 3 * faces : faces);
    TriangleWindows& windows = splats.kernel.emplace<TriangleWindows>();
    windows.corners = std::move(soup.positions);
    windows.sigma = arrays_.read<float>(view, "sigma", faces, glb_formats::scalar_float);
    windows.opacity = arrays_.read<float>(view, "opacity", faces, glb_formats::scalar_float);
    if (const auto reason = defect(splats)) extension.fail(*reason);
    return splats;
  }

  std::optional<ColorMlp> color_mlp(const JsonView& holder) {
    const auto view = holder.find("color_mlp");
    if (!view) return std::nullopt;
    ColorMlp mlp;
    mlp.encoding = DirectionEncoding((*view)["encoding"].one_of(direction_encodings));
    mlp.view = ViewConvention((*view)["view"].one_of(view_conventions));
    if (const auto blend = view->find("blend_channel"))
      mlp.blend_channel = int(blend->natural(ColorMlp::max_width));
    const JsonView layers = (*view)["layers"];
    if (layers.size() > std::size_t(ColorMlp::max_layers))
      layers.fail("more than " + std::to_string(ColorMlp::max_layers) + " layers");
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const JsonView entry = layers.at(i);
      DenseLayer layer;
      layer.inputs = int(entry["inputs"].natural(ColorMlp::max_width));
      layer.outputs = int(entry["outputs"].natural(ColorMlp::max_width));
      layer.weights = arrays_.read<float>(
          entry, "weights", std::uint64_t(layer.inputs) * std::uint64_t(layer.outputs),
          glb_formats::scalar_float);
      layer.biases = arrays_.read<float>(entry, "biases", std::uint64_t(layer.outputs),
                                         glb_formats::scalar_float);
      mlp.layers.push_back(std::move(layer));
    }
    return mlp;
  }

  LatticeTexture lattice_texture(const JsonView& view, const TriangleSoup& soup) {
    if (view.find("slim_texels")) {
      // The network precedes the texels in the file.
      std::optional<ColorMlp> mlp = color_mlp(view);
      PassingMemory passing(input_.budget());
      LatticeTexture texture = decode_compressed_texels(
          coded(view, "slim_texels"), soup.triangles.size(), arrays_.file(), input_.budget());
      passing.keep(soup.triangles.size() * sizeof texture.patches[0] +
                   texture.texel_count() * LatticeTexture::channels);
      texture.mlp = std::move(mlp);
      return texture;
    }
    LatticeTexture texture;
    texture.patches = patches(view, soup.triangles.size());
    texture.mlp = color_mlp(view);
    if (view.find("strips"))
      texture.texels = strips(view);
    else
      texture.texels = arrays_.read<float>(
          view, "texels",
          view["texel_count"].natural(GlbArrays::max_count) * LatticeTexture::channels,
          glb_formats::scalar_float);
    return texture;
  }

  std::vector<LatticePatch> patches(const JsonView& view, std::size_t faces) {
    input_.take_memory(faces, sizeof(LatticePatch), "patches");
    std::vector<LatticePatch> result(faces);
    if (const auto level_member = view.find("level")) {
      const auto level = std::uint32_t(level_member->natural(lattice::max_level));
      const std::uint64_t each = lattice::texel_count(int(level));
      if (faces * each > GlbArrays::max_count)
        level_member->fail("has more texels than 32 bits can count");
      for (std::size_t t = 0; t < faces; ++t) result[t] = {std::uint32_t(t * each), level};
      return result;
    }
    PassingMemory passing(input_.budget());
    const auto first =
        arrays_.read<std::uint32_t>(view, "first_texels", faces, glb_formats::scalar_u32);
    const auto levels = arrays_.read<std::uint8_t>(view, "levels", faces, glb_formats::scalar_u8);
    for (std::size_t t = 0; t < faces; ++t) result[t] = {first[t], levels[t]};
    return result;
  }

  std::vector<std::uint8_t> strips(const JsonView& view) {
    const std::vector<TexelStrip> strips = texel_strips(arrays_, view, images_end_);
    std::uint64_t count = 0;
    for (const TexelStrip& strip : strips) count += strip.texels;
    input_.take_memory(count, LatticeTexture::channels, "texels");
    std::vector<std::uint8_t> texels;
    std::size_t decoded = 0;
    if (options_.early_texels) {
      decoded = options_.early_texels->decoded_of(strips);
      if (decoded > 0) texels = std::move(*options_.early_texels).take();
    }
    texels.reserve(static_cast<std::size_t>(count) * LatticeTexture::channels);
    for (std::size_t i = decoded; i < strips.size(); ++i) {
      PassingMemory passing(input_.budget());
      const JsonView strip = view["strips"].at(i);
      const Image8 low = image(strip["images"].at(0)), high = image(strip["images"].at(1));
      const std::size_t n = strips[i].texels;
      if (low.pixels.size() < n || high.pixels.size() < n)
        strip.fail("an image has fewer than " + std::to_string(n) + " pixels");
      append_texels(std::span(low.pixels).first(n), high.pixels, texels);
    }
    return texels;
  }

  UvTextures uv_textures(const JsonView& view, const TriangleSoup& soup) {
    UvTextures textures;
    textures.uv =
        arrays_.read<glm::vec2>(view, "uv", soup.positions.size(), glb_formats::vec2_float);
    textures.material_of_face = arrays_.read<std::uint32_t>(
        view, "material_of_face", soup.triangles.size(), glb_formats::scalar_u32);
    if (view.find("rgba")) textures.vertex_rgba = colors(view, soup.positions.size());
    textures.mlp = color_mlp(view);
    const JsonView materials = view["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
      textures.materials.push_back(material(materials.at(i)));
    const JsonView images = view["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
      next_image_range(arrays_, images.at(i), images_end_);
      PassingMemory passing(input_.budget());
      const Image8& read = textures.images.emplace_back(image(images.at(i)));
      passing.keep(read.pixels.size() * sizeof read.pixels[0]);
    }
    return textures;
  }

  static UvMaterial material(const JsonView& view) {
    UvMaterial result;
    const JsonView images = view["images"];
    for (std::size_t k = 0; k < images.size(); ++k)
      result.images.push_back(std::uint32_t(images.at(k).natural(GlbArrays::max_count)));
    result.wrap_u = UvMaterial::Wrap(view["wrap_u"].one_of(layout::wraps));
    result.wrap_v = UvMaterial::Wrap(view["wrap_v"].one_of(layout::wraps));
    result.filter = UvMaterial::Filter(view["filter"].one_of(layout::filters));
    result.factor = json_vector<4, float>(view["factor"]);
    result.mask_channel = int(view["mask_channel"].natural(3));
    result.mask_threshold = view["mask_threshold"].number_float();
    return result;
  }

  Image8 image(const JsonView& reference) {
    const auto bytes = arrays_.read_at<std::byte>(image_range(arrays_, reference), "an image");
    try {
      return decode_image(bytes, arrays_.file(), input_.budget());
    } catch (const InputError& error) {
      reference.fail(error.reason(), error.hint());
    }
  }

  Input& input_;
  GlbArrays arrays_;
  JsonView extension_;
  const ReadOptions& options_;
  // Numbers of splats that are stored as points: in the file, in the layers so far, and kept.
  std::uint64_t all_splats_ = 0, read_splats_ = 0, kept_splats_ = 0;
  std::uint64_t images_end_ = 0;
};

}  // namespace

bool is_tureen_glb(const GlbContainer& glb) {
  if (!glb.json.is_object()) return false;
  const auto extensions = glb.json.find("extensions");
  return extensions != glb.json.end() && extensions->is_object() &&
         extensions->contains(tureen_extension);
}

Scene read_tureen_glb(Input& input, const ReadOptions& options) {
  return read_tureen_glb(input, read_glb_container(input), options);
}

Scene read_tureen_glb(Input& input, const GlbContainer& glb, const ReadOptions& options) {
  Scene scene = Reader(input, glb, options).scene();
  if (options.progress) options.progress(1.0);
  return scene;
}

}  // namespace tureen
