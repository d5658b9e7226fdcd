#include "tracing/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::tracing {

namespace {

/// The mean of the values at the face's vertices, in a form that keeps equal values exactly.
template <class Value>
auto mean_of_vertices(const TriangleSoup& soup, const FacePoint& point, const Value& value) {
  const glm::uvec3& t = soup.triangles[point.face];
  const auto last = value(t[2]);
  return last + point.b0 * (value(t[0]) - last) + point.b1 * (value(t[1]) - last);
}

glm::dvec4 mean_color(const TriangleSoup& soup, const std::vector<glm::vec4>& rgba,
                      const FacePoint& point) {
  return mean_of_vertices(soup, point, [&](std::uint32_t v) { return glm::dvec4(rgba[v]); });
}

// -- lattices -------------------------------------------------------------------------------------

/// One channel of a lattice at a point of its face.
class LatticeAt {
 public:
  LatticeAt(const LatticeTexture& texture, const FacePoint& point)
      : texture_(texture),
        patch_(texture.patches[point.face]),
        at_(lattice::footprint(int(patch_.level), std::clamp(point.b0, 0.0, 1.0),
                               std::clamp(point.b1, 0.0, 1.0))) {}

  double value(int channel) const {
    const auto texel = [&](std::size_t corner) {
      return double(texture_.value(patch_.first_texel + at_.texels[corner], channel));
    };
    return lattice::interpolated(at_.weights, texel(0), texel(1), texel(2));
  }

 private:
  const LatticeTexture& texture_;
  const LatticePatch& patch_;
  lattice::Footprint<double> at_;
};

// -- textures -------------------------------------------------------------------------------------

/// The texel that a coordinate outside the image means.
int inside(double texel, int size, UvMaterial::Wrap wrap) {
  if (wrap == UvMaterial::Wrap::clamp) return int(std::clamp(texel, 0.0, double(size - 1)));
  const double period = wrap == UvMaterial::Wrap::mirror ? 2.0 * size : size;
  double within = std::fmod(texel, period);
  if (within < 0) within += period;
  return int(within < size ? within : 2.0 * size - 1 - within);
}

glm::dvec4 texture_at(const Image8& image, const UvMaterial& material, const glm::dvec2& uv) {
  // Images without end have a value everywhere, but none at infinity.
  const auto finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
  double x = finite(uv.x) * image.width, y = finite(uv.y) * image.height;
  const auto texel = [&](double column, double row) {
    return glm::dvec4(image.at(inside(column, image.width, material.wrap_u),
                               inside(row, image.height, material.wrap_v))) /
           255.0;
  };
  if (material.filter == UvMaterial::Filter::nearest) return texel(std::floor(x), std::floor(y));
  x -= 0.5;
  y -= 0.5;
  const double column = std::floor(x), row = std::floor(y);
  return glm::mix(glm::mix(texel(column, row), texel(column + 1, row), x - column),
                  glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - column),
                  y - row);
}

glm::dvec4 texture_of(const TriangleSoup& soup, const UvTextures& textures, std::size_t image,
                      const FacePoint& point) {
  const UvMaterial& material = textures.materials[textures.material_of_face[point.face]];
  const glm::dvec2 uv =
      mean_of_vertices(soup, point, [&](std::uint32_t v) { return glm::dvec2(textures.uv[v]); });
  return texture_at(textures.images[material.images[image]], material, uv);
}

glm::dvec4 factor_of(const TriangleSoup& soup, const UvTextures& textures, const FacePoint& point) {
  const glm::dvec4 factor(textures.materials[textures.material_of_face[point.face]].factor);
  return textures.vertex_rgba.empty() ? factor
                                      : factor * mean_color(soup, textures.vertex_rgba, point);
}

// -- harmonics ------------------------------------------------------------------------------------

