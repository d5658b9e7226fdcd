#include "runtime/plan/color_mlp_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

std::string literal(float value) {
  char text[32] = "";
  // Nine digits reproduce every float. The exponent form is a float literal in all GLSL versions.
  std::snprintf(text, sizeof text, "%.8e", double(value));
  // The program may have set a locale, but GLSL needs a decimal point.
  std::replace(text, text + sizeof text, ',', '.');
  return text;
}

std::string feature_name(int i) {
  return (i < 4 ? "features0." : "features1.") + std::string(1, "xyzw"[i % 4]);
}

struct Input {
  std::string name;
  float low, high;
};

std::vector<Input> network_inputs(const ColorMlp& mlp, const FeatureRanges& ranges) {
  std::vector<Input> inputs;
  for (int i = 0; i < mlp.feature_count(); ++i)
    inputs.push_back({feature_name(i), ranges[i].low, ranges[i].high});
  if (mlp.encoding == DirectionEncoding::xyz)
    for (const char* axis : {"d.x", "d.y", "d.z"}) inputs.push_back({axis, -1.0f, 1.0f});
  if (mlp.encoding == DirectionEncoding::harmonics2) {
    // The extrema of each basis function over the sphere, rounded outwards to five digits.
    constexpr double y00 = harmonics::y00, y10 = harmonics::factors[2];
    constexpr double y20 = harmonics::factors[6], y22 = harmonics::factors[8];
    constexpr double low[9] = {y00, -y10, -y10, -y10, -y22, -y22, -y20, -y22, -y22};
    constexpr double high[9] = {y00, y10, y10, y10, y22, y22, 2 * y20, y22, y22};
    for (int i = 0; i < 9; ++i)
      inputs.push_back({"basis[" + std::to_string(i) + "]", float(std::floor(1e5 * low[i]) / 1e5),
                        float(std::ceil(1e5 * high[i]) / 1e5)});
  }
  return inputs;
}

std::string prologue(const ColorMlp& mlp) {
  std::string text;
  if (mlp.encoding == DirectionEncoding::harmonics2) text += "#include \"harmonics.glsl\"\n";
  return text;
}

std::string signature(const ColorMlp& mlp) {
  std::string text = "vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye) {\n";
  text +=
      mlp.view == ViewConvention::surface_to_eye ? "  vec3 d = to_eye;\n" : "  vec3 d = -to_eye;\n";
  if (mlp.encoding == DirectionEncoding::harmonics2)
    text += "  float basis[9];\n  harmonics_basis(d, basis);\n";
  return text;
}

/// `sum`: expression for the three outputs before the sigmoid. `blend`: expression for the value of
/// the blend channel; empty for a network that replaces the base colour.
std::string epilogue(const std::string& sum, const std::string& blend) {
  const std::string text = "  vec3 predicted = 1.0 / (1.0 + exp(-" + sum + "));\n";
  if (blend.empty()) return text + "  return predicted;\n}\n";
  return text + "  return mix(features0.rgb, predicted, " + blend + ");\n}\n";
}

std::string blend_expression(const ColorMlp& mlp) {
  return mlp.blend_channel ? feature_name(*mlp.blend_channel) : std::string();
}

/// The same, with a constant for a channel of a single value.
std::string blend_expression(const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!mlp.blend_channel) return {};
  const FeatureRange& range = ranges[std::size_t(*mlp.blend_channel)];
  if (range.low != range.high) return blend_expression(mlp);
  return range.low == 1.0f ? std::string() : literal(range.low);
}

