#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/output.hpp"
#include "base/output_path.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "formats/diffsoup/diffsoup_mesh.hpp"
#include "image/png.hpp"
#include "image/quantise.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/lattice_refine.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Width of the published exporter's widest image, and the largest number of rows that its viewer
/// supports on common devices, in pixels.
constexpr std::size_t lut_width = 4096, viewer_rows = 16384;

constexpr std::size_t texel_channels = LatticeTexture::channels;

/// The two images; face t begins at texel t * per_face.
struct Luts {
  int level = 0;
  Image8 first, second;

  Luts(std::size_t faces, int of_level) : level(of_level) {
    const std::size_t texels = faces * lattice::texel_count(level);
    if (faces == 0) throw UsageError("a soup without triangles cannot be a DiffSoup export");
    if (texels > max_image_pixels)
      throw UsageError(std::to_string(faces) + " faces at level " + std::to_string(level) +
                       " are " + std::to_string(texels) + " texels: an export holds " +
                       std::to_string(max_image_pixels / lattice::texel_count(level)) +
                       " faces of that level");
    const std::size_t width = std::min(lut_width, texels);
    const std::size_t height = (texels + width - 1) / width;
    first = Image8(static_cast<int>(width), static_cast<int>(height));
    second = first;
  }

  void set(std::size_t texel, const std::array<std::uint8_t, texel_channels>& bytes) {
    std::memcpy(&first.pixels[texel], bytes.data(), 4);
    std::memcpy(&second.pixels[texel], bytes.data() + 4, 4);
  }
};

std::array<std::uint8_t, texel_channels> quantised_texel(const float* values) {
  std::array<std::uint8_t, texel_channels> bytes;
  for (std::size_t c = 0; c + 1 < texel_channels; ++c) bytes[c] = quantised_unit(values[c]);
  bytes.back() = quantised_alpha(values[texel_channels - 1]);
  return bytes;
}

/// The texel of a plain colour: blend channel and latent features are 0.
std::array<std::uint8_t, texel_channels> color_texel(const glm::vec4& rgba) {
  const std::array<float, texel_channels> values{rgba.r, rgba.g, rgba.b, 0, 0, 0, 0, rgba.a};
  return quantised_texel(values.data());
}

struct FillLuts {
  const TriangleSoup& soup;
  std::vector<std::string>& notes;

  Luts operator()(const FaceColors& colors) const {
    Luts luts(soup.triangles.size(), 0);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) luts.set(3 * t + k, color_texel(colors.rgba[t]));
    return luts;
  }

  Luts operator()(const VertexColors& colors) const {
    Luts luts(soup.triangles.size(), 0);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      // Level 0 holds vertex 2, vertex 0, vertex 1, in this order.
      const glm::uvec3& corners = soup.triangles[t];
      luts.set(3 * t, color_texel(colors.rgba[corners[2]]));
      luts.set(3 * t + 1, color_texel(colors.rgba[corners[0]]));
      luts.set(3 * t + 2, color_texel(colors.rgba[corners[1]]));
    }
    return luts;
  }

  Luts operator()(const LatticeTexture& texture) const {
    Luts luts(texture.patches.size(), highest_level(texture));
    const std::size_t per_face = lattice::texel_count(luts.level);
    const bool inert = !texture.mlp;
    std::vector<float> coarse, fine(per_face * texel_channels);
    std::size_t refined = 0, blended = 0;
    for (std::size_t t = 0; t < texture.patches.size(); ++t) {
      const LatticePatch& patch = texture.patches[t];
      const bool refine = int(patch.level) < luts.level;
      if (refine) {
        coarse.resize(lattice::texel_count(int(patch.level)) * texel_channels);
        for (std::size_t i = 0; i < coarse.size(); ++i)
          coarse[i] =
              texture.value(patch.first_texel + i / texel_channels, int(i % texel_channels));
        refine_lattice(int(patch.level), luts.level, int(texel_channels), coarse, fine);
        ++refined;
      }
      for (std::size_t k = 0; k < per_face; ++k) {
        auto bytes = refine ? quantised_texel(&fine[k * texel_channels])
                            : stored_texel(texture, patch.first_texel + k);
        if (inert && bytes[3] != 0) {
          bytes[3] = 0;
          ++blended;
        }
        luts.set(t * per_face + k, bytes);
      }
    }
    if (refined > 0)
      notes.push_back(std::to_string(refined) + " of " + std::to_string(texture.patches.size()) +
                      " faces were refined to level " + std::to_string(luts.level) +
                      ", the one level of the export: the same texture but for rounding to bytes");
    if (blended > 0)
      notes.push_back("feature 3 of " + std::to_string(blended) +
                      " texels was set to 0: there is no color MLP to blend with");
    return luts;
  }

  Luts operator()(const Harmonics&) const { refuse("harmonics"); }
  Luts operator()(const UvTextures&) const { refuse("UV textures"); }

  static std::array<std::uint8_t, texel_channels> stored_texel(const LatticeTexture& texture,
                                                               std::size_t texel) {
    if (const auto* floats = std::get_if<std::vector<float>>(&texture.texels))
      return quantised_texel(&(*floats)[texel * texel_channels]);
    std::array<std::uint8_t, texel_channels> bytes;
    std::memcpy(bytes.data(),
                &std::get<std::vector<std::uint8_t>>(texture.texels)[texel * texel_channels],
                texel_channels);
    return bytes;
  }

  [[noreturn]] static void refuse(const char* what) {
    throw UsageError(std::string("a DiffSoup export cannot hold ") + what +
                     ", only lattice textures, face colours and vertex colours");
  }
};

