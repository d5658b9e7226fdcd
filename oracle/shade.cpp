#include "oracle/shade.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "oracle/uv_sampling.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::oracle {

namespace {

/// Linear interpolation over the face, in a form that reproduces constants exactly.
template <class T>
T interpolated(const std::array<T, 3>& at_vertices, const SurfacePoint& p) {
  return at_vertices[2] + p.b0 * (at_vertices[0] - at_vertices[2]) +
         p.b1 * (at_vertices[1] - at_vertices[2]);
}

template <class Values>
auto over_vertices(const TriangleSoup& soup, const SurfacePoint& p, const Values& value_of) {
  const glm::uvec3& t = soup.triangles[p.face];
  return interpolated(std::array{value_of(t[0]), value_of(t[1]), value_of(t[2])}, p);
}

glm::dvec4 interpolated_rgba(const TriangleSoup& soup, const std::vector<glm::vec4>& rgba,
                             const SurfacePoint& p) {
  return over_vertices(soup, p, [&](std::uint32_t v) { return glm::dvec4(rgba[v]); });
}

// -- lattices ----------------------------------------------------------------------------------

lattice::Footprint<double> footprint_at(const LatticePatch& patch, const SurfacePoint& p) {
  // As in simplex.glsl.
  const double b0 = std::max(p.b0, 0.0), b1 = std::max(p.b1, 0.0), sum = std::max(b0 + b1, 1.0);
  return lattice::footprint(int(patch.level), b0 / sum, b1 / sum);
}

double texel(const LatticeTexture& texture, std::size_t index, int channel) {
  const std::size_t i = index * LatticeTexture::channels + channel;
  if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&texture.texels))
    return (*bytes)[i] / 255.0;
  return std::get<std::vector<float>>(texture.texels)[i];
}

double sampled(const LatticeTexture& texture, const LatticePatch& patch,
               const lattice::Footprint<double>& at, int channel) {
  double v[3];
  for (int k = 0; k < 3; ++k)
    v[k] = texel(texture, patch.first_texel + std::size_t(at.texels[k]), channel);
  return lattice::interpolated(at.weights, v[0], v[1], v[2]);
}

// -- harmonics ---------------------------------------------------------------------------------

glm::dvec3 harmonics_color(const Harmonics& sh, std::size_t element, glm::dvec3 eye_to_element) {
  const double distance = glm::length(eye_to_element);
  glm::dvec3 d(0, 0, 1);
  if (distance > 0)
    d = (sh.view == ViewConvention::eye_to_surface ? 1.0 : -1.0) * eye_to_element / distance;
  const auto basis = harmonics::basis(d);
  const std::size_t count = harmonics::count(sh.degree);
  glm::dvec3 sum(0.5);
  for (std::size_t i = 0; i < count; ++i)
    sum += basis[i] * glm::dvec3(sh.coefficients[element * count + i]);
  return glm::clamp(sum, 0.0, 1.0);
}

// -- visibility and colour of each appearance --------------------------------------------------

struct IsVisible {
  const TriangleSoup& soup;
  const SurfacePoint& p;

  bool operator()(const FaceColors& a) const { return a.rgba[p.face].a >= alpha_threshold; }
  bool operator()(const VertexColors& a) const {
    return interpolated_rgba(soup, a.rgba, p).a >= alpha_threshold;
  }
  bool operator()(const Harmonics&) const { return true; }
  bool operator()(const LatticeTexture& a) const {
    const LatticePatch& patch = a.patches[p.face];
    return sampled(a, patch, footprint_at(patch, p), LatticeTexture::features) >= alpha_threshold;
  }
  bool operator()(const UvTextures& a) const {
    const UvMaterial& material = a.materials[a.material_of_face[p.face]];
    if (material.mask_threshold == 0) return true;
    glm::dvec4 value(1.0);
    if (!material.images.empty())
      value = sample(a.images[material.images[0]], material, uv_at(soup, a, p));
    if (!a.mlp) value *= tint(soup, a, material, p);
    return value[material.mask_channel] >= material.mask_threshold;
  }

  static glm::dvec2 uv_at(const TriangleSoup& soup, const UvTextures& a, const SurfacePoint& p) {
    return over_vertices(soup, p, [&](std::uint32_t v) { return glm::dvec2(a.uv[v]); });
  }
  static glm::dvec4 tint(const TriangleSoup& soup, const UvTextures& a, const UvMaterial& material,
                         const SurfacePoint& p) {
    glm::dvec4 value(material.factor);
    if (!a.vertex_rgba.empty()) value *= interpolated_rgba(soup, a.vertex_rgba, p);
    return value;
  }
};

struct ColorOf {
  const TriangleSoup& soup;
  const SurfacePoint& p;
  glm::dvec3 to_eye;
  glm::dvec3 eye;

  glm::dvec3 operator()(const FaceColors& a) const { return glm::dvec3(a.rgba[p.face]); }
  glm::dvec3 operator()(const VertexColors& a) const {
    return glm::dvec3(interpolated_rgba(soup, a.rgba, p));
  }
  glm::dvec3 operator()(const Harmonics& a) const {
    const auto from_eye = [&](std::uint32_t v) { return glm::dvec3(soup.positions[v]) - eye; };
    if (a.domain == Harmonics::Domain::vertex)
      return over_vertices(soup, p,
                           [&](std::uint32_t v) { return harmonics_color(a, v, from_eye(v)); });
    const glm::uvec3& t = soup.triangles[p.face];
    return harmonics_color(a, p.face, (from_eye(t[0]) + from_eye(t[1]) + from_eye(t[2])) / 3.0);
  }
  glm::dvec3 operator()(const LatticeTexture& a) const {
    const LatticePatch& patch = a.patches[p.face];
    const auto at = footprint_at(patch, p);
    std::array<double, LatticeTexture::features> features;
    for (int c = 0; c < LatticeTexture::features; ++c) features[c] = sampled(a, patch, at, c);
    if (a.mlp) return evaluate(*a.mlp, features, to_eye);
    return {features[0], features[1], features[2]};
  }
  glm::dvec3 operator()(const UvTextures& a) const {
    const UvMaterial& material = a.materials[a.material_of_face[p.face]];
    const glm::dvec2 uv = IsVisible::uv_at(soup, a, p);
    glm::dvec4 values[2] = {glm::dvec4(1.0), glm::dvec4(1.0)};
    for (std::size_t i = 0; i < material.images.size(); ++i)
      values[i] = sample(a.images[material.images[i]], material, uv);
    if (!a.mlp) return glm::dvec3(values[0] * IsVisible::tint(soup, a, material, p));
    std::array<double, 8> features;
    for (int c = 0; c < 8; ++c) features[c] = values[c / 4][c % 4];
    return evaluate(*a.mlp, features, to_eye);
  }
};

}  // namespace

bool is_visible(const TriangleSoup& soup, const SurfacePoint& point) {
  return std::visit(IsVisible{soup, point}, soup.appearance);
}

glm::dvec3 color(const TriangleSoup& soup, const SurfacePoint& point, glm::dvec3 to_eye,
                 glm::dvec3 eye) {
  glm::dvec3 value = std::visit(ColorOf{soup, point, to_eye, eye}, soup.appearance);
  // This order of the arguments turns NaN into 0.
  for (int c = 0; c < 3; ++c) value[c] = std::min(std::max(0.0, value[c]), 1.0);
  return value;
}

}  // namespace tureen::oracle
