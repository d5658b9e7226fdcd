// Formulas that exist in C++ and in GLSL return the same numbers. Each runs on the device, with one
// input per pixel.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "image/heat_map.hpp"
#include "runtime/debug_views/debug_view.hpp"
#include "runtime/gl/api.hpp"
#include "runtime/passes/texel_store.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random.hpp"
#include "tests/support/shader_probe.hpp"

namespace tureen::test {
namespace shader_math_test {

class ShaderMath : public testing::TestWithParam<NamedContext> {
 protected:
  gl::Context context_ = gl::Context::create(GetParam().request);
  gl::Api api() const { return GetParam().request.api; }
};

TEST_P(ShaderMath, LatticeFootprintsAreThoseOfTheModel) {
  Random random(1);
  std::vector<glm::vec4> inputs;
  for (const float b0 : {0.0f, 1.0f, 0.5f, -1e-7f, 1.0f + 1e-7f})
    for (const float b1 : {0.0f, 1.0f, 0.5f, -1e-7f, 1.0f + 1e-7f})
      inputs.emplace_back(b0, b1, 0, 0);
  while (inputs.size() < 2000) {
    const double b0 = random.uniform(), b1 = random.uniform();
    inputs.emplace_back(b0 + b1 > 1 ? 1 - b0 : b0, b0 + b1 > 1 ? 1 - b1 : b1, 0, 0);
  }
  for (int level = 0; level <= lattice::max_level; ++level) {
    const std::string head =
        "#include \"lattice.glsl\"\n"
        "vec4 probe(vec4 x) { LatticeFootprint at = lattice_footprint(" +
        std::to_string(level) + ", x.xy); ";
    const auto texels = Probe(api(), head + "return vec4(vec3(at.texels), 0.0); }", {}).run(inputs);
    const auto weights = Probe(api(), head + "return vec4(at.weights, 0.0); }", {}).run(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto expected = lattice::footprint(level, inputs[i].x, inputs[i].y);
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(std::uint32_t(texels[i][k]), expected.texels[k])
            << "level " << level << " at " << inputs[i].x << ", " << inputs[i].y;
        // The cell coordinate at level 7 is up to 128 and has a rounding of 2^-17.
        ASSERT_NEAR(weights[i][k], expected.weights[k], 2e-5) << "level " << level;
      }
    }
  }
}

TEST_P(ShaderMath, HarmonicsAreThoseOfTheModel) {
  Random random(2);
  std::vector<glm::vec4> inputs;
  for (int i = 0; i < 500; ++i) inputs.emplace_back(glm::vec3(random.direction()), 0);
  for (int degree = 0; degree <= harmonics::max_degree; ++degree)
    for (int first = 0; first < harmonics::count(degree); first += 4) {
      std::string text =
          "#include \"harmonics.glsl\"\n"
          "vec4 probe(vec4 x) { float basis[HARMONICS_COUNT]; harmonics_basis(x.xyz, basis); "
          "return vec4(";
      for (int i = first; i < first + 4; ++i)
        text += (i < harmonics::count(degree) ? "basis[" + std::to_string(i) + "]" : "0.0") +
                std::string(i < first + 3 ? ", " : "); }");
      const auto results =
          Probe(api(), text, {{"HARMONICS_DEGREE", std::to_string(degree)}}).run(inputs);
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto expected = harmonics::basis(glm::dvec3(inputs[i]));
        for (int k = first; k < std::min(first + 4, harmonics::count(degree)); ++k)
          // Values up to 3, a dozen float operations.
          ASSERT_NEAR(results[i][k - first], expected[std::size_t(k)], 3e-6) << "Y_" << k;
      }
    }
}

// A wrong sign or order would change the sum: the squares of a band add up to (2l + 1) / 4 pi.
TEST(Harmonics, BandsAreNormalised) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const auto basis = harmonics::basis(random.direction());
    for (int l = 0; l <= harmonics::max_degree; ++l) {
      double sum = 0;
      for (int k = l * l; k < (l + 1) * (l + 1); ++k)
        sum += basis[std::size_t(k)] * basis[std::size_t(k)];
      ASSERT_NEAR(sum, (2 * l + 1) / (4 * M_PI), 1e-12) << "band " << l;
    }
  }
}

TEST_P(ShaderMath, TexelStoresFindEveryTexelAcrossRowsAndLayers) {
  // Rows of 4 texels, two rows per layer: 37 texels need five layers.
  TexelLayout layout{.row_bits = 2, .layer_bits = 1, .max_layers = 8};
  std::vector<float> values(37);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) + 0.25f;
  const TexelStore store(layout, TexelSource::of(texel_formats::r32f, values, "test values"));
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D_ARRAY, store.texture());
  const Probe probe(
      api(),
      "#include \"texel_store.glsl\"\nuniform sampler2DArray store;\n"
      "vec4 probe(vec4 x) { return texelFetch(store, texel_position(uint(x.x)), 0); }",
      {{"TEXEL_ROW_BITS", "2"}, {"TEXEL_LAYER_BITS", "1"}});
  GLint program = 0;
  std::vector<glm::vec4> inputs;
  for (std::size_t i = 0; i < values.size(); ++i) inputs.emplace_back(float(i), 0, 0, 0);
  (void)probe.run(inputs);  // leaves the program in use
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  glUniform1i(glGetUniformLocation(GLuint(program), "store"), 1);
  const auto results = probe.run(inputs);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(results[i].x, values[i]) << i;
}

TEST_P(ShaderMath, RampsAreThoseOfHeatMaps) {
  std::vector<glm::vec4> inputs;
  for (int i = -10; i <= 110; ++i) inputs.emplace_back(float(i) / 100, 0, 0, 0);
  const Probe probe(api(),
                    "#include \"heat_ramp.glsl\"\n"
                    "vec4 probe(vec4 v) { return vec4(heat_ramp(v.x), 0.0); }",
                    {});
  const std::vector<glm::vec4> results = probe.run(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (int c = 0; c < 3; ++c)
      // A few float operations on values up to 4.
      EXPECT_NEAR(results[i][c], heat_ramp(inputs[i].x)[c], 1e-6) << inputs[i].x;
}

TEST_P(ShaderMath, TriangleColorsAreThoseOfDebugViews) {
  // Indices are floats here, exact up to 2^24.
  std::vector<glm::vec4> inputs;
  Random random(6);
  for (int i = 0; i < 500; ++i) inputs.emplace_back(float(random.below(1u << 24)), 0, 0, 0);
  const Probe probe(
      api(),
      "#include \"triangle_color.glsl\"\n"
      "vec4 probe(vec4 v) { return vec4(triangle_color(uint(v.x), uint(v.y)), 0.0); }",
      {});
  const std::vector<glm::vec4> results = probe.run(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(results[i][c],
                  triangle_color(std::uint32_t(inputs[i].x), std::uint32_t(inputs[i].y))[c], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Contexts, ShaderMath, testing::ValuesIn(every_context),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace shader_math_test
}  // namespace tureen::test
