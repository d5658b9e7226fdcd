#include "formats/sog/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/threads/thread_pool.hpp"
#include "formats/sog/palette_kernels.hpp"

namespace tureen {

namespace {

constexpr std::size_t entries_a_cell = 256;
/// Rows on which the cells are found: 128 for each of at most 256 cells.
constexpr std::size_t most_sampled = 32768;
constexpr int cell_steps = 8, entry_steps = 6, whole_steps = 2;
/// Cells whose entries a row is compared with.
constexpr std::size_t probed_cells = 6;
constexpr std::size_t rows_a_task = 4096;

/// Calls act(rows, indices) with groups of `rows_at_once` rows; the last one repeats its last row.
template <class Act>
void in_groups(std::span<const float> vectors, std::size_t dimensions,
               std::span<const std::uint32_t> which, Act&& act) {
  for (std::size_t i = 0; i < which.size(); i += rows_at_once) {
    PointRows rows;
    std::array<std::size_t, rows_at_once> places;
    for (std::size_t r = 0; r < rows_at_once; ++r) {
      places[r] = std::min(i + r, which.size() - 1);
      rows[r] = &vectors[which[places[r]] * dimensions];
    }
    act(rows, places);
  }
}

/// k-means of the rows `which`, from rows at equal distances; empty entries move to the rows that
/// are farthest from theirs.
std::vector<float> k_means(std::span<const float> vectors, std::size_t dimensions,
                           std::span<const float> weights, std::span<const std::uint32_t> which,
                           std::size_t size, int steps) {
  size = std::min(size, which.size());
  std::vector<float> entries(size * dimensions);
  const auto copy_row = [&](std::size_t entry, std::size_t row) {
    std::copy_n(&vectors[which[row] * dimensions], dimensions, &entries[entry * dimensions]);
  };
  for (std::size_t k = 0; k < size; ++k) copy_row(k, (2 * k + 1) * which.size() / (2 * size));
  if (size == which.size()) return entries;
  std::vector<PointBlocks::Nearest> nearest(which.size());
  std::vector<double> sums(size * dimensions), mass(size);
  for (int step = 0; step < steps; ++step) {
    const PointBlocks blocks(entries, dimensions);
    in_groups(vectors, dimensions, which, [&](const auto& rows, const auto& places) {
      std::array<PointBlocks::Nearest, rows_at_once> best;
      blocks.improve(rows, 0, best);
      for (std::size_t r = 0; r < rows_at_once; ++r) nearest[places[r]] = best[r];
    });
    std::fill(sums.begin(), sums.end(), 0.0);
    std::fill(mass.begin(), mass.end(), 0.0);
    for (std::size_t i = 0; i < which.size(); ++i) {
      const double weight = double(weights[which[i]]);
      const std::size_t entry = nearest[i].point;
      mass[entry] += weight;
      for (std::size_t d = 0; d < dimensions; ++d)
        sums[entry * dimensions + d] += weight * double(vectors[which[i] * dimensions + d]);
    }
    std::vector<std::size_t> empty;
    for (std::size_t k = 0; k < size; ++k) {
      if (!(mass[k] > 0)) {
        empty.push_back(k);
        continue;
      }
      for (std::size_t d = 0; d < dimensions; ++d)
        entries[k * dimensions + d] = float(sums[k * dimensions + d] / mass[k]);
    }
    if (empty.empty()) continue;
    std::vector<std::pair<float, std::uint32_t>> errors(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) {
      float squared = 0;
      for (std::size_t d = 0; d < dimensions; ++d)
        squared += vectors[which[i] * dimensions + d] * vectors[which[i] * dimensions + d];
      errors[i] = {-weights[which[i]] * (2 * nearest[i].score + squared), std::uint32_t(i)};
    }
    std::partial_sort(errors.begin(), errors.begin() + std::ptrdiff_t(empty.size()), errors.end());
    for (std::size_t e = 0; e < empty.size(); ++e) copy_row(empty[e], errors[e].second);
  }
  return entries;
}

/// For each of 0..size - 1 the numbers i with of[i] equal to it, in order.
std::vector<std::vector<std::uint32_t>> members_of(std::span<const std::uint32_t> of,
                                                   std::size_t size) {
  std::vector<std::vector<std::uint32_t>> members(size);
  for (std::size_t i = 0; i < of.size(); ++i) members[of[i]].push_back(std::uint32_t(i));
  return members;
}

}  // namespace

Palette::Palette(std::span<const float> vectors, std::size_t dimensions,
                 std::span<const float> weights, std::size_t size)
    : vectors_(vectors),
      dimensions_(dimensions),
      weights_(weights),
      indices_(vectors.size() / dimensions) {
  if (indices_.size() <= size) {
    entries_.assign(vectors.begin(), vectors.end());
    std::iota(indices_.begin(), indices_.end(), 0u);
    return;
  }
  divide(size);
  for (int step = 0; step < whole_steps; ++step) {
    assign();
    move_entries();
  }
  assign();
}

void Palette::divide(std::size_t size) {
  const std::size_t cells = std::max<std::size_t>(1, size / entries_a_cell);
  const std::size_t rows = indices_.size(), sampled = std::min(rows, most_sampled);
  std::vector<std::uint32_t> sample(sampled);
  for (std::size_t i = 0; i < sampled; ++i) sample[i] = std::uint32_t(i * rows / sampled);
  centers_ = k_means(vectors_, dimensions_, weights_, sample, cells, cell_steps);

  find_probes();
  std::vector<float> errors(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    indices_[row] = probes_[row * probes()];
    const float* vector = &vectors_[row * dimensions_];
    const float* center = &centers_[indices_[row] * dimensions_];
    for (std::size_t d = 0; d < dimensions_; ++d)
      errors[row] += (vector[d] - center[d]) * (vector[d] - center[d]);
  }
  const auto members = members_of(indices_, cells);

  // Entries by cell: at least one, and no more than rows.
  std::vector<double> shares(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    double error = 0;
    for (const std::uint32_t row : members[c]) error += double(weights_[row]) * double(errors[row]);
    shares[c] = std::sqrt(error * double(members[c].size()));
  }
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
  std::vector<std::size_t> sizes(cells, 1);
  std::size_t left = size - cells;
  for (std::size_t c = 0; c < cells && total > 0; ++c) {
    const std::size_t room = members[c].empty() ? 0 : members[c].size() - 1;
    const auto wanted = std::size_t(double(size - cells) * shares[c] / total);
    const std::size_t more = std::min({wanted, room, left});
    sizes[c] += more;
    left -= more;
  }
  for (std::size_t c = 0; c < cells && left > 0; ++c) {
    const std::size_t room = members[c].empty() ? 0 : members[c].size() - sizes[c];
    const std::size_t more = std::min(room, left);
    sizes[c] += more;
    left -= more;
  }
  std::vector<std::vector<float>> entries(cells);
  ThreadPool pool;
  pool.run(cells, [&](std::size_t c) {
    entries[c] = members[c].empty()
                     ? std::vector<float>(centers_.begin() + std::ptrdiff_t(c * dimensions_),
                                          centers_.begin() + std::ptrdiff_t((c + 1) * dimensions_))
                     : k_means(vectors_, dimensions_, weights_, members[c], sizes[c], entry_steps);
  });
  cells_.assign(1, 0);
  for (const std::vector<float>& each : entries) {
    entries_.insert(entries_.end(), each.begin(), each.end());
    cells_.push_back(std::uint32_t(entries_.size() / dimensions_));
  }
}

std::size_t Palette::probes() const {
  return std::min(probed_cells, centers_.size() / dimensions_);
}

void Palette::find_probes() {
  const PointBlocks centers(centers_, dimensions_);
  const std::size_t cells = centers_.size() / dimensions_;
  probes_.resize(indices_.size() * probes());
  ThreadPool pool;
  pool.run((indices_.size() + rows_a_task - 1) / rows_a_task, [&](std::size_t task) {
    std::vector<std::uint32_t> which(std::min(rows_a_task, indices_.size() - task * rows_a_task));
    std::iota(which.begin(), which.end(), std::uint32_t(task * rows_a_task));
    std::array<std::vector<float>, rows_at_once> scores;
    std::array<float*, rows_at_once> out;
    for (std::size_t r = 0; r < rows_at_once; ++r) {
      scores[r].resize(centers.padded_count());
      out[r] = scores[r].data();
    }
    std::vector<std::uint8_t> order(cells);
    in_groups(vectors_, dimensions_, which, [&](const auto& group, const auto& places) {
      centers.scores(group, out);
      for (std::size_t r = 0; r < rows_at_once; ++r) {
        std::iota(order.begin(), order.end(), std::uint8_t(0));
        const auto end = order.begin() + std::ptrdiff_t(probes());
        std::partial_sort(order.begin(), end, order.end(), [&](std::uint8_t a, std::uint8_t b) {
          return scores[r][a] < scores[r][b] || (scores[r][a] == scores[r][b] && a < b);
        });
        std::copy(order.begin(), end,
                  probes_.begin() + std::ptrdiff_t(which[places[r]] * probes()));
      }
    });
  });
}

void Palette::assign() {
  const std::size_t cells = cells_.size() - 1;
  std::vector<PointBlocks> blocks;
  for (std::size_t c = 0; c < cells; ++c)
    blocks.emplace_back(std::span(entries_).subspan(cells_[c] * dimensions_,
                                                    (cells_[c + 1] - cells_[c]) * dimensions_),
                        dimensions_);
  ThreadPool pool;
  pool.run((indices_.size() + rows_a_task - 1) / rows_a_task, [&](std::size_t task) {
    const std::size_t first = task * rows_a_task;
    const std::size_t count = std::min(rows_a_task, indices_.size() - first);
    // The rows that probe each cell, so that its entries stay in the cache.
    std::vector<std::vector<std::uint32_t>> probing(cells);
    for (std::size_t i = first; i < first + count; ++i)
      for (std::size_t p = 0; p < probes(); ++p)
        probing[probes_[i * probes() + p]].push_back(std::uint32_t(i));
    std::vector<PointBlocks::Nearest> nearest(count);
    for (std::size_t c = 0; c < cells; ++c)
      if (!probing[c].empty())
        in_groups(vectors_, dimensions_, probing[c], [&](const auto& rows, const auto& places) {
          std::array<PointBlocks::Nearest, rows_at_once> best;
          for (std::size_t r = 0; r < rows_at_once; ++r)
            best[r] = nearest[probing[c][places[r]] - first];
          blocks[c].improve(rows, cells_[c], best);
          for (std::size_t r = 0; r < rows_at_once; ++r)
            nearest[probing[c][places[r]] - first] = best[r];
        });
    for (std::size_t i = 0; i < count; ++i) indices_[first + i] = nearest[i].point;
  });
}

void Palette::move_entries() {
  const auto members = members_of(indices_, count());
  ThreadPool pool;
  pool.run(cells_.size() - 1, [&](std::size_t cell) {
    std::vector<double> sum(dimensions_);
    for (std::size_t entry = cells_[cell]; entry < cells_[cell + 1]; ++entry) {
      if (members[entry].empty()) continue;
      double mass = 0;
      std::fill(sum.begin(), sum.end(), 0.0);
      for (const std::uint32_t row : members[entry]) {
        mass += double(weights_[row]);
        for (std::size_t d = 0; d < dimensions_; ++d)
          sum[d] += double(weights_[row]) * double(vectors_[row * dimensions_ + d]);
      }
      for (std::size_t d = 0; d < dimensions_; ++d)
        entries_[entry * dimensions_ + d] = float(sum[d] / mass);
    }
  });
}

void Palette::replace_entries(std::vector<float> entries) {
  entries_ = std::move(entries);
  if (!cells_.empty()) assign();
}

}  // namespace tureen
