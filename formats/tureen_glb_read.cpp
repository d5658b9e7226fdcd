// Reads TUREEN_triangle_soup: the JSON says where each array lies, and each is read from there
// straight into the scene. In a file of our writer that goes forward only.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "formats/glb_container.hpp"
#include "formats/image_budget.hpp"
#include "formats/json_view.hpp"
#include "formats/png.hpp"
#include "formats/slim_geometry.hpp"
#include "formats/slim_texels.hpp"
#include "formats/tureen_glb.hpp"
#include "formats/tureen_glb_layout.hpp"
#include "formats/tureen_glb_preset.hpp"
#include "soup/lattice.hpp"
#include "soup/spherical_harmonics.hpp"

namespace tureen {

namespace {

namespace layout = glb_layout;

/// No index and no count of ours passes this: vertices are named by 32 bits.
constexpr std::uint64_t max_count = std::numeric_limits<std::uint32_t>::max();

class Reader {
 public:
  Reader(Input& input, const GlbContainer& glb, const ReadOptions& options)
      : input_(input),
        glb_(glb),
        options_(options),
        root_(glb.json, input.name()),
        extension_(root_["extensions"][tureen_extension]) {}

  Scene scene() {
    const std::uint64_t version = extension_["version"].natural();
    if (version < std::uint64_t(tureen_extension_version) ||
        version > std::uint64_t(tureen_slim_version))
      extension_["version"].fail("this file has version " + std::to_string(version) + " of " +
                                 tureen_extension + "; only versions " +
                                 std::to_string(tureen_extension_version) + " to " +
                                 std::to_string(tureen_slim_version) + " are read");
    Scene scene;
    read_info(scene);
    const JsonView appearance = extension_["appearance"];
    TriangleSoup soup;
    read_geometry(soup);
    read_preset(scene, soup);
    if (appearance["type"].text() == "soft_triangles") {
      scene.primitives = soft_triangles(appearance, std::move(soup));
    } else {
      soup.appearance = read_appearance(appearance, soup);
      if (const auto reason = defect(soup)) extension_.fail(*reason);
      scene.primitives = std::move(soup);
    }
    progress(1.0);
    return scene;
  }

 private:
  /// Where the elements of an accessor, or the bytes of a buffer view, lie in the file.
  struct Location {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };

  Location view_location(const JsonView& view) const {
    if (view["buffer"].natural() != 0) view.fail("is not in the binary chunk");
    const std::uint64_t size = view["byteLength"].natural();
    const auto offset_member = view.find("byteOffset");
    const std::uint64_t offset = offset_member ? offset_member->natural() : 0;
    if (offset > glb_.binary_size || size > glb_.binary_size - offset)
      view.fail("bytes " + std::to_string(offset) + " + " + std::to_string(size) +
                " lie outside of the binary chunk of " + std::to_string(glb_.binary_size));
    return {glb_.binary_offset + offset, size};
  }

  struct Format {
    const char* type;
    std::size_t components;
  };

  /// Tightly packed elements of exactly this type. The count is returned in elements.
  Location accessor_location(const JsonView& accessor, const Format& format, int component,
                             std::uint64_t& count) const {
    if (accessor["type"].text() != format.type)
      accessor["type"].fail(std::string("expected ") + format.type);
    if (accessor["componentType"].natural() != std::uint64_t(component))
      accessor["componentType"].fail("expected " + std::to_string(component));
    if (accessor.find("sparse")) accessor.fail("is sparse, which this extension does not use");
    const std::size_t component_bytes = component == layout::unsigned_byte ? 1 : 4;
    const std::size_t each = component_bytes * format.components;
    count = accessor["count"].natural(std::numeric_limits<std::uint64_t>::max() / 64);
    const JsonView view = root_["bufferViews"].at(index(accessor["bufferView"]));
    if (const auto stride = view.find("byteStride"); stride && stride->natural() != each)
      view.fail("has a stride, but this extension packs tightly");
    Location location = view_location(view);
    const auto offset_member = accessor.find("byteOffset");
    const std::uint64_t offset = offset_member ? offset_member->natural() : 0;
    if (offset > location.size || count > (location.size - offset) / each)
      accessor.fail(std::to_string(count) + " elements of " + std::to_string(each) +
                    " bytes do not fit into its buffer view of " + std::to_string(location.size));
    return {location.offset + offset, count * each};
  }

