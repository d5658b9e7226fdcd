#include "soup/baked_color.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "soup/lattice.hpp"
#include "soup/mlp_over_directions.hpp"
#include "soup/quantise.hpp"
#include "soup/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr int direction_count = 32;
constexpr int max_coefficients = 9;  // of degree 2

/// The matrix that makes least-squares coefficients of the colours from bake_directions():
/// (B^T B)^-1 B^T, a row a coefficient, by Gauss-Jordan on the normal equations. Uniform directions
/// leave B^T B near a multiple of the identity: no pivots.
class Fit {
 public:
  explicit Fit(int degree) : count_(harmonics::count(degree)) {
    const std::vector<glm::vec3> directions = bake_directions();
    std::array<std::array<double, max_coefficients + direction_count>, max_coefficients> rows{};
    for (int i = 0; i < direction_count; ++i) {
      const auto basis = harmonics::basis(glm::dvec3(directions[i]));
      for (int k = 0; k < count_; ++k) {
        for (int m = 0; m < count_; ++m) rows[k][m] += basis[k] * basis[m];
        rows[k][count_ + i] = basis[k];
      }
    }
    const int width = count_ + direction_count;
    for (int k = 0; k < count_; ++k) {
      const double inverse = 1.0 / rows[k][k];
      for (int j = 0; j < width; ++j) rows[k][j] *= inverse;
      for (int m = 0; m < count_; ++m) {
        if (m == k) continue;
        const double factor = rows[m][k];
        for (int j = 0; j < width; ++j) rows[m][j] -= factor * rows[k][j];
      }
    }
    for (int k = 0; k < count_; ++k)
      for (int i = 0; i < direction_count; ++i) matrix_[k][i] = float(rows[k][count_ + i]);
  }

  int count() const { return count_; }

  glm::vec3 coefficient(int k, const std::array<glm::vec3, direction_count>& colors) const {
    glm::vec3 sum(0.0f);
    for (int i = 0; i < direction_count; ++i) sum += matrix_[k][i] * colors[i];
    return sum;
  }

 private:
  int count_;
  std::array<std::array<float, direction_count>, max_coefficients> matrix_{};
};

/// Which texels are a corner of a cell that has any visible point: the cells that touch an alpha of
/// alpha_threshold or more.
std::vector<bool> texels_that_show(const LatticeTexture& texture) {
  std::vector<bool> shows(texture.texel_count(), false);
  for (const LatticePatch& patch : texture.patches) {
    const int n = lattice::resolution(int(patch.level));
    const auto index = [&](int x, int y) { return patch.first_texel + lattice::texel_index(x, y); };
    const auto cell = [&](std::size_t a, std::size_t b, std::size_t c) {
      const auto visible = [&](std::size_t texel) {
        return texture.value(texel, LatticeTexture::features) >= alpha_threshold;
      };
      if (visible(a) || visible(b) || visible(c)) shows[a] = shows[b] = shows[c] = true;
    };
    for (int y = 0; y < n; ++y)
      for (int x = 0; x + y < n; ++x) {
        cell(index(x + 1, y), index(x, y + 1), index(x, y));
        if (x + y + 1 < n) cell(index(x + 1, y), index(x, y + 1), index(x + 1, y + 1));
      }
  }
  return shows;
}

class Baker {
 public:
  Baker(const LatticeTexture& texture, const BakeOptions& options)
      : texture_(texture),
        mlp_(*texture.mlp),
        options_(options),
        fit_(options.degree),
        over_(mlp_, bake_directions()),
        shows_(texels_that_show(texture)) {}

  LatticeTexture run() {
    LatticeTexture result;
    result.patches = texture_.patches;
    std::visit([&](const auto& values) { bake(values, result); }, texture_.texels);
    return result;
  }

 private:
  using Coefficients = std::array<glm::vec3, max_coefficients>;

