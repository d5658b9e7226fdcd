#include "oracle/uv_sampling.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::oracle {

namespace {

/// An equivalent coordinate in [0, 2], so that texel indices fit an int.
double reduced(double coordinate, UvMaterial::Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0;
  switch (wrap) {
    case UvMaterial::Wrap::repeat:
      return coordinate - std::floor(coordinate);
    case UvMaterial::Wrap::mirror:
      return coordinate - 2.0 * std::floor(coordinate / 2.0);
    case UvMaterial::Wrap::clamp:
      return std::clamp(coordinate, 0.0, 1.0);
  }
  return 0.0;
}

/// The texel index in [0, size) for an index that may be outside.
int wrapped(int index, int size, UvMaterial::Wrap wrap) {
  switch (wrap) {
    case UvMaterial::Wrap::repeat:
      return (index % size + size) % size;
    case UvMaterial::Wrap::mirror: {
      const int within = (index % (2 * size) + 2 * size) % (2 * size);
      return within < size ? within : 2 * size - 1 - within;
    }
    case UvMaterial::Wrap::clamp:
      return std::clamp(index, 0, size - 1);
  }
  return 0;
}

}  // namespace

glm::dvec4 sample(const Image8& image, const UvMaterial& material, glm::dvec2 uv) {
  const auto texel = [&](int x, int y) {
    return glm::dvec4(image.at(wrapped(x, image.width, material.wrap_u),
                               wrapped(y, image.height, material.wrap_v))) /
           255.0;
  };
  double x = reduced(uv.x, material.wrap_u) * image.width;
  double y = reduced(uv.y, material.wrap_v) * image.height;
  if (material.filter == UvMaterial::Filter::nearest)
    return texel(int(std::floor(x)), int(std::floor(y)));
  x -= 0.5;
  y -= 0.5;
  const int column = int(std::floor(x)), row = int(std::floor(y));
  const double right = x - column, down = y - row;
  return (1 - down) * ((1 - right) * texel(column, row) + right * texel(column + 1, row)) +
         down * ((1 - right) * texel(column, row + 1) + right * texel(column + 1, row + 1));
}

}  // namespace tureen::oracle
