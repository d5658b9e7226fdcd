// The color MLP: dense layers that map the features and the view direction of a pixel to a colour,
// with ReLU between layers and a sigmoid at the end. DiffSoup uses 16-16-16-3 with harmonics of
// degree 2 and a linear blend with the first three features. MobileNeRF uses 11-16-16-3 with the
// bare direction.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tureen {

/// The sign of a view direction. Odd harmonics bands change sign between the two conventions.
enum class ViewConvention { surface_to_eye, eye_to_surface };
inline constexpr const char* view_conventions[] = {"surface_to_eye", "eye_to_surface"};

enum class DirectionEncoding {
  none,        // 0 inputs
  xyz,         // 3 inputs: the unit direction
  harmonics2,  // 9 inputs: harmonics::basis up to degree 2
};
inline constexpr const char* direction_encodings[] = {"none", "xyz", "harmonics2"};

constexpr int encoded_size(DirectionEncoding encoding) {
  return encoding == DirectionEncoding::none ? 0 : encoding == DirectionEncoding::xyz ? 3 : 9;
}

/// y = W x + b. `weights` is row-major [outputs][inputs].
struct DenseLayer {
  int inputs = 0;
  int outputs = 0;
  std::vector<float> weights;
  std::vector<float> biases;
};

/// The inputs are the features, then the encoded direction; the last layer has three outputs. With
/// a blend channel r, colour = (1 - f_r) (f_0, f_1, f_2) + f_r mlp(x), as in DiffSoup with r = 3.
/// Without a blend channel, colour = mlp(x). Values are display-referred sRGB in [0, 1].
struct ColorMlp {
  static constexpr int max_width = 64;  // of any layer, in or out
  static constexpr int max_layers = 8;

  std::vector<DenseLayer> layers;
  DirectionEncoding encoding = DirectionEncoding::harmonics2;
  ViewConvention view = ViewConvention::surface_to_eye;
  std::optional<int> blend_channel;

  /// Features that the first layer expects in addition to the direction.
  int feature_count() const { return layers.front().inputs - encoded_size(encoding); }
};

/// The reason why this network cannot be evaluated, or nullopt: mismatched layer sizes, a wrong
/// number of weights, a weight that is not finite, a blend channel that is not a feature. Readers
/// throw it as an InputError; the functions below assert that there is no defect.
std::optional<std::string> defect(const ColorMlp& mlp, int available_features);

/// The colour of one pixel in double precision. `features` holds at least feature_count() values,
/// and at least 3 with a blend channel. `to_eye` is the unit direction from the surface to the eye;
/// the function converts it to mlp.view.
glm::dvec3 evaluate(const ColorMlp& mlp, std::span<const double> features, glm::dvec3 to_eye);

}  // namespace tureen
