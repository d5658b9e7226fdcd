// The color MLP (16-16-16-3, ReLU, ReLU, sigmoid) with its residual blend, forward and backward.
// `Real` is a float or a double for one pixel, or a pack of floats for several pixels.
//
// Inputs 0..6 are the features, 7..15 harmonics of the direction from the surface to the eye.
// colour = (1 - f3) (f0, f1, f2) + f3 mlp(x). DiffSoup (arXiv 2603.27151), section 3.
#pragma once

#include "scene/spherical_harmonics.hpp"
#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/scalar.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer::kernels {

inline constexpr int features = channels - 1;

// Offsets of the layers in MlpParameters.
inline constexpr int weights1 = 0, biases1 = weights1 + 256;
inline constexpr int weights2 = biases1 + 16, biases2 = weights2 + 256;
inline constexpr int weights3 = biases2 + 16, biases3 = weights3 + 48;

template <class Real>
struct NetworkState {
  Real input[mlp_inputs];
  Real hidden1[mlp_width];  // after the ReLU
  Real hidden2[mlp_width];
  Real output[mlp_outputs];  // after the sigmoid
};

/// harmonics::basis of degree 2 at the unit direction (x, y, z).
template <class Real>
TUREEN_HOST_DEVICE void harmonics9(const Real& x, const Real& y, const Real& z, Real* basis) {
  // Constants of the function: device code cannot read arrays of the host.
  constexpr float y00 = float(harmonics::factors[0]), y10 = float(harmonics::factors[2]);
  constexpr float y20 = float(harmonics::factors[6]), y22 = float(harmonics::factors[8]);
  constexpr float y21 = float(harmonics::factors[4]);
  basis[0] = Real{} + y00;
  basis[1] = -y10 * y;
  basis[2] = y10 * z;
  basis[3] = -y10 * x;
  basis[4] = y21 * x * y;
  basis[5] = -y21 * y * z;
  basis[6] = y20 * (2.0f * z * z - x * x - y * y);
  basis[7] = -y21 * x * z;
  basis[8] = y22 * (x * x - y * y);
}

/// y = W x + b. `Weight` is float for packs, otherwise Real.
template <int Inputs, int Outputs, class Weight, class Real>
TUREEN_HOST_DEVICE void dense(const Weight* weights, const Weight* biases, const Real (&x)[Inputs],
                              Real (&y)[Outputs]) {
  for (int o = 0; o < Outputs; ++o) {
    Real sum = Real{} + biases[o];
    for (int i = 0; i < Inputs; ++i) sum += weights[o * Inputs + i] * x[i];
    y[o] = sum;
  }
}

/// Computes the colour, and all of `state` except its input.
template <class Weight, class Real>
TUREEN_HOST_DEVICE void shade(const Weight* mlp, NetworkState<Real>& state, Real (&color)[3]) {
  dense(mlp + weights1, mlp + biases1, state.input, state.hidden1);
  for (Real& h : state.hidden1) h = positive_part(h);
  dense(mlp + weights2, mlp + biases2, state.hidden1, state.hidden2);
  for (Real& h : state.hidden2) h = positive_part(h);
  dense(mlp + weights3, mlp + biases3, state.hidden2, state.output);
  const Real& blend = state.input[blend_channel];
  for (int c = 0; c < mlp_outputs; ++c) {
    state.output[c] = sigmoid(state.output[c]);
    color[c] = (1.0f - blend) * state.input[c] + blend * state.output[c];
  }
}

/// Adds a pixel's derivatives to the gradient of the whole network.
template <class Real>
struct AddedDerivatives {
  Real* dmlp;  // mlp_parameters numbers

  TUREEN_HOST_DEVICE void bias(int biases, int o, const Real& dy) const { dmlp[biases + o] += dy; }
  TUREEN_HOST_DEVICE void weight(int weights, int index, const Real& x, const Real& dy) const {
    dmlp[weights + index] += x * dy;
  }
};

/// dL/dx of one dense layer, which begins at `first_weight` and `first_bias` of `mlp`. `sums`
/// receives the derivatives by its parameters; it has the interface of AddedDerivatives.
template <int Inputs, int Outputs, class Weight, class Real, class Sums>
TUREEN_HOST_DEVICE void dense_backward(const Weight* mlp, int first_weight, int first_bias,
                                       const Real (&x)[Inputs], const Real (&dy)[Outputs],
                                       const Sums& sums, Real (&dx)[Inputs]) {
  const Weight* weights = mlp + first_weight;
  for (int i = 0; i < Inputs; ++i) dx[i] = Real{};
  for (int o = 0; o < Outputs; ++o) {
    sums.bias(first_bias, o, dy[o]);
    for (int i = 0; i < Inputs; ++i) {
      dx[i] += weights[o * Inputs + i] * dy[o];
      sums.weight(first_weight, o * Inputs + i, x[i], dy[o]);
    }
  }
}

/// From dL/dcolour to dL/dfeatures. `sums` receives the pixel's derivatives by the network's
/// parameters. `state`: the result of shade(). The direction is not differentiated.
template <class Weight, class Real, class Sums>
TUREEN_HOST_DEVICE void network_backward(const Weight* mlp, const NetworkState<Real>& state,
                                         const Real (&dcolor)[3], const Sums& sums,
                                         Real (&dfeatures)[features]) {
  Real dz3[mlp_outputs], dz2[mlp_width], dz1[mlp_width], dx[mlp_inputs];
  const Real& blend = state.input[blend_channel];
  Real dblend = Real{};
  for (int c = 0; c < mlp_outputs; ++c) {
    const Real& s = state.output[c];
    dz3[c] = dcolor[c] * blend * s * (1.0f - s);
    dblend += dcolor[c] * (s - state.input[c]);
  }
  dense_backward(mlp, weights3, biases3, state.hidden2, dz3, sums, dz2);
  for (int o = 0; o < mlp_width; ++o) dz2[o] = state.hidden2[o] > Real{} ? dz2[o] : Real{};
  dense_backward(mlp, weights2, biases2, state.hidden1, dz2, sums, dz1);
  for (int o = 0; o < mlp_width; ++o) dz1[o] = state.hidden1[o] > Real{} ? dz1[o] : Real{};
  dense_backward(mlp, weights1, biases1, state.input, dz1, sums, dx);
  for (int f = 0; f < features; ++f) dfeatures[f] = dx[f];
  for (int c = 0; c < 3; ++c) dfeatures[c] += dcolor[c] * (1.0f - blend);
  dfeatures[blend_channel] += dblend;
}

/// The same, with the network's derivatives added to `dmlp`, mlp_parameters numbers.
template <class Weight, class Real>
TUREEN_HOST_DEVICE void shade_backward(const Weight* mlp, const NetworkState<Real>& state,
                                       const Real (&dcolor)[3], Real* dmlp,
                                       Real (&dfeatures)[features]) {
  network_backward(mlp, state, dcolor, AddedDerivatives<Real>{dmlp}, dfeatures);
}

}  // namespace tureen::trainer::kernels
