#include "tests/support/random_soups.hpp"

#include <algorithm>
#include <cmath>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::test {

namespace {

glm::vec3 random_point(Random& random, glm::dvec3 center, double size) {
  return glm::vec3(center + size * glm::dvec3(random.normal(), random.normal(), random.normal()));
}

glm::vec3 random_rgb(Random& random) {
  return {float(random.uniform()), float(random.uniform()), float(random.uniform())};
}

void add_geometry(Random& random, const SoupOptions& options, TriangleSoup& soup) {
  const auto center = [&] { return std::cbrt(random.uniform()) * random.direction(); };
  const int pool = std::max(3, options.faces / 2 + 2);
  if (options.shared_vertices)
    for (int v = 0; v < pool; ++v)
      soup.positions.push_back(random_point(random, center(), options.size));
  for (int t = 0; t < options.faces; ++t) {
    glm::uvec3 triangle;
    if (options.shared_vertices) {
      // Neighbours in the pool, so that consecutive faces share edges, as in a strip.
      for (int k = 0; k < 3; ++k) triangle[k] = std::uint32_t((t / 2 + k) % pool);
      if (t % 2) std::swap(triangle[0], triangle[2]), triangle[1] = (triangle[1] + 2) % pool;
    } else {
      const glm::dvec3 c = center();
      for (int k = 0; k < 3; ++k) {
        triangle[k] = std::uint32_t(soup.positions.size());
        soup.positions.push_back(random_point(random, c, options.size));
      }
    }
    if (options.degenerate && t % 4 == 1) {
      glm::vec3& a = soup.positions[triangle[0]];
      glm::vec3& b = soup.positions[triangle[1]];
      glm::vec3& c = soup.positions[triangle[2]];
      switch (random.below(4)) {
        case 0:
          c = b;
          break;  // two corners coincide
        case 1:
          b = c = a;
          break;  // all three corners coincide
        case 2:
          c = a + 2.0f * (b - a);
          break;  // on a line, up to rounding
        default:
          c = b + 1e-5f * random_rgb(random);
          break;  // a needle
      }
    }
    soup.triangles.push_back(triangle);
  }
}

// -- appearances -------------------------------------------------------------------------------

/// Usually any value; otherwise 0, 1, or a value on either side of the threshold.
float random_alpha(Random& random) {
  switch (random.below(8)) {
    case 0:
      return 0.0f;
    case 1:
      return 0.4375f;
    case 2:
      return 0.5f;
    case 3:
    case 4:
      return 1.0f;
    default:
      return float(random.uniform());
  }
}

FaceColors face_colors(Random& random, std::size_t faces) {
  FaceColors colors;
  for (std::size_t t = 0; t < faces; ++t) {
    const glm::vec3 rgb = random_rgb(random);
    colors.rgba.emplace_back(rgb, random_alpha(random));
  }
  return colors;
}

std::vector<glm::vec4> vertex_rgba(Random& random, std::size_t vertices) {
  std::vector<glm::vec4> rgba;
  for (std::size_t v = 0; v < vertices; ++v) {
    const glm::vec3 rgb = random_rgb(random);
    rgba.emplace_back(rgb, float(random.uniform(0.25, 1.0)));
  }
  return rgba;
}

Harmonics random_harmonics(Random& random, const SoupOptions& options, Harmonics::Domain domain,
                           std::size_t elements) {
  Harmonics sh{
      .domain = domain, .degree = options.degree, .view = options.view, .coefficients = {}};
  for (std::size_t e = 0; e < elements; ++e)
    for (int i = 0; i < harmonics::count(options.degree); ++i) {
      // The constant band varies so much that some colours clamp at both ends.
      const double deviation = i == 0 ? 1.0 : 0.15;
      glm::vec3 c;
      for (int k = 0; k < 3; ++k) c[k] = float(deviation * random.normal());
      sh.coefficients.push_back(c);
    }
  return sh;
}

/// Values of one face's lattice, in one of the styles that plans distinguish.
void add_patch(Random& random, int level, std::vector<float>& values) {
  enum Style { noise, smooth, affine, constant, opaque, transparent, styles };
  const auto style = Style(random.below(styles));
  double base[LatticeTexture::channels], slope[LatticeTexture::channels][2];
  for (int c = 0; c < LatticeTexture::channels; ++c) {
    base[c] = random.uniform(0.3, 0.7);
    for (double& s : slope[c]) s = style == constant ? 0.0 : random.uniform(-0.3, 0.3);
  }
  const double fall = random.uniform(0.5, 1.8);
  const int n = lattice::resolution(level);
  for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
    const auto [x, y] = lattice::texel_coordinates(i);
    const double b0 = double(x) / n, b1 = double(y) / n;
    for (int c = 0; c < LatticeTexture::channels; ++c) {
      double value = base[c] + slope[c][0] * b0 + slope[c][1] * b1;
      const bool alpha = c == LatticeTexture::features;
      if (style == noise || (style >= opaque && !alpha)) value = random.uniform();
      if (alpha && style == smooth)
        value = 1.2 - 3.0 * fall * std::hypot(b0 - 1.0 / 3, b1 - 1.0 / 3);
      if (alpha && style == opaque) value = random.uniform(0.55, 1.0);
      if (alpha && style == transparent) value = random.uniform(0.0, 0.45);
      values.push_back(float(std::clamp(value, 0.0, 1.0)));
    }
  }
}

