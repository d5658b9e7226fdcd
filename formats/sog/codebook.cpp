#include "formats/sog/codebook.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace tureen {

namespace {

constexpr std::size_t codes = 256;
/// Intervals of the search. Lloyd's iteration moves their limits afterwards.
constexpr std::size_t grid_cells = 4096;
/// It converges to less than a thousandth of the error in fewer.
constexpr int lloyd_steps = 40;

/// Sums over the values below each place, in ascending order.
struct Moments {
  std::vector<double> weight{0}, first{0}, second{0};

  void add(double value, double w) {
    weight.push_back(weight.back() + w);
    first.push_back(first.back() + w * value);
    second.push_back(second.back() + w * value * value);
  }
  double mean(std::size_t begin, std::size_t end) const {
    const double w = weight[end] - weight[begin];
    return w > 0 ? (first[end] - first[begin]) / w : 0;
  }
  /// Squared error of one value for the whole interval.
  double error(std::size_t begin, std::size_t end) const {
    const double w = weight[end] - weight[begin], f = first[end] - first[begin];
    return w > 0 ? second[end] - second[begin] - f * f / w : 0;
  }
};

/// The limits of the optimal intervals among those of `moments`: at most `codes` + 1.
class BestIntervals {
 public:
  explicit BestIntervals(const Moments& moments)
      : moments_(moments),
        size_(moments.weight.size() - 1),
        levels_(std::min(codes, size_)),
        error_(size_ + 1),
        next_(size_ + 1),
        begins_(levels_ * (size_ + 1)) {}

  std::vector<std::size_t> find() {
    for (std::size_t end = 0; end <= size_; ++end) error_[end] = moments_.error(0, end);
    for (std::size_t level = 1; level < levels_; ++level) {
      std::fill(next_.begin(), next_.end(), std::numeric_limits<double>::infinity());
      search(level, level + 1, size_, level, size_ - 1);
      std::swap(error_, next_);
    }
    std::vector<std::size_t> limits(levels_ + 1, 0);
    limits[levels_] = size_;
    for (std::size_t level = levels_; level-- > 1;)
      limits[level] = begins_[level * (size_ + 1) + limits[level + 1]];
    return limits;
  }

 private:
  /// Finds the best begin of the last of level + 1 intervals for each end in low..high, which lies
  /// in first..last: it never decreases with the end.
  void search(std::size_t level, std::size_t low, std::size_t high, std::size_t first,
              std::size_t last) {
    if (low > high) return;
    const std::size_t end = (low + high) / 2;
    std::size_t best = first;
    for (std::size_t begin = first; begin <= std::min(last, end - 1); ++begin) {
      const double error = error_[begin] + moments_.error(begin, end);
      if (error < next_[end]) {
        next_[end] = error;
        best = begin;
      }
    }
    begins_[level * (size_ + 1) + end] = std::uint32_t(best);
    if (end > low) search(level, low, end - 1, first, best);
    search(level, end + 1, high, best, last);
  }

  const Moments& moments_;
  std::size_t size_, levels_;
  std::vector<double> error_, next_;
  std::vector<std::uint32_t> begins_;
};

}  // namespace

Codebook best_codebook(std::span<const float> values, std::span<const float> weights,
                       std::size_t each) {
  std::vector<std::pair<float, float>> sorted(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    sorted[i] = {values[i], weights.empty() ? 1.0f : weights[i / each]};
  std::sort(sorted.begin(), sorted.end());
  Codebook book;
  std::size_t different = 0;
  for (std::size_t i = 0; i < sorted.size() && different <= codes; ++i)
    if (i == 0 || sorted[i].first > sorted[i - 1].first) {
      if (different < codes) book[different] = sorted[i].first;
      ++different;
    }
  if (different <= codes) {
    std::fill(book.begin() + std::ptrdiff_t(different), book.end(), book[different - 1]);
    return book;
  }

  Moments all;
  for (const auto& [value, weight] : sorted) all.add(double(value), double(weight));
  // Half of the grid follows the values' number, half their range, so that outliers get cells, too.
  const double low = double(sorted.front().first), range = double(sorted.back().first) - low;
  Moments cells;
  std::size_t begin = 0;
  const auto cell_of = [&](std::size_t i) {
    const double rank = double(i) / double(sorted.size());
    return std::size_t((rank + (double(sorted[i].first) - low) / range) / 2 * grid_cells);
  };
  for (std::size_t i = 1; i <= sorted.size(); ++i)
    if (i == sorted.size() || cell_of(i) != cell_of(begin)) {
      cells.weight.push_back(all.weight[i]);
      cells.first.push_back(all.first[i]);
      cells.second.push_back(all.second[i]);
      begin = i;
    }
  const std::vector<std::size_t> limits = BestIntervals(cells).find();
  std::vector<double> means;
  for (std::size_t k = 0; k + 1 < limits.size(); ++k)
    means.push_back(cells.mean(limits[k], limits[k + 1]));

  for (int step = 0; step < lloyd_steps; ++step) {
    std::size_t from = 0;
    for (std::size_t k = 0; k < means.size(); ++k) {
      std::size_t to = sorted.size();
      if (k + 1 < means.size()) {
        const auto middle = float((means[k] + means[k + 1]) / 2);
        to = std::size_t(std::lower_bound(sorted.begin() + std::ptrdiff_t(from), sorted.end(),
                                          std::pair(middle, 0.0f)) -
                         sorted.begin());
      }
      if (to > from) means[k] = all.mean(from, to);
      from = to;
    }
    std::sort(means.begin(), means.end());
  }
  for (std::size_t k = 0; k < codes; ++k) book[k] = float(means[std::min(k, means.size() - 1)]);
  return book;
}

std::uint8_t nearest_in(const Codebook& codebook, float value) {
  const auto above = std::lower_bound(codebook.begin(), codebook.end(), value);
  if (above == codebook.begin()) return 0;
  if (above == codebook.end()) return std::uint8_t(codes - 1);
  const bool is_below = value - above[-1] <= *above - value;
  return std::uint8_t(above - codebook.begin() - (is_below ? 1 : 0));
}

}  // namespace tureen