  static std::size_t index(const JsonView& view) {
    return static_cast<std::size_t>(view.natural(max_count));
  }

  JsonView accessor(const JsonView& reference) const {
    return root_["accessors"].at(index(reference));
  }

  /// The array that `holder` names by `key`, or an empty one where it names none.
  template <class T>
  std::vector<T> array(const JsonView& holder, const char* key, const Format& format,
                       int component) {
    const auto reference = holder.find(key);
    if (!reference) return {};
    std::uint64_t count = 0;
    const Location location = accessor_location(accessor(*reference), format, component, count);
    input_.seek(location.offset);
    auto values = input_.read_values<T>(location.size / sizeof(T), key);
    progress();
    return values;
  }

  /// The same, and exactly `count` of `T`, which is `per_element` of the accessor's elements.
  template <class T>
  std::vector<T> array_of(const JsonView& holder, const char* key, std::uint64_t count,
                          const Format& format, int component, std::uint64_t per_element = 1) {
    if (const auto reference = holder.find(key)) {
      std::uint64_t have = 0;
      accessor_location(accessor(*reference), format, component, have);
      if (have != count * per_element)
        reference->fail("its accessor has " + std::to_string(have) + " elements, expected " +
                        std::to_string(count * per_element));
    } else if (count != 0) {
      holder.fail(std::string("lacks \"") + key + "\"");
    }
    return array<T>(holder, key, format, component);
  }

  /// The bytes of the buffer view that `reference` names.
  std::vector<std::byte> buffer_view(const JsonView& reference) {
    const Location location = view_location(root_["bufferViews"].at(index(reference)));
    input_.seek(location.offset);
    auto bytes = input_.read_values<std::byte>(location.size, "slim bytes");
    progress();
    return bytes;
  }

  std::vector<glm::vec4> colors(const JsonView& holder, std::uint64_t count) {
    static constexpr Format vec4{"VEC4", 4};
    const auto reference = holder.find("rgba");
    if (!reference ||
        accessor(*reference)["componentType"].natural() == std::uint64_t(layout::float32))
      return array_of<glm::vec4>(holder, "rgba", count, vec4, layout::float32);
    std::uint64_t have = 0;
    const Location location =
        accessor_location(accessor(*reference), vec4, layout::unsigned_byte, have);
    if (have != count)
      reference->fail("its accessor has " + std::to_string(have) + " elements, expected " +
                      std::to_string(count));
    input_.seek(location.offset);
    std::vector<glm::vec4> result(static_cast<std::size_t>(count));
    // Block by block, so that the bytes do not stand beside all of the floats.
    std::array<glm::u8vec4, 4096> block;
    for (std::size_t done = 0; done < result.size();) {
      const std::size_t n = std::min(block.size(), result.size() - done);
      input_.read(std::as_writable_bytes(std::span(block).first(n)), "rgba");
      for (std::size_t i = 0; i < n; ++i) result[done + i] = glm::vec4(block[i]) / 255.0f;
      done += n;
    }
    progress();
    return result;
  }

  template <int N, class Real>
  static glm::vec<N, Real> vector(const JsonView& view) {
    if (view.size() != std::size_t(N)) view.fail("expected " + std::to_string(N) + " numbers");
    glm::vec<N, Real> result;
    for (int i = 0; i < N; ++i) {
      if constexpr (std::is_same_v<Real, float>)
        result[i] = view.at(i).number_float();
      else
        result[i] = view.at(i).number();
    }
    return result;
  }