  Coefficients coefficients(std::size_t texel) const {
    std::array<float, LatticeTexture::features> f;
    for (int c = 0; c < LatticeTexture::features; ++c) f[c] = texture_.value(texel, c);
    std::array<glm::vec3, direction_count> colors;
    over_.predict(f, colors);
    if (mlp_.blend_channel) {
      const float blend = f[*mlp_.blend_channel];
      for (glm::vec3& color : colors)
        color = (1.0f - blend) * glm::vec3(f[0], f[1], f[2]) + blend * color;
    }
    Coefficients result{};
    for (int k = 0; k < fit_.count(); ++k) result[k] = fit_.coefficient(k, colors);
    return result;
  }

  /// See baked_color(). Small but above 0 where nothing depends on the direction.
  float scale() const {
    float largest = 1e-6f;
    for (std::size_t texel = 0; texel < shows_.size(); texel += 16) {
      if (!shows_[texel]) continue;
      const Coefficients c = coefficients(texel);
      for (int k = 1; k < fit_.count(); ++k)
        largest = std::max({largest, std::abs(c[k].x), std::abs(c[k].y), std::abs(c[k].z)});
    }
    return 1.25f * largest;
  }

  template <class Value>
  void bake(const std::vector<Value>& values, LatticeTexture& result) const {
    constexpr bool bytes = sizeof(Value) == 1;
    using Signed = std::conditional_t<bytes, std::int8_t, float>;
    constexpr int channels = LatticeTexture::channels;
    std::vector<Value> texels(values.size(), Value(0));
    std::vector<Signed> bands(shows_.size() * std::size_t(3 * (fit_.count() - 1)), Signed(0));
    const float band_scale = bytes && options_.degree > 0 ? scale() : 1.0f;
    Signed* band = bands.data();
    for (std::size_t texel = 0; texel < shows_.size(); ++texel) {
      if (options_.progress && texel % 16384 == 0)
        options_.progress(double(texel) / double(shows_.size()));
      const Value* from = &values[texel * channels];
      Value* to = &texels[texel * channels];
      to[LatticeTexture::features] = from[LatticeTexture::features];
      if (!shows_[texel]) {
        std::copy_n(from, 3, to);
        band += 3 * (fit_.count() - 1);
        continue;
      }
      const Coefficients c = coefficients(texel);
      for (int k = 0; k < 3; ++k) {
        const float constant = std::clamp(float(harmonics::y00) * c[0][k], 0.0f, 1.0f);
        if constexpr (bytes)
          to[k] = quantised_unit(constant);
        else
          to[k] = constant;
      }
      for (int i = 1; i < fit_.count(); ++i)
        for (int k = 0; k < 3; ++k) {
          if constexpr (bytes)
            *band++ = quantised_signed(c[i][k], band_scale);
          else
            *band++ = c[i][k];
        }
    }
    result.texels = std::move(texels);
    if (options_.degree > 0)
      result.harmonics = LatticeHarmonics{.degree = options_.degree,
                                          .view = ViewConvention::surface_to_eye,
                                          .coefficients = std::move(bands),
                                          .scale = band_scale};
  }

  const LatticeTexture& texture_;
  const ColorMlp& mlp_;
  const BakeOptions& options_;
  Fit fit_;
  MlpOverDirections over_;
  std::vector<bool> shows_;
};

}  // namespace

std::vector<glm::vec3> bake_directions() {
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  std::vector<glm::vec3> directions;
  for (int i = 0; i < direction_count; ++i) {
    const double z = 1 - (2 * i + 1) / double(direction_count), r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z);
  }
  return directions;
}

LatticeTexture baked_color(const LatticeTexture& texture, const BakeOptions& options) {
  assert(0 <= options.degree && options.degree <= 2);
  if (!texture.mlp) return texture;
  return Baker(texture, options).run();
}

LatticeTexture base_color(LatticeTexture texture) {
  texture.mlp.reset();
  return texture;
}

}  // namespace tureen