ColorMlp inert_mlp() {
  const auto zeros = [](int inputs, int outputs) {
    return DenseLayer{inputs, outputs, std::vector<float>(std::size_t(inputs) * outputs),
                      std::vector<float>(std::size_t(outputs))};
  };
  return {.layers = {zeros(16, 16), zeros(16, 16), zeros(16, 3)},
          .encoding = DirectionEncoding::harmonics2,
          .view = ViewConvention::surface_to_eye,
          .blend_channel = 3};
}

ColorMlp exported_mlp(const TriangleSoup& soup, std::vector<std::string>& notes) {
  const auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
  if (!texture || !texture->mlp) {
    notes.emplace_back("the scene has no color MLP: an inert one was written");
    return inert_mlp();
  }
  const ColorMlp& mlp = *texture->mlp;
  const auto& layers = mlp.layers;
  if (layers.size() != 3 || layers[0].inputs != 16 || layers[1].inputs != 16 ||
      layers[2].inputs != 16 || mlp.encoding != DirectionEncoding::harmonics2 ||
      mlp.view != ViewConvention::surface_to_eye || mlp.blend_channel != 3)
    throw UsageError(
        "a DiffSoup export holds a color MLP of 16-16-16-3 on harmonics of degree 2, surface to "
        "eye, blended by feature 3, and no other");
  return mlp;
}

/// A folder that is written under a temporary name beside its final path. commit() moves it there.
class NewFolder {
 public:
  explicit NewFolder(fs::path path) : path_(std::move(path)) {
    if (path_.filename().empty()) path_ = path_.parent_path();
    std::error_code error;
    if (fs::exists(path_, error) && !is_diffsoup_export(path_) &&
        !(fs::is_directory(path_, error) && fs::is_empty(path_, error)))
      throw OutputError({path_.string()}, "exists and is not a DiffSoup export: not replaced");
    if (const std::string foreign = foreign_to_diffsoup_export(path_); !foreign.empty())
      throw OutputError({path_.string()},
                        "not replaced: it holds " + foreign + ", which is not part of an export");
#ifndef __EMSCRIPTEN__  // it has no links
    path_ = writable_folder(path_);
#endif
    temporary_ = temporary_beside(path_);
    if (!fs::create_directory(temporary_, error))
      throw OutputError({path_.string()}, "cannot be created: " + error.message());
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  }