  void read_info(Scene& scene) const {
    SceneInfo& info = scene.info;
    info.name = extension_["name"].text();
    info.source = extension_["source"].text();
    const JsonView notes = extension_["notes"];
    for (std::size_t i = 0; i < notes.size(); ++i) info.notes.push_back(notes.at(i).text());
    info.up = vector<3, float>(extension_["up"]);
    if (info.up == glm::vec3(0.0f)) extension_["up"].fail("has no direction");
    info.background = vector<3, float>(extension_["background"]);
    scene.origin = vector<3, double>(extension_["origin"]);
    const JsonView cameras = extension_["cameras"];
    for (std::size_t i = 0; i < cameras.size(); ++i) scene.cameras.push_back(camera(cameras.at(i)));
  }

  /// Pictures of any other size cannot be drawn, and a driver may do worse than say so.
  static int side(const JsonView& view) {
    const std::uint64_t pixels = view.natural(max_image_side);
    if (pixels == 0) view.fail("a picture without pixels");
    return int(pixels);
  }

  static Camera camera(const JsonView& view) {
    Camera result;
    result.name = view["name"].text();
    result.width = side(view["width"]);
    result.height = side(view["height"]);
    result.fx = view["fx"].number();
    result.fy = view["fy"].number();
    result.cx = view["cx"].number();
    result.cy = view["cy"].number();
    const JsonView matrix = view["view_from_world"];
    if (matrix.size() != 16) matrix.fail("expected 16 numbers");
    for (int i = 0; i < 16; ++i) result.view_from_world[i / 4][i % 4] = matrix.at(i).number();
    return result;
  }

  void read_geometry(TriangleSoup& soup) {
    const std::uint64_t vertices = extension_["vertex_count"].natural(max_count);
    const std::uint64_t faces = extension_["face_count"].natural(max_count);
    if (const auto slim = extension_.find("slim_geometry")) {
      SlimGeometry geometry = decode_slim_geometry(buffer_view(*slim), std::size_t(vertices),
                                                   std::size_t(faces), input_.name());
      soup.positions = std::move(geometry.positions);
      soup.triangles = std::move(geometry.triangles);
      return;
    }
    soup.positions =
        array_of<glm::vec3>(extension_, "positions", vertices, {"VEC3", 3}, layout::float32);
    if (faces > 0 && !extension_.find("triangles")) {
      if (vertices != 3 * faces)
        extension_.fail(std::to_string(faces) + " faces without \"triangles\" want " +
                        std::to_string(3 * faces) + " vertices, not " + std::to_string(vertices));
      soup.triangles.resize(static_cast<std::size_t>(faces));
      for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        soup.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
      return;
    }
    soup.triangles = array_of<glm::uvec3>(extension_, "triangles", faces, {"SCALAR", 1},
                                          layout::unsigned_int, 3);
  }

