// Points and the distances between them, for the first primitives of a training.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tureen::trainer {

/// The mean distance from each point to the `neighbours` nearest other points, or to all others if
/// there are fewer; 0 for coincident points and for a single point. O(n log n).
std::vector<double> nearest_distances(std::span<const glm::dvec3> points,
                                      std::size_t neighbours = 1);

/// The index of the nearest of `points`, which are not empty, for each of `places`.
std::vector<std::uint32_t> nearest_points(std::span<const glm::dvec3> points,
                                          std::span<const glm::dvec3> places);

/// Indices of `count` points (at most all), beginning with `first`. Each next point is the farthest
/// from all before it (Gonzalez 1985); ties go to the lower index. O(points x count).
std::vector<std::uint32_t> farthest_points(std::span<const glm::dvec3> points, std::size_t count,
                                           std::uint32_t first);

}  // namespace tureen::trainer
