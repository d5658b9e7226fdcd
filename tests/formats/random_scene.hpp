// Random scenes of every appearance, and a bitwise comparison of scenes.
#pragma once

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "scene/edit/moved_normals.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::test {

class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : engine_(seed) {}

  float real(float low = 0.0f, float high = 1.0f) {
    return std::uniform_real_distribution<float>(low, high)(engine_);
  }
  unsigned whole(unsigned below) {
    return std::uniform_int_distribution<unsigned>(0, below - 1)(engine_);
  }
  std::vector<glm::vec4> colors(std::size_t count, bool bytes) {
    std::vector<glm::vec4> result(count);
    for (glm::vec4& c : result)
      for (int k = 0; k < 4; ++k) c[k] = bytes ? float(whole(256)) / 255.0f : real();
    return result;
  }

  /// Unshared: every face has its own vertices. Shared: a third as many vertices.
  TriangleSoup geometry(std::size_t faces, bool shared) {
    TriangleSoup soup;
    soup.positions.resize(shared ? faces + 2 : 3 * faces);
    for (glm::vec3& p : soup.positions) p = {real(-2, 2), real(-2, 2), real(-2, 2)};
    for (unsigned t = 0; t < faces; ++t) {
      const auto n = unsigned(soup.positions.size());
      soup.triangles.push_back(shared ? glm::uvec3(whole(n), whole(n), whole(n))
                                      : glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2));
    }
    return soup;
  }

  /// Of unit length, except that the first is zero.
  std::vector<glm::vec3> normals(std::size_t count) {
    std::vector<glm::vec3> result(count);
    for (std::size_t i = 1; i < count; ++i)
      result[i] = unit_or_zero({real(-1, 1), real(-1, 1), real(0.1f, 1)});
    return result;
  }
  Material material() {
    const glm::vec3 color(real(), real(), real());
    return whole(2) ? Material{.base_color = color, .metallic = real(0.5f, 1), .roughness = 0.05f}
                    : Material{.base_color = color,
                               .metallic = 0.25f,
                               .roughness = real(0, 0.1f),
                               .transmission = real(0.5f, 1),
                               .ior = real(1, 3)};
  }

  ColorMlp mlp(std::vector<int> widths, DirectionEncoding encoding, std::optional<int> blend) {
    ColorMlp result;
    result.encoding = encoding;
    result.view = whole(2) ? ViewConvention::surface_to_eye : ViewConvention::eye_to_surface;
    result.blend_channel = blend;
    for (std::size_t i = 0; i + 1 < widths.size(); ++i) {
      DenseLayer layer{widths[i], widths[i + 1], {}, {}};
      for (int k = 0; k < layer.inputs * layer.outputs; ++k) layer.weights.push_back(real(-1, 1));
      for (int k = 0; k < layer.outputs; ++k) layer.biases.push_back(real(-1, 1));
      result.layers.push_back(std::move(layer));
    }
    return result;
  }
  ColorMlp diffsoup_mlp() { return mlp({16, 16, 16, 3}, DirectionEncoding::harmonics2, 3); }

  Harmonics harmonics(std::size_t elements, Harmonics::Domain domain, int degree) {
    Harmonics sh{domain, degree, ViewConvention::eye_to_surface, {}};
    sh.coefficients.resize(elements * harmonics::count(degree));
    for (glm::vec3& c : sh.coefficients) c = {real(-1, 1), real(-1, 1), real(-1, 1)};
    return sh;
  }

  /// One level for all (uniform), or a random one a face in random order with shared texels.
  LatticeTexture lattice_texture(std::size_t faces, std::optional<int> level, bool floats) {
    LatticeTexture texture;
    std::uint32_t texels = 0;
    for (std::size_t t = 0; t < faces; ++t) {
      const auto own = level ? std::uint32_t(*level) : whole(lattice::max_level + 1);
      if (!level && t > 0 && whole(3) == 0) {
        texture.patches.push_back(texture.patches[whole(unsigned(t))]);
        continue;
      }
      texture.patches.push_back({texels, own});
      texels += lattice::texel_count(int(own));
    }
    const std::size_t values = std::size_t(texels) * LatticeTexture::channels;
    if (floats) {
      std::vector<float> all(values);
      for (float& v : all) v = real();
      texture.texels = std::move(all);
    } else {
      std::vector<std::uint8_t> all(values);
      for (std::uint8_t& v : all) v = std::uint8_t(whole(256));
      texture.texels = std::move(all);
    }
    return texture;
  }

  Image8 image(int width, int height) {
    Image8 result(width, height);
    for (glm::u8vec4& p : result.pixels) p = {whole(256), whole(256), whole(256), whole(256)};
    return result;
  }

  UvTextures uv_textures(const TriangleSoup& soup, bool mlp_features) {
    UvTextures textures;
    for (std::size_t i = 0; i < soup.positions.size(); ++i)
      textures.uv.emplace_back(real(-1, 2), real(-1, 2));
    textures.images = {image(5, 7), image(5, 7), image(1, 3)};
    for (unsigned i = 0; i < 3; ++i) {
      UvMaterial material;
      if (mlp_features) {
        material.images = {0, 1};
      } else if (i > 0) {
        material.images = {i};
      }
      material.wrap_u = UvMaterial::Wrap(whole(3));
      material.wrap_v = UvMaterial::Wrap(whole(3));
      material.filter = UvMaterial::Filter(whole(2));
      material.factor = {real(), real(), real(), real()};
      material.mask_channel = int(whole(4));
      material.mask_threshold = real();
      textures.materials.push_back(material);
    }
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      textures.material_of_face.push_back(whole(3));
    if (mlp_features)
      textures.mlp = mlp({11, 16, 16, 3}, DirectionEncoding::xyz, {});
    else
      textures.vertex_rgba = colors(soup.positions.size(), whole(2) == 0);
    return textures;
  }

  Splats windows(std::size_t splats, int degree) {
    TriangleWindows windows;
    windows.corners = geometry(splats, false).positions;
    SplatColor color{degree, harmonics(splats, Harmonics::Domain::face, degree).coefficients};
    for (std::size_t i = 0; i < splats; ++i) {
      windows.sigma.push_back(real(0.01f, 3));
      windows.opacity.push_back(real());
    }
    return {std::move(windows), std::move(color), *profile_named("triangle-splatting")};
  }

  /// The same with a colour at each corner.
  Splats windows_with_corner_colors(std::size_t splats, int degree) {
    Splats result = windows(splats, degree);
    result.color = splat_color(3 * splats, degree);
    result.color.per_corner = true;
    return result;
  }

  /// Splats with Gaussians, flat ones if the profile needs them.
  Splats gaussians(std::size_t splats, int degree, const char* profile, bool flat) {
    Gaussians gaussians;
    gaussians.flat = flat;
    for (std::size_t i = 0; i < splats; ++i) {
      gaussians.centers.emplace_back(real(-2, 2), real(-2, 2), real(-2, 2));
      gaussians.scales.emplace_back(real(), real(0, 1e-3f), flat ? 0.0f : real(0, 100));
      gaussians.rotations.push_back(rotation());
      gaussians.opacity.push_back(real());
    }
    return {std::move(gaussians), splat_color(splats, degree), *profile_named(profile)};
  }

  Splats neural_densities(std::size_t splats, int degree) {
    NeuralDensities densities;
    densities.omega = real(1, 60);
    for (std::size_t i = 0; i < splats; ++i) {
      densities.centers.emplace_back(real(-2, 2), real(-2, 2), real(-2, 2));
      densities.semi_axes.emplace_back(real(0.1f, 1), real(0.1f, 1), real(0.1f, 1));
      densities.rotations.push_back(rotation());
    }
    for (std::size_t k = 0; k < splats * NeuralDensities::parameters; ++k)
      densities.networks.push_back(real(-3, 3));
    return {std::move(densities), splat_color(splats, degree), *profile_named("splatnet")};
  }

  glm::quat rotation() {
    return glm::normalize(glm::quat(real(0.1f, 1), real(-1, 1), real(-1, 1), real(-1, 1)));
  }

  SplatColor splat_color(std::size_t splats, int degree) {
    return {degree, harmonics(splats, Harmonics::Domain::face, degree).coefficients};
  }

  /// A scene with one layer, an empty soup; all other members have values.
  Scene scene() {
    Scene result = scene_of(TriangleSoup{}, {1e6 + 1.0 / 3.0, -0.1, 1e-300});
    result.info = {.name = "a \"soup\" of \xC3\xBC",
                   .up = {0.0f, 0.6f, 0.8f},
                   .background = {real(), real(), -0.0f},
                   .source = "test",
                   .remarks = {},
                   .notes = {"first", "second\nline"}};
    for (const char* name : {"one", ""}) {
      Camera camera = look_at({real(), real(), 3}, {0, 0, 0}, {0, 1, 0}, 0.7, 640, 480);
      camera.name = name;
      camera.cx += 1.0 / 3.0;
      result.cameras.push_back(camera);
    }
    return result;
  }

 private:
  std::mt19937 engine_;
};