  fs::path file(const char* name) const { return temporary_ / name; }

  /// The same error with the file's final path in place of the temporary one.
  OutputError in_place(const OutputError& error) const {
    return {{(path_ / fs::path(error.position().file).filename()).string()},
            error.reason(),
            error.hint()};
  }

  void commit() {
    replace_folder(temporary_, path_);
    temporary_.clear();
  }

 private:
  fs::path path_, temporary_;
};

void write_json(const fs::path& path, const nlohmann::json& json, int indent) {
  write_file(path, json.dump(indent) + "\n");
}

void write_files(const NewFolder& target, const Luts& luts, const ColorMlp& mlp,
                 const std::vector<glm::vec3>& positions, const TriangleSoup& soup,
                 const SceneInfo& info) {
  {
    Output output(target.file("mesh.ply"));
    write_diffsoup_mesh(output, positions, soup.triangles);
    output.commit();
  }
  write_file(target.file("lut0.png"), encode_png(luts.first));
  write_file(target.file("lut1.png"), encode_png(luts.second));
  write_json(target.file("mlp_weights.json"),
             {{"W1", mlp.layers[0].weights},
              {"b1", mlp.layers[0].biases},
              {"W2", mlp.layers[1].weights},
              {"b2", mlp.layers[1].biases},
              {"W3", mlp.layers[2].weights},
              {"b3", mlp.layers[2].biases}},
             -1);
  const glm::vec3 &up = info.up, &background = info.background;
  write_json(target.file("meta.json"),
             {{"up", {up.x, up.y, up.z}},
              {"level", luts.level},
              {"background", {background.x, background.y, background.z}},
              {"num_faces", soup.triangles.size()},
              {"num_verts", positions.size()},
              {"writer", "tureen"}},
             2);
}

}  // namespace

std::vector<std::string> write_diffsoup_export(const Scene& scene, const fs::path& folder) {
  const Layer& layer = only_layer(scene);
  const auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
  if (!soup) throw UsageError("a DiffSoup export cannot hold splats");
  assert(!defect(*soup));
  if (!is_translation(layer) && depends_on_view(layer))
    throw UsageError(
        "a DiffSoup export cannot hold a layer that is rotated, scaled or mirrored and whose "
        "colours depend on the view",
        "write a .glb");
  std::vector<std::string> notes;
  const Luts luts = std::visit(FillLuts{*soup, notes}, soup->appearance);
  const ColorMlp mlp = exported_mlp(*soup, notes);
  // The exporter's indices are signed.
  if (soup->positions.size() > 0x7fffffffu)
    throw UsageError(std::to_string(soup->positions.size()) +
                     " vertices are too many for a DiffSoup export");
  if (std::size_t(luts.first.height) > viewer_rows)
    notes.push_back("the images have " + std::to_string(luts.first.height) +
                    " rows: viewers in browsers often stop at " + std::to_string(viewer_rows));
  std::vector<glm::vec3> positions = soup->positions;
  if (!is_translation(layer)) {
    positions = baked_positions(positions, layer);
    notes.emplace_back(
        "the layer's rotation, scale or mirror was applied to its vertices, which rounds them");
  }
  if (const glm::dvec3 origin = origin_of(layer); origin != glm::dvec3(0.0)) {
    for (glm::vec3& p : positions) p = glm::vec3(origin + glm::dvec3(p));
    notes.emplace_back("the scene's origin was added to its vertices, which rounds them");
  }
  if (!scene.cameras.empty()) notes.emplace_back("cameras are not kept");
  if (scene.first_view) notes.emplace_back("the first view is not kept");
  if (!soup->normals.empty()) notes.emplace_back("normals are not kept");
  if (layer.material) notes.emplace_back("mirrors and glass are not kept");

  NewFolder target(folder);
  try {
    write_files(target, luts, mlp, positions, *soup, scene.info);
  } catch (const OutputError& error) {
    throw target.in_place(error);
  }
  target.commit();
  return notes;
}

}  // namespace tureen