  void read_preset(Scene& scene, const TriangleSoup& soup) {
    const auto view = extension_.find("preset");
    if (!view) return;
    RenderPreset preset = tureen::read_preset(*view);
    if (view->find("keeps_face"))
      preset.keeps_face = array_of<std::uint8_t>(*view, "keeps_face", soup.triangles.size(),
                                                 {"SCALAR", 1}, layout::unsigned_byte);
    if (const auto reason = defect(preset, soup)) view->fail(*reason);
    scene.preset = std::move(preset);
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

  Harmonics harmonics(const JsonView& view, const TriangleSoup& soup) {
    Harmonics sh;
    sh.domain = Harmonics::Domain(view["domain"].one_of(layout::domains));
    sh.degree = degree(view);
    sh.view = ViewConvention(view["view"].one_of(layout::view_conventions));
    const std::size_t elements =
        sh.domain == Harmonics::Domain::face ? soup.triangles.size() : soup.positions.size();
    sh.coefficients =
        array_of<glm::vec3>(view, "coefficients", elements, {"VEC3", 3}, layout::float32,
                            std::uint64_t(harmonics::count(sh.degree)));
    return sh;
  }

  SoftTriangles soft_triangles(const JsonView& view, TriangleSoup soup) {
    const std::size_t faces = soup.triangles.size();
    if (extension_.find("triangles")) extension_.fail("soft triangles share no vertices");
    SoftTriangles soft;
    soft.positions = std::move(soup.positions);
    soft.degree = degree(view);
    soft.coefficients =
        array_of<glm::vec3>(view, "coefficients", faces, {"VEC3", 3}, layout::float32,
                            std::uint64_t(harmonics::count(soft.degree)));
    soft.sigma = array_of<float>(view, "sigma", faces, {"SCALAR", 1}, layout::float32);
    soft.opacity = array_of<float>(view, "opacity", faces, {"SCALAR", 1}, layout::float32);
    return soft;
  }

  std::optional<ColorMlp> color_mlp(const JsonView& holder) {
    const auto view = holder.find("color_mlp");
    if (!view) return std::nullopt;
    ColorMlp mlp;
    mlp.encoding = DirectionEncoding((*view)["encoding"].one_of(layout::direction_encodings));
    mlp.view = ViewConvention((*view)["view"].one_of(layout::view_conventions));
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
      layer.weights = array_of<float>(entry, "weights", std::uint64_t(layer.inputs * layer.outputs),
                                      {"SCALAR", 1}, layout::float32);
      layer.biases = array_of<float>(entry, "biases", std::uint64_t(layer.outputs), {"SCALAR", 1},
                                     layout::float32);
      mlp.layers.push_back(std::move(layer));
    }
    return mlp;
  }

  LatticeTexture lattice_texture(const JsonView& view, const TriangleSoup& soup) {
    if (const auto slim = view.find("slim_texels")) {
      // The network lies before the texels.
      std::optional<ColorMlp> mlp = color_mlp(view);
      LatticeTexture texture =
          decode_slim_texels(buffer_view(*slim), soup.triangles.size(), input_.name());
      texture.mlp = std::move(mlp);
      return texture;
    }
    LatticeTexture texture;
    texture.patches = patches(view, soup.triangles.size());
    texture.mlp = color_mlp(view);
    const std::uint64_t texels = view["texel_count"].natural(max_count);
    if (view.find("strips"))
      texture.texels = strips(view["strips"], texels);
    else
      texture.texels = array_of<float>(view, "texels", texels, {"SCALAR", 1}, layout::float32,
                                       LatticeTexture::channels);
    return texture;
  }

  std::vector<LatticePatch> patches(const JsonView& view, std::size_t faces) {
    std::vector<LatticePatch> result(faces);
    if (const auto level_member = view.find("level")) {
      const auto level = std::uint32_t(level_member->natural(lattice::max_level));
      const std::uint64_t each = lattice::texel_count(int(level));
      if (faces * each > max_count) level_member->fail("has more texels than 32 bits can name");
      for (std::size_t t = 0; t < faces; ++t) result[t] = {std::uint32_t(t * each), level};
      return result;
    }
    const auto first =
        array_of<std::uint32_t>(view, "first_texels", faces, {"SCALAR", 1}, layout::unsigned_int);
    const auto levels =
        array_of<std::uint8_t>(view, "levels", faces, {"SCALAR", 1}, layout::unsigned_byte);
    for (std::size_t t = 0; t < faces; ++t) result[t] = {first[t], levels[t]};
    return result;
  }

  std::vector<std::uint8_t> strips(const JsonView& list, std::uint64_t texels) {
    // Every strip is bounded and follows the one before; deflate packs at most 1032 to 1, so a
    // count that the images cannot hold is refused before anything is allocated for it.
    std::uint64_t counted = 0, encoded = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonView strip = list.at(i);
      if (strip["first"].natural() != counted)
        strip["first"].fail("expected " + std::to_string(counted));
      counted += strip["count"].natural(layout::strip_texels);
      if (strip["images"].size() != 2) strip["images"].fail("expected two images");
      for (int k = 0; k < 2; ++k) encoded += next_image(strip["images"].at(k)).size;
    }
    if (counted != texels)
      list.fail("its strips hold " + std::to_string(counted) + " texels, expected " +
                std::to_string(texels));
    if (texels * LatticeTexture::channels / 1032 > encoded)
      list.fail(std::to_string(texels) + " texels are more than its images can hold");