/// Equality bit by bit: -0 differs from 0, and a NaN equals itself.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
template <class T>
bool same_bits(const T& a, const T& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): it compares bits on purpose
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

inline bool same(const std::optional<ColorMlp>& a, const std::optional<ColorMlp>& b) {
  if (!a || !b) return !a && !b;
  if (a->encoding != b->encoding || a->view != b->view || a->blend_channel != b->blend_channel ||
      a->layers.size() != b->layers.size())
    return false;
  for (std::size_t i = 0; i < a->layers.size(); ++i)
    if (a->layers[i].inputs != b->layers[i].inputs ||
        a->layers[i].outputs != b->layers[i].outputs ||
        !same_bits(a->layers[i].weights, b->layers[i].weights) ||
        !same_bits(a->layers[i].biases, b->layers[i].biases))
      return false;
  return true;
}

struct SameAppearance {
  bool operator()(const FaceColors& a, const FaceColors& b) { return same_bits(a.rgba, b.rgba); }
  bool operator()(const VertexColors& a, const VertexColors& b) {
    return same_bits(a.rgba, b.rgba);
  }
  bool operator()(const Harmonics& a, const Harmonics& b) {
    return a.domain == b.domain && a.degree == b.degree && a.view == b.view &&
           same_bits(a.coefficients, b.coefficients);
  }
  bool operator()(const LatticeTexture& a, const LatticeTexture& b) {
    return same_bits(a.patches, b.patches) && a.texels.index() == b.texels.index() &&
           a.texels == b.texels && same(a.mlp, b.mlp);
  }
  bool operator()(const UvTextures& a, const UvTextures& b) {
    if (!same_bits(a.uv, b.uv) || !same_bits(a.material_of_face, b.material_of_face) ||
        !same_bits(a.vertex_rgba, b.vertex_rgba) || !same(a.mlp, b.mlp) ||
        a.materials.size() != b.materials.size() || a.images.size() != b.images.size())
      return false;
    for (std::size_t i = 0; i < a.images.size(); ++i)
      if (a.images[i].width != b.images[i].width || a.images[i].height != b.images[i].height ||
          !same_bits(a.images[i].pixels, b.images[i].pixels))
        return false;
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
      const UvMaterial &m = a.materials[i], &n = b.materials[i];
      if (m.images != n.images || m.wrap_u != n.wrap_u || m.wrap_v != n.wrap_v ||
          m.filter != n.filter || !same_bits(m.factor, n.factor) ||
          m.mask_channel != n.mask_channel || !same_bits(m.mask_threshold, n.mask_threshold))
        return false;
    }
    return true;
  }
  template <class A, class B>
  bool operator()(const A&, const B&) {
    return false;
  }
};

