#include "jobs/cameras/photo_neighbors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace tureen {

namespace {

constexpr std::size_t length = std::tuple_size_v<FeatureDescriptor>;

// As measured on two sets of 67 and 101 photographs: 5 neighbours by these words join all of them.
constexpr std::size_t most_words = 1024, most_samples = 20'000;
constexpr int rounds = 4;

/// Centers of k-means, S. Lloyd, "Least squares quantization in PCM", 1982. Stored by component, so
/// that the distances of one descriptor to all words are sums of vectors.
class Words {
 public:
  /// The first words are samples at even distances.
  Words(const std::vector<FeatureDescriptor>& samples, const std::function<void(double)>& progress)
      : count_(std::min(most_words, samples.size())),
        components_(length * count_),
        half_squares_(count_) {
    for (std::size_t word = 0; word < count_; ++word)
      for (std::size_t k = 0; k < length; ++k)
        components_[k * count_ + word] = samples[word * samples.size() / count_][k];
    for (int round = 0; round < rounds; ++round)
      improve(samples, [&](double fraction) { progress((round + fraction) / rounds); });
  }

  std::size_t count() const { return count_; }

  std::size_t nearest(const FeatureDescriptor& descriptor) {
    // |d - w|^2 is smallest where d w - |w|^2 / 2 is largest.
    products_.assign(count_, 0.0f);
    for (std::size_t k = 0; k < length; ++k) {
      const float value = descriptor[k];
      if (value == 0) continue;
      const float* row = &components_[k * count_];
      for (std::size_t word = 0; word < count_; ++word) products_[word] += value * row[word];
    }
    std::size_t best = 0;
    float most = -std::numeric_limits<float>::infinity();
    for (std::size_t word = 0; word < count_; ++word)
      if (products_[word] - half_squares_[word] > most) {
        most = products_[word] - half_squares_[word];
        best = word;
      }
    return best;
  }

 private:
  void measure() {
    std::fill(half_squares_.begin(), half_squares_.end(), 0.0f);
    for (std::size_t k = 0; k < length; ++k)
      for (std::size_t word = 0; word < count_; ++word)
        half_squares_[word] +=
            0.5f * components_[k * count_ + word] * components_[k * count_ + word];
  }

  void improve(const std::vector<FeatureDescriptor>& samples,
               const std::function<void(double)>& progress) {
    measure();
    std::vector<float> sums(components_.size());
    std::vector<float> members(count_);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % 256 == 0) progress(double(i) / double(samples.size()));
      const std::size_t word = nearest(samples[i]);
      ++members[word];
      for (std::size_t k = 0; k < length; ++k) sums[k * count_ + word] += samples[i][k];
    }
    for (std::size_t word = 0; word < count_; ++word)
      for (std::size_t k = 0; k < length && members[word] > 0; ++k)
        components_[k * count_ + word] = sums[k * count_ + word] / members[word];
    measure();
  }

  std::size_t count_;
  std::vector<float> components_;    // length x count_
  std::vector<float> half_squares_;  // half the square of each word's length
  std::vector<float> products_;
};

/// Square roots of the words' counts, weighted by how few photographs have the word, of unit
/// length.
std::vector<std::vector<float>> histograms(
    const std::vector<std::vector<FeatureDescriptor>>& descriptors, Words& words,
    const std::function<void(double)>& progress) {
  std::vector<std::vector<float>> result;
  std::vector<float> having(words.count());
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    progress(double(i) / double(descriptors.size()));
    std::vector<float>& histogram = result.emplace_back(words.count());
    for (const FeatureDescriptor& descriptor : descriptors[i])
      ++histogram[words.nearest(descriptor)];
    for (std::size_t word = 0; word < words.count(); ++word) having[word] += histogram[word] > 0;
  }
  for (std::vector<float>& histogram : result) {
    float squares = 0;
    for (std::size_t word = 0; word < words.count(); ++word) {
      const float rarity = std::log(float(result.size()) / std::max(1.0f, having[word]));
      histogram[word] = std::sqrt(histogram[word]) * rarity;
      squares += histogram[word] * histogram[word];
    }
    for (float& value : histogram) value /= std::sqrt(std::max(squares, 1e-12f));  // 0 stays 0
  }
  return result;
}

}  // namespace

PhotoNeighbors photo_neighbors(const std::vector<std::vector<FeatureDescriptor>>& descriptors,
                               const std::function<void(double)>& progress) {
  std::vector<FeatureDescriptor> samples;
  std::size_t all = 0;
  for (const auto& list : descriptors) all += list.size();
  const std::size_t step = std::max<std::size_t>(1, all / most_samples);
  std::size_t index = 0;
  for (const auto& list : descriptors)
    for (const FeatureDescriptor& descriptor : list)
      if (index++ % step == 0) samples.push_back(descriptor);
  Words words(samples, [&](double fraction) { progress(0.6 * fraction); });
  const auto found =
      histograms(descriptors, words, [&](double fraction) { progress(0.6 + 0.4 * fraction); });
  PhotoNeighbors neighbors(found.size());
  std::vector<float> likeness(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      likeness[j] = std::inner_product(found[i].begin(), found[i].end(), found[j].begin(), 0.0f);
      if (j != i) neighbors[i].push_back(j);
    }
    std::stable_sort(neighbors[i].begin(), neighbors[i].end(),
                     [&](std::size_t a, std::size_t b) { return likeness[a] > likeness[b]; });
  }
  return neighbors;
}

PhotoPairs all_pairs(std::size_t photos) {
  PhotoPairs pairs;
  for (std::size_t i = 0; i < photos; ++i)
    for (std::size_t j = i + 1; j < photos; ++j) pairs.emplace_back(i, j);
  return pairs;
}

bool is_series(const PhotoNeighbors& neighbors) {
  constexpr std::size_t counted = 5, beside = 9;
  const std::size_t count = neighbors.size();
  double near = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < std::min(counted, neighbors[i].size()); ++k) {
      const std::size_t other = neighbors[i][k];
      near += std::max(i, other) - std::min(i, other) <= beside;
      ++all;
    }
  const double chance = std::min(1.0, 2.0 * beside / double(count));
  return near > 0.5 * (1 + chance) * all;
}

PhotoPairs likely_pairs(const PhotoNeighbors& neighbors, std::size_t nearest) {
  const std::size_t count = neighbors.size();
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  const bool series = is_series(neighbors);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t taken = std::min(series ? nearest : 3 * nearest, neighbors[i].size());
    for (std::size_t k = 0; k < taken; ++k)
      pairs.emplace(std::min(i, neighbors[i][k]), std::max(i, neighbors[i][k]));
    // The offsets of COLMAP's sequential matcher with overlap 10, which joined all photographs of
    // both measured series; without the last three, one of them fell apart.
    for (const std::size_t offset : {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 32, 64})
      if (series && i + offset < count) pairs.emplace(i, i + offset);
  }
  return {pairs.begin(), pairs.end()};
}

}  // namespace tureen