    std::vector<std::uint8_t> result(static_cast<std::size_t>(texels) * LatticeTexture::channels);
    std::uint8_t* texel = result.data();
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonView strip = list.at(i);
      const auto count = static_cast<std::size_t>(strip["count"].natural());
      const Image8 low = image(strip["images"].at(0)), high = image(strip["images"].at(1));
      if (low.pixels.size() < count || high.pixels.size() < count)
        strip.fail("an image has fewer than " + std::to_string(count) + " pixels");
      for (std::size_t k = 0; k < count; ++k, texel += LatticeTexture::channels)
        for (int c = 0; c < 4; ++c) {
          texel[c] = low.pixels[k][c];
          texel[4 + c] = high.pixels[k][c];
        }
    }
    return result;
  }

  UvTextures uv_textures(const JsonView& view, const TriangleSoup& soup) {
    UvTextures textures;
    textures.uv =
        array_of<glm::vec2>(view, "uv", soup.positions.size(), {"VEC2", 2}, layout::float32);
    textures.material_of_face = array_of<std::uint32_t>(
        view, "material_of_face", soup.triangles.size(), {"SCALAR", 1}, layout::unsigned_int);
    if (view.find("rgba")) textures.vertex_rgba = colors(view, soup.positions.size());
    textures.mlp = color_mlp(view);
    const JsonView materials = view["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
      textures.materials.push_back(material(materials.at(i)));
    const JsonView images = view["images"];
    ImageBudget budget;
    for (std::size_t i = 0; i < images.size(); ++i) {
      next_image(images.at(i));
      textures.images.push_back(image(images.at(i)));
      if (!budget.take(textures.images.back())) images.at(i).fail(image_budget_reason);
    }
    return textures;
  }

  static UvMaterial material(const JsonView& view) {
    UvMaterial result;
    const JsonView images = view["images"];
    for (std::size_t k = 0; k < images.size(); ++k)
      result.images.push_back(std::uint32_t(images.at(k).natural(max_count)));
    result.wrap_u = UvMaterial::Wrap(view["wrap_u"].one_of(layout::wraps));
    result.wrap_v = UvMaterial::Wrap(view["wrap_v"].one_of(layout::wraps));
    result.filter = UvMaterial::Filter(view["filter"].one_of(layout::filters));
    result.factor = vector<4, float>(view["factor"]);
    result.mask_channel = int(view["mask_channel"].natural(3));
    result.mask_threshold = view["mask_threshold"].number_float();
    return result;
  }

  Location image_location(const JsonView& reference) const {
    const JsonView image = root_["images"].at(index(reference));
    return view_location(root_["bufferViews"].at(index(image["bufferView"])));
  }

  /// Images lie in the order in which they are named, each after the last: a small file cannot
  /// name the same bytes over and over and so fill the memory.
  Location next_image(const JsonView& reference) {
    const Location location = image_location(reference);
    if (location.offset < images_end_) reference.fail("lies before the end of the image before it");
    images_end_ = location.offset + location.size;
    return location;
  }

  Image8 image(const JsonView& reference) {
    const Location location = image_location(reference);
    input_.seek(location.offset);
    const auto bytes = input_.read_values<std::byte>(location.size, "an image");
    progress();
    try {
      return decode_image(bytes, input_.name());
    } catch (const InputError& error) {
      reference.fail(error.reason());
    }
  }

  void progress() const { progress(double(input_.position()) / double(input_.size())); }
  void progress(double fraction) const {
    if (options_.progress) options_.progress(fraction);
  }

  Input& input_;
  const GlbContainer& glb_;
  const ReadOptions& options_;
  JsonView root_;
  JsonView extension_;
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
  return Reader(input, glb, options).scene();
}

}  // namespace tureen