struct SamePrimitives {
  bool operator()(const TriangleSoup& a, const TriangleSoup& b) {
    return same_bits(a.positions, b.positions) && same_bits(a.triangles, b.triangles) &&
           same_bits(a.normals, b.normals) &&
           std::visit(SameAppearance{}, a.appearance, b.appearance);
  }
  bool operator()(const Splats& a, const Splats& b) {
    return all_of(a.kernel) == all_of(b.kernel) && a.color.degree == b.color.degree &&
           a.color.per_corner == b.color.per_corner &&
           same_bits(a.color.coefficients, b.color.coefficients) && a.profile == b.profile;
  }
  /// The bits of a kernel, and the numbers of its values.
  static std::vector<std::uint32_t> all_of(const SplatKernel& kernel) {
    std::vector<std::uint32_t> result{std::uint32_t(kernel.index())};
    const auto add = [&](const void* values, std::size_t bytes) {
      result.push_back(std::uint32_t(bytes));
      result.resize(result.size() + bytes / 4);
      if (bytes > 0) std::memcpy(&result[result.size() - bytes / 4], values, bytes);
    };
    for_each_column(kernel, [&](const auto& column) {
      add(column.values.data(), column.values.size() * sizeof column.values[0]);
    });
    const auto constant = [&](const char*, float value) { add(&value, sizeof value); };
    std::visit([&](const auto& each) { for_each_constant(each, constant); }, kernel);
    const std::string name = kernel_name(kernel);  // also for Gaussians::flat
    result.insert(result.end(), name.begin(), name.end());
    return result;
  }
  template <class A, class B>
  bool operator()(const A&, const B&) {
    return false;
  }
};

inline bool same(const Camera& a, const Camera& b) {
  return a.name == b.name && a.width == b.width && a.height == b.height && same_bits(a.fx, b.fx) &&
         same_bits(a.fy, b.fy) && same_bits(a.cx, b.cx) && same_bits(a.cy, b.cy) &&
         same_bits(a.view_from_world, b.view_from_world);
}

/// Name of the first difference, or "".
inline std::string difference(const Scene& a, const Scene& b) {
  if (a.layers.size() != b.layers.size()) return "number of layers";
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    const Layer &of_a = a.layers[i], &of_b = b.layers[i];
    const std::string layer = " of layer " + std::to_string(i);
    if (!std::visit(SamePrimitives{}, of_a.primitives, of_b.primitives))
      return "primitives" + layer;
    if (!same_bits(of_a.world_from_layer, of_b.world_from_layer)) return "world_from_layer" + layer;
    if (of_a.material != of_b.material) return "material" + layer;
    if (of_a.name != of_b.name || of_a.visible != of_b.visible) return "name or visible" + layer;
  }
  if (a.info.name != b.info.name || a.info.source != b.info.source) return "name or source";
  if (a.info.notes != b.info.notes) return "notes";
  if (!same_bits(a.info.up, b.info.up)) return "up";
  if (!same_bits(a.info.background, b.info.background)) return "background";
  if (a.quality != b.quality) return "quality";
  if (a.cameras.size() != b.cameras.size()) return "number of cameras";
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    if (!same(a.cameras[i], b.cameras[i])) return "camera " + std::to_string(i);
  return "";
}

}  // namespace tureen::test
