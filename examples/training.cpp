#include "training.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "soup/spherical_harmonics.hpp"

namespace tureen::example {
namespace {

constexpr int widths[] = {16, 16, 16, 3};
constexpr int layers = 3;
constexpr int blend = 3;

/// One dense layer with its gradient and Adam's two moments; row-major like DenseLayer, the bias
/// behind each row's weights.
struct Layer {
  int inputs, outputs;
  std::vector<double> values, gradient, first, second;

  Layer(int in, int out, Random& random) : inputs(in), outputs(out) {
    const std::size_t n = std::size_t(in + 1) * out;
    for (auto* v : {&values, &gradient, &first, &second}) v->assign(n, 0.0);
    const double bound = std::sqrt(6.0 / in);  // He et al., arXiv 1502.01852
    for (int o = 0; o < out; ++o)
      for (int i = 0; i < in; ++i) values[row(o) + i] = random.uniform(-bound, bound);
  }
  std::size_t row(int output) const { return std::size_t(output) * (inputs + 1); }
};

using Activations = std::array<std::array<double, 16>, layers + 1>;

void forward(const std::vector<Layer>& network, Activations& x) {
  for (int l = 0; l < layers; ++l) {
    const Layer& layer = network[l];
    for (int o = 0; o < layer.outputs; ++o) {
      const double* w = &layer.values[layer.row(o)];
      double sum = w[layer.inputs];
      for (int i = 0; i < layer.inputs; ++i) sum += w[i] * x[l][i];
      x[l + 1][o] = l + 1 < layers ? std::max(0.0, sum) : 1 / (1 + std::exp(-sum));
    }
  }
}

/// Adds to the gradients; `delta` is the loss's derivative by the outputs before their sigmoid.
void backward(std::vector<Layer>& network, const Activations& x, std::array<double, 16> delta) {
  for (int l = layers - 1; l >= 0; --l) {
    Layer& layer = network[l];
    std::array<double, 16> below{};
    for (int o = 0; o < layer.outputs; ++o) {
      const double d = delta[o];
      if (d == 0) continue;
      double* g = &layer.gradient[layer.row(o)];
      const double* w = &layer.values[layer.row(o)];
      for (int i = 0; i < layer.inputs; ++i) {
        g[i] += d * x[l][i];
        if (l > 0 && x[l][i] > 0) below[i] += d * w[i];
      }
      g[layer.inputs] += d;
    }
    delta = below;
  }
}

void adam(Layer& layer, double rate, int step) {
  constexpr double decay1 = 0.9, decay2 = 0.99, epsilon = 1e-10;
  const double unbias1 = 1 - std::pow(decay1, step), unbias2 = 1 - std::pow(decay2, step);
  for (std::size_t i = 0; i < layer.values.size(); ++i) {
    const double g = layer.gradient[i];
    layer.first[i] = decay1 * layer.first[i] + (1 - decay1) * g;
    layer.second[i] = decay2 * layer.second[i] + (1 - decay2) * g * g;
    layer.values[i] -=
        rate * (layer.first[i] / unbias1) / (std::sqrt(layer.second[i] / unbias2) + epsilon);
    layer.gradient[i] = 0;
  }
}

}  // namespace

Training train(const std::function<Example(Random&)>& draw, const TrainingOptions& options) {
  Random random(options.seed);
  std::vector<Layer> network;
  for (int l = 0; l < layers; ++l) network.emplace_back(widths[l], widths[l + 1], random);
  double squares = 0;
  std::size_t counted = 0;
  for (int step = 1; step <= options.steps; ++step) {
    for (int n = 0; n < options.batch; ++n) {
      const Example example = draw(random);
      Activations x{};
      for (int i = 0; i < 7; ++i) x[0][i] = example.features[i];
      const auto basis = harmonics::basis(example.to_eye);
      for (int i = 0; i < 9; ++i) x[0][7 + i] = basis[i];
      forward(network, x);
      std::array<double, 16> delta{};
      const double r = example.features[blend];
      for (int c = 0; c < 3; ++c) {
        const double y = x[layers][c];
        const double error = (1 - r) * example.features[c] + r * y - example.color[c];
        delta[c] = 2 * error * r * y * (1 - y) / options.batch;
        if (step > options.steps - std::max(1, options.steps / 10))
          squares += error * error, ++counted;
      }
      backward(network, x, delta);
    }
    const double phase = 0.5 * (1 + std::cos(std::numbers::pi * step / options.steps));
    for (Layer& layer : network) adam(layer, options.rate * (0.01 + 0.99 * phase), step);
  }
  Training result;
  result.mlp.encoding = DirectionEncoding::harmonics2;
  result.mlp.view = ViewConvention::surface_to_eye;
  result.mlp.blend_channel = blend;
  for (const Layer& layer : network) {
    DenseLayer dense{.inputs = layer.inputs, .outputs = layer.outputs, .weights = {}, .biases = {}};
    for (int o = 0; o < layer.outputs; ++o) {
      const double* w = &layer.values[layer.row(o)];
      for (int i = 0; i < layer.inputs; ++i) dense.weights.push_back(static_cast<float>(w[i]));
      dense.biases.push_back(static_cast<float>(w[layer.inputs]));
    }
    result.mlp.layers.push_back(std::move(dense));
  }
  result.root_mean_square = counted ? std::sqrt(squares / double(counted)) : 0;
  return result;
}

}  // namespace tureen::example