/// Of a face or vertex at `place`.
glm::dvec3 color_of_element(const Harmonics& harmonics, std::size_t element,
                            const glm::dvec3& place, const ViewOfPoint& view) {
  glm::dvec3 from_eye = place - view.eye;
  const double distance = glm::length(from_eye);
  from_eye = distance > 0 ? from_eye / distance : glm::dvec3(0, 0, 1);
  if (distance > 0 && harmonics.view == ViewConvention::surface_to_eye) from_eye = -from_eye;
  const auto basis = harmonics::basis(from_eye);
  const auto bands = std::size_t(harmonics::count(harmonics.degree));
  glm::dvec3 sum(0.5);
  for (std::size_t k = 0; k < bands; ++k)
    sum += basis[k] * glm::dvec3(harmonics.coefficients[element * bands + k]);
  return glm::clamp(sum, 0.0, 1.0);
}

struct Visible {
  const TriangleSoup& soup;
  const FacePoint& point;

  bool operator()(const FaceColors& colors) const {
    return colors.rgba[point.face].a >= alpha_threshold;
  }
  bool operator()(const VertexColors& colors) const {
    return mean_color(soup, colors.rgba, point).a >= double(alpha_threshold);
  }
  bool operator()(const Harmonics&) const { return true; }
  bool operator()(const LatticeTexture& texture) const {
    return LatticeAt(texture, point).value(LatticeTexture::features) >= double(alpha_threshold);
  }
  bool operator()(const UvTextures& textures) const {
    const UvMaterial& material = textures.materials[textures.material_of_face[point.face]];
    if (material.mask_threshold == 0) return true;
    glm::dvec4 value(1.0);
    if (!material.images.empty()) value = texture_of(soup, textures, 0, point);
    if (!textures.mlp) value *= factor_of(soup, textures, point);
    return value[material.mask_channel] >= double(material.mask_threshold);
  }
};

struct Color {
  const TriangleSoup& soup;
  const FacePoint& point;
  const ViewOfPoint& view;

  glm::dvec3 operator()(const FaceColors& colors) const {
    return glm::dvec3(colors.rgba[point.face]);
  }
  glm::dvec3 operator()(const VertexColors& colors) const {
    return glm::dvec3(mean_color(soup, colors.rgba, point));
  }
  glm::dvec3 operator()(const Harmonics& harmonics) const {
    const auto position = [&](std::uint32_t v) { return glm::dvec3(soup.positions[v]); };
    if (harmonics.domain == Harmonics::Domain::vertex)
      return mean_of_vertices(soup, point, [&](std::uint32_t v) {
        return color_of_element(harmonics, v, position(v), view);
      });
    const glm::uvec3& t = soup.triangles[point.face];
    const glm::dvec3 centroid = (position(t[0]) + position(t[1]) + position(t[2])) / 3.0;
    return color_of_element(harmonics, point.face, centroid, view);
  }
  glm::dvec3 operator()(const LatticeTexture& texture) const {
    const LatticeAt at(texture, point);
    double features[LatticeTexture::features];
    for (int channel = 0; channel < LatticeTexture::features; ++channel)
      features[channel] = at.value(channel);
    if (texture.mlp) return evaluate(*texture.mlp, features, view.to_eye);
    return {features[0], features[1], features[2]};
  }
  glm::dvec3 operator()(const UvTextures& textures) const {
    const UvMaterial& material = textures.materials[textures.material_of_face[point.face]];
    if (textures.mlp) {
      double features[8];
      for (int i = 0; i < 2; ++i) {
        const glm::dvec4 value = texture_of(soup, textures, std::size_t(i), point);
        for (int channel = 0; channel < 4; ++channel) features[4 * i + channel] = value[channel];
      }
      return evaluate(*textures.mlp, features, view.to_eye);
    }
    glm::dvec4 color = factor_of(soup, textures, point);
    if (!material.images.empty()) color *= texture_of(soup, textures, 0, point);
    return glm::dvec3(color);
  }
};

}  // namespace

bool is_visible(const TriangleSoup& soup, const FacePoint& point) {
  return std::visit(Visible{soup, point}, soup.appearance);
}

glm::dvec3 surface_color(const TriangleSoup& soup, const FacePoint& point,
                         const ViewOfPoint& view) {
  glm::dvec3 color = std::visit(Color{soup, point, view}, soup.appearance);
  // This order of the arguments turns NaN into 0.
  for (int c = 0; c < 3; ++c) color[c] = std::min(std::max(0.0, color[c]), 1.0);
  return color;
}

}  // namespace tureen::tracing