ColorMlpSource with_constants(const ColorMlp& mlp, const FeatureRanges& ranges, bool pruned) {
  ColorMlpSource result;
  std::string body;
  std::vector<Input> inputs = network_inputs(mlp, ranges);
  for (std::size_t l = 0; l < mlp.layers.size(); ++l) {
    const DenseLayer& layer = mlp.layers[l];
    const bool last = l + 1 == mlp.layers.size();
    std::vector<Input> outputs;
    for (int o = 0; o < layer.outputs; ++o) {
      const float* weights = &layer.weights[std::size_t(o) * layer.inputs];
      std::string terms;
      double bias = layer.biases[o];
      double low = layer.biases[o], high = layer.biases[o], magnitude = std::abs(high);
      int zeros = 0;
      for (int i = 0; i < layer.inputs; ++i) {
        const double a = double(weights[i]) * inputs[i].low,
                     b = double(weights[i]) * inputs[i].high;
        low += std::min(a, b);
        high += std::max(a, b);
        magnitude += std::max(std::abs(a), std::abs(b));
        if (pruned && inputs[i].low == inputs[i].high) {
          bias += a;
          continue;
        }
        if (pruned && weights[i] == 0.0f) {
          ++zeros;
          continue;
        }
        terms += " + " + literal(weights[i]) + " * " + inputs[i].name;
      }
      const std::string sum = literal(float(bias)) + terms;
      // Rounding on the device of a sum of at most max_width + 1 float products, and of the
      // features themselves: less than 64 * 2^-24 = 3.8e-6 of the terms' magnitude.
      const double rounding = 1e-5 * magnitude;
      const bool dead = pruned && !last && high <= -rounding;
      result.hidden_neurons += last ? 0 : 1;
      result.dead_neurons += dead ? 1 : 0;
      result.zero_weights += dead ? 0 : zeros;
      const std::string name = "x" + std::to_string(l + 1) + "_" + std::to_string(o);
      outputs.push_back({name, dead ? 0.0f : float(std::max(low, 0.0)),
                         dead ? 0.0f : float(std::max(high, 0.0))});
      if (dead) continue;
      body += "  float " + name + " = " + (last ? sum : "max(0.0, " + sum + ")") + ";\n";
    }
    inputs = std::move(outputs);
  }
  const std::string sum =
      "vec3(" + inputs[0].name + ", " + inputs[1].name + ", " + inputs[2].name + ")";
  body += epilogue(sum, pruned ? blend_expression(mlp, ranges) : blend_expression(mlp));
  result.reads_features1 = body.find("features1.") != std::string::npos;
  result.text = prologue(mlp) + signature(mlp) + body;
  return result;
}

ColorMlpSource with_uniforms(const ColorMlp& mlp) {
  ColorMlpSource result;
  const auto blocks = [](int n) { return (n + 3) / 4; };
  const std::vector<Input> inputs = network_inputs(mlp, {});
  std::string body;
  for (int block = 0; block < blocks(int(inputs.size())); ++block) {
    body += "  vec4 x0_" + std::to_string(block) + " = vec4(";
    for (int i = 4 * block; i < 4 * block + 4; ++i)
      body += (i < int(inputs.size()) ? inputs[i].name : "0.0") + (i % 4 == 3 ? ");\n" : ", ");
  }
  for (std::size_t l = 0; l < mlp.layers.size(); ++l) {
    const DenseLayer& layer = mlp.layers[l];
    const bool last = l + 1 == mlp.layers.size();
    result.hidden_neurons += last ? 0 : layer.outputs;
    for (int out = 0; out < blocks(layer.outputs); ++out) {
      glm::vec4 bias(0.0f);
      for (int r = 0; r < 4 && 4 * out + r < layer.outputs; ++r)
        bias[r] = layer.biases[4 * out + r];
      std::string sum = "mlp_biases[" + std::to_string(result.biases.size()) + "]";
      result.biases.push_back(bias);
      for (int in = 0; in < blocks(layer.inputs); ++in) {
        glm::mat4 weights(0.0f);
        for (int c = 0; c < 4 && 4 * in + c < layer.inputs; ++c)
          for (int r = 0; r < 4 && 4 * out + r < layer.outputs; ++r)
            weights[c][r] = layer.weights[std::size_t(4 * out + r) * layer.inputs + 4 * in + c];
        sum += " + mlp_weights[" + std::to_string(result.weights.size()) + "] * x" +
               std::to_string(l) + "_" + std::to_string(in);
        result.weights.push_back(weights);
      }
      body += "  vec4 x" + std::to_string(l + 1) + "_" + std::to_string(out) + " = " +
              (last ? sum : "max(vec4(0.0), " + sum + ")") + ";\n";
    }
  }
  result.text = prologue(mlp) + "uniform mat4 mlp_weights[" +
                std::to_string(result.weights.size()) + "];\nuniform vec4 mlp_biases[" +
                std::to_string(result.biases.size()) + "];\n" + signature(mlp) + body +
                epilogue("x" + std::to_string(mlp.layers.size()) + "_0.xyz", blend_expression(mlp));
  return result;
}

}  // namespace

ColorMlpSource color_mlp_source(const ColorMlp& mlp, MlpWeights kind, const FeatureRanges& ranges) {
  if (kind == MlpWeights::uniforms) return with_uniforms(mlp);
  return with_constants(mlp, ranges, kind == MlpWeights::constants);
}

}  // namespace tureen
