// Vectors in untrusted JSON: arrays of exactly N numbers. Include it only in sources.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <type_traits>

#include "base/json/json_view.hpp"

namespace tureen {

template <int N, class Real>
glm::vec<N, Real> json_vector(const JsonView& view) {
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

}  // namespace tureen
