// Where the first primitives of a training come from.
#pragma once

namespace tureen::trainer {

enum class Initialisation {
  automatic,  // points of the dataset, else of stereo_points(); soups: else on Gaussians
  points,     // at points of the dataset, from structure from motion
  random,     // at random points of a box
  mesh,       // the primitives of a scene in a supported format
};

/// In the order of the enumerators.
inline constexpr const char* initialisation_words[] = {"automatic", "points", "random", "mesh"};

}  // namespace tureen::trainer