LatticeTexture lattice_texture(Random& random, const SoupOptions& options) {
  LatticeTexture texture;
  std::vector<float> values;
  for (int t = 0; t < options.faces; ++t) {
    if (t > 0 && random.chance(0.05)) {  // shares another face's texels
      const LatticePatch shared = texture.patches[random.below(std::uint32_t(t))];
      texture.patches.push_back(shared);
      continue;
    }
    const int level =
        options.level >= 0 ? options.level : int(random.below(lattice::max_level + 1));
    texture.patches.push_back(
        {std::uint32_t(values.size() / LatticeTexture::channels), std::uint32_t(level)});
    add_patch(random, level, values);
  }
  if (options.float_texels) {
    texture.texels = std::move(values);
  } else {
    std::vector<std::uint8_t> bytes;
    for (const float value : values) bytes.push_back(std::uint8_t(value * 255.0f + 0.5f));
    texture.texels = std::move(bytes);
  }
  return texture;
}

Image8 random_image(Random& random, int width, int height) {
  Image8 image(width, height);
  for (glm::u8vec4& pixel : image.pixels)
    for (int c = 0; c < 4; ++c) pixel[c] = std::uint8_t(random.below(256));
  return image;
}

UvTextures uv_textures(Random& random, const SoupOptions& options, std::size_t vertices,
                       bool with_mlp) {
  using Wrap = UvMaterial::Wrap;
  UvTextures textures;
  for (std::size_t v = 0; v < vertices; ++v)
    textures.uv.emplace_back(float(random.uniform(-1.5, 2.5)), float(random.uniform(-1.5, 2.5)));
  // Sizes that are not powers of two. Consecutive images have equal sizes, for feature pairs.
  for (const auto& [width, height] : {std::pair{8, 8}, {5, 11}, {1, 3}})
    for (int i = 0; i < 2; ++i) textures.images.push_back(random_image(random, width, height));
  const Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
  for (int m = 0; m < 7; ++m) {
    UvMaterial material;
    const std::uint32_t image = 2 * random.below(3);
    if (with_mlp)
      material.images = {image, image + 1};
    else if (m > 0)  // the first has only its factor
      material.images = {image + random.below(2)};
    material.wrap_u = wraps[m % 3];
    material.wrap_v = wraps[random.below(3)];
    material.filter = options.filter;
    if (!with_mlp && m % 2 == 0)
      material.factor = glm::vec4(random_rgb(random), float(random.uniform(0.5, 1.0)));
    material.mask_channel = with_mlp ? int(random.below(4)) : 3;
    material.mask_threshold = m % 3 == 0 ? 0.0f : float(random.uniform(0.2, 0.6));
    textures.materials.push_back(material);
  }
  for (int t = 0; t < options.faces; ++t)
    textures.material_of_face.push_back(random.below(std::uint32_t(textures.materials.size())));
  if (with_mlp)
    textures.mlp = random_uv_mlp(random);
  else if (random.chance(0.5))
    textures.vertex_rgba = vertex_rgba(random, vertices);
  return textures;
}

