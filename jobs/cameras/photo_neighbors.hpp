// Which photographs of a set look alike, by histograms of visual words: J. Sivic and A. Zisserman,
// "Video Google: A text retrieval approach to object matching in videos", ICCV 2003. The words come
// from the set itself.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "jobs/cameras/feature_database.hpp"

namespace tureen {

/// For each photograph, all others from the most to the least similar: indices.
using PhotoNeighbors = std::vector<std::vector<std::size_t>>;

/// `descriptors`: those of each photograph; may be empty. `progress`: called with the fraction
/// done; may throw. The result depends on nothing else. Time on one core: about 1 s for 60
/// photographs with 500 descriptors each, 10 s for 1,000.
PhotoNeighbors photo_neighbors(const std::vector<std::vector<FeatureDescriptor>>& descriptors,
                               const std::function<void(double)>& progress);

/// Pairs of photographs, each once, the smaller index first, in order.
using PhotoPairs = std::vector<std::pair<std::size_t, std::size_t>>;

PhotoPairs all_pairs(std::size_t photos);

/// The pairs to match in a set of more than most_photos_for_all_pairs photographs. In a series,
/// these are the photographs 1 to 9, 16, 32 and 64 apart, and the `nearest` of each, which close
/// loops; otherwise the 3 * `nearest` most similar ones of each.
PhotoPairs likely_pairs(const PhotoNeighbors& neighbors, std::size_t nearest);
inline constexpr std::size_t most_photos_for_all_pairs = 40;

/// Whether photographs beside each other in the order look alike: more than half way between chance
/// and certainty.
bool is_series(const PhotoNeighbors& neighbors);

}  // namespace tureen