ColorMlp random_mlp(Random& random, int inputs) {
  ColorMlp mlp;
  for (const auto& [in, out] : {std::pair{inputs, 16}, {16, 16}, {16, 3}}) {
    DenseLayer layer{in, out, {}, {}};
    const double deviation = out == 3 ? 0.5 : 0.35;
    for (int i = 0; i < in * out; ++i) layer.weights.push_back(float(deviation * random.normal()));
    for (int i = 0; i < out; ++i) layer.biases.push_back(float(0.1 * random.normal()));
    mlp.layers.push_back(std::move(layer));
  }
  return mlp;
}

}  // namespace

std::string to_string(Kind kind) {
  switch (kind) {
    case Kind::face_colors:
      return "FaceColors";
    case Kind::vertex_colors:
      return "VertexColors";
    case Kind::face_harmonics:
      return "FaceHarmonics";
    case Kind::vertex_harmonics:
      return "VertexHarmonics";
    case Kind::lattice:
      return "Lattice";
    case Kind::lattice_mlp:
      return "LatticeMlp";
    case Kind::uv_textures:
      return "UvTextures";
    case Kind::uv_textures_mlp:
      return "UvTexturesMlp";
  }
  return {};
}

ColorMlp random_lattice_mlp(Random& random) {
  ColorMlp mlp = random_mlp(random, 16);
  mlp.encoding = DirectionEncoding::harmonics2;
  mlp.view = ViewConvention::surface_to_eye;
  mlp.blend_channel = 3;
  return mlp;
}

ColorMlp random_uv_mlp(Random& random) {
  ColorMlp mlp = random_mlp(random, 11);
  mlp.encoding = DirectionEncoding::xyz;
  mlp.view = ViewConvention::eye_to_surface;
  return mlp;
}

TriangleSoup random_soup(std::uint64_t seed, const SoupOptions& options) {
  Random random(seed);
  TriangleSoup soup;
  add_geometry(random, options, soup);
  const std::size_t faces = soup.triangles.size(), vertices = soup.positions.size();
  switch (options.kind) {
    case Kind::face_colors:
      soup.appearance = face_colors(random, faces);
      break;
    case Kind::vertex_colors:
      soup.appearance = VertexColors{vertex_rgba(random, vertices)};
      break;
    case Kind::face_harmonics:
      soup.appearance = random_harmonics(random, options, Harmonics::Domain::face, faces);
      break;
    case Kind::vertex_harmonics:
      soup.appearance = random_harmonics(random, options, Harmonics::Domain::vertex, vertices);
      break;
    case Kind::lattice:
      soup.appearance = lattice_texture(random, options);
      break;
    case Kind::lattice_mlp: {
      LatticeTexture texture = lattice_texture(random, options);
      texture.mlp = random_lattice_mlp(random);
      soup.appearance = std::move(texture);
      break;
    }
    case Kind::uv_textures:
      soup.appearance = uv_textures(random, options, vertices, false);
      break;
    case Kind::uv_textures_mlp:
      soup.appearance = uv_textures(random, options, vertices, true);
      break;
  }
  return soup;
}

Camera random_camera(Random& random, int width, int height) {
  const glm::dvec3 eye = random.uniform(2.2, 4.0) * random.direction();
  const glm::dvec3 target = 0.3 * random.direction();
  Camera camera = look_at(eye, target, random.direction(), random.uniform(0.5, 1.0), width, height);
  camera.cx += random.uniform(-0.1, 0.1) * width;
  camera.cy += random.uniform(-0.1, 0.1) * height;
  camera.fx *= random.uniform(0.9, 1.1);
  return camera;
}

}  // namespace tureen::test
