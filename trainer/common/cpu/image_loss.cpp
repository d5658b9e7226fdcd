// A task is a band of rows of one view, with all three channels. It processes each channel in
// blocks of rows:
//   1. It reads pixel rows and filters them along x.
//   2. It filters eleven such rows along y, which gives a row of windows.
//   3. It filters eleven rows of windows along y and x, which gives a row of the gradient.
// The filters along y make a block of rows at once, because neighbouring results share ten of their
// eleven rows. Rings hold the intermediate rows and stay in the second-level cache. Bands overlap:
// each computes the ten rows above and below that it needs, so no task waits for another.
#include "trainer/common/cpu/image_loss.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/image_loss.hpp"

namespace tureen::trainer {

namespace {

constexpr int taps = ssim_window, reach = ssim_window - 1;

// Rows of a block. Its fourteen input rows and six weights fit in the 32 registers of AVX-512.
constexpr int block_rows = 4;

// Rows in a ring: what a block of results needs.
constexpr int ring_rows = taps + block_rows - 1;

// Maximum number of rows in a band. Each band repeats 20 rows of its neighbours. Lower bands repeat
// a larger part; higher bands give fewer tasks.
constexpr int band_rows = 128;

struct Band {
  std::size_t view;
  int first, last;  // rows of the gradient
  double l1 = 0;    // sum of |C - G|
  double dissimilarity = 0;
  std::size_t non_finite = 0;
};

// Planes of a pixel row, and of a window row.
enum { sum, difference, sum_squared, difference_squared, pixel_planes };
enum { by_sum_variance, by_difference_variance, constant, window_planes };

// Rows of one length, one after another in a buffer. Each begins at a multiple of 64 bytes: loads
// that straddle cache lines take twice as long.
template <class Real>
class Rows {
 public:
  static constexpr std::size_t alignment = 64 / sizeof(Real);

  Rows(int width) : stride_((std::size_t(width) + alignment - 1) / alignment * alignment) {}

  void lay_out(Real*& memory, std::size_t count) {
    begin_ = memory;
    memory += count * stride_;
  }
  Real* operator[](std::size_t row) const { return begin_ + row * stride_; }
  std::size_t stride() const { return stride_; }

 private:
  Real* begin_ = nullptr;
  std::size_t stride_;
};

// Buffers of a task. Each row holds the image's width plus 2 `reach` values; `spread` uses the
// width plus `reach`, windows use fewer.
template <class Real>
struct Workspace {
  Rows<Real> pixels;   // ring of sum and difference: slot * 2 + plane
  Rows<Real> squares;  // of the row that is being read: sum_squared, difference_squared
  Rows<Real> weighed;  // ring, weighed along x: slot * pixel_planes + plane
  Rows<Real> moments;  // of a block of windows: plane * block_rows + row
  Rows<Real> windows;  // ring: slot * window_planes + plane
  Rows<Real> spread;   // a block of windows weighed along y, `reach` zeros at both ends
  Rows<Real> zeros;    // windows past the border
  Rows<Real> values;   // 1 - SSIM of a row of windows; |C - G| of a row of pixels

  static constexpr std::size_t row_count =
      (2 + pixel_planes + window_planes) * ring_rows + (pixel_planes + 1) * block_rows + 2 + 1 + 1;

  static std::size_t size(int width) {
    return row_count * Rows<Real>(width + 2 * reach).stride() + Rows<Real>::alignment;
  }

  Workspace(std::vector<Real>& buffer, int width)
      : pixels(width + 2 * reach),
        squares(pixels),
        weighed(pixels),
        moments(pixels),
        windows(pixels),
        spread(pixels),
        zeros(pixels),
        values(pixels) {
    const auto address = reinterpret_cast<std::uintptr_t>(buffer.data());
    Real* memory = buffer.data() + (64 - address % 64) % 64 / sizeof(Real);
    pixels.lay_out(memory, 2 * ring_rows);
    squares.lay_out(memory, 2);
    weighed.lay_out(memory, pixel_planes * ring_rows);
    moments.lay_out(memory, pixel_planes * block_rows);
    windows.lay_out(memory, window_planes * ring_rows);
    spread.lay_out(memory, block_rows);
    zeros.lay_out(memory, 1);
    values.lay_out(memory, 1);
    std::fill_n(zeros[0], zeros.stride(), Real(0));
    std::fill_n(spread[0], block_rows * spread.stride(), Real(0));
  }
};

// The two filters, which take most of the time. They are not inlined into BandLoss, where the
// compiler has too few registers for that many rows.
template <class Real>
TUREEN_ALWAYS_INLINE void weigh_columns(const Real* in, Real* out, int n) {
  constexpr Real w0 = Real(ssim_weight(0)), w1 = Real(ssim_weight(1)), w2 = Real(ssim_weight(2)),
                 w3 = Real(ssim_weight(3)), w4 = Real(ssim_weight(4)), w5 = Real(ssim_weight(5));
  TUREEN_INDEPENDENT_TURNS
  for (int x = 0; x < n; ++x)
    out[x] = w5 * (in[x] + in[x + 10]) + w4 * (in[x + 1] + in[x + 9]) +
             w3 * (in[x + 2] + in[x + 8]) + w2 * (in[x + 3] + in[x + 7]) +
             w1 * (in[x + 4] + in[x + 6]) + w0 * in[x + 5];
}

// The weighted sum of eleven values.
template <class Real>
TUREEN_ALWAYS_INLINE Real weighed(Real v0, Real v1, Real v2, Real v3, Real v4, Real v5, Real v6,
                                  Real v7, Real v8, Real v9, Real v10) {
  constexpr Real w0 = Real(ssim_weight(0)), w1 = Real(ssim_weight(1)), w2 = Real(ssim_weight(2)),
                 w3 = Real(ssim_weight(3)), w4 = Real(ssim_weight(4)), w5 = Real(ssim_weight(5));
  return w5 * (v0 + v10) + w4 * (v1 + v9) + w3 * (v2 + v8) + w2 * (v3 + v7) + w1 * (v4 + v6) +
         w0 * v5;
}

template <class Real>
TUREEN_ALWAYS_INLINE void weigh_rows(const std::array<const Real*, ring_rows>& rows,
                                     const std::array<Real*, block_rows>& out, int n) {
  const auto [r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11, r12, r13] = rows;
  const auto [out0, out1, out2, out3] = out;
  TUREEN_INDEPENDENT_TURNS
  for (int x = 0; x < n; ++x) {
    const Real v0 = r0[x], v1 = r1[x], v2 = r2[x], v3 = r3[x], v4 = r4[x], v5 = r5[x], v6 = r6[x],
               v7 = r7[x], v8 = r8[x], v9 = r9[x], v10 = r10[x], v11 = r11[x], v12 = r12[x],
               v13 = r13[x];
    out0[x] = weighed(v0, v1, v2, v3, v4, v5, v6, v7, v8, v9, v10);
    out1[x] = weighed(v1, v2, v3, v4, v5, v6, v7, v8, v9, v10, v11);
    out2[x] = weighed(v2, v3, v4, v5, v6, v7, v8, v9, v10, v11, v12);
    out3[x] = weighed(v3, v4, v5, v6, v7, v8, v9, v10, v11, v12, v13);
  }
}

// out[x] for x < n is the weighted sum of in[x] .. in[x + 10].
TUREEN_VECTOR_CLONES void weigh_along_x(const float* in, float* out, int n) {
  weigh_columns(in, out, n);
}
void weigh_along_x(const double* in, double* out, int n) { weigh_columns(in, out, n); }

// out[i][x] for x < n is the weighted sum of rows[i][x] .. rows[i + 10][x].
TUREEN_VECTOR_CLONES void weigh_along_y(const std::array<const float*, ring_rows>& rows,
                                        const std::array<float*, block_rows>& out, int n) {
  weigh_rows(rows, out, n);
}
void weigh_along_y(const std::array<const double*, ring_rows>& rows,
                   const std::array<double*, block_rows>& out, int n) {
  weigh_rows(rows, out, n);
}

// Sixteen lanes fix the order of the additions and still let the loop vectorise.
template <class Real>
TUREEN_ALWAYS_INLINE double total(const Real* values, int n) {
  constexpr int lane_count = 16;
  double lanes[lane_count] = {};
  int x = 0;
  for (; x + lane_count <= n; x += lane_count)
    for (int i = 0; i < lane_count; ++i) lanes[i] += double(values[x + i]);
  double result = 0;
  for (; x < n; ++x) result += double(values[x]);
  for (const double lane : lanes) result += lane;
  return result;
}

template <class Real>
class BandLoss {
 public:
  TUREEN_ALWAYS_INLINE BandLoss(const ImageLossView<Real>& view, Band& band,
                                typename ImageLossScratch<Real>::Buffer& buffer)
      : view_(view),
        band_(band),
        work_(buffer.rows, view.width),
        width_(view.width),
        columns_(view.width - reach),
        window_rows_(view.height - reach),
        has_ssim_(columns_ > 0 && window_rows_ > 0),
        first_row_(std::max(0, band.first - reach)),
        last_row_(std::min(view.height, band.last + reach)),
        ignored_(buffer.ignored) {}

  TUREEN_ALWAYS_INLINE void run() {
    mark_ignored();
    if (!view_.pixel_loss.empty()) std::fill_n(&view_.pixel_loss[at(band_.first)], own(), Real(0));
    for (int c = 0; c < 3; ++c) {
      channel_ = c;
      if (has_ssim_)
        stream();
      else
        for (int y = band_.first; y < band_.last; ++y) {
          read(y);
          write(y, 1);
        }
    }
  }

 private:
  std::size_t at(int y) const { return std::size_t(y) * width_; }
  std::size_t own() const { return std::size_t(band_.last - band_.first) * width_; }
  std::size_t plane() const { return std::size_t(view_.width) * view_.height; }
  const std::uint8_t* ignored(int y) const { return &ignored_[at(y - first_row_)]; }

  /// Marks the ignored pixels, and counts the pixels of this band that are not finite.
  TUREEN_ALWAYS_INLINE void mark_ignored() {
    ignored_.resize(at(last_row_ - first_row_));
    for (int y = first_row_; y < last_row_; ++y) {
      const Real* red = &view_.rendered[at(y)];
      const Real* green = red + plane();
      const Real* blue = green + plane();
      std::uint8_t* __restrict out = &ignored_[at(y - first_row_)];
      int count = 0;
      for (int x = 0; x < width_; ++x) {
        // NaN and infinity times zero are NaN, and NaN == 0 is false.
        const bool finite = red[x] * 0 + green[x] * 0 + blue[x] * 0 == 0;
        out[x] = finite ? 0 : 1;
        count += finite ? 0 : 1;
      }
      if (y >= band_.first && y < band_.last) band_.non_finite += std::size_t(count);
      if (view_.ignored.empty()) continue;
      const std::uint8_t* named = &view_.ignored[at(y)];
      for (int x = 0; x < width_; ++x) out[x] |= named[x];
    }
  }

  /// Row w of the windows needs pixel rows w .. w + 10; row y of the gradient, windows y - 10 .. y.
  TUREEN_ALWAYS_INLINE void stream() {
    for (int y = first_row_; y < last_row_; y += block_rows) {
      const int end = std::min(y + block_rows, last_row_);
      for (int row = y; row < end; ++row) {
        read(row);
        weigh(row);
      }
      const int window = std::max(y - reach, first_row_), windows_end = end - reach;
      if (window >= windows_end) continue;
      compare(window, windows_end - window);
      const int row = std::max(window, band_.first);
      if (row < windows_end) write(row, windows_end - row);
    }
    // The last rows of the image have no windows below them.
    for (int y = std::max(band_.first, window_rows_); y < band_.last; y += block_rows)
      write(y, std::min(block_rows, band_.last - y));
  }

  TUREEN_ALWAYS_INLINE void read(int y) {
    const Real* rendered = &view_.rendered[channel_ * plane() + at(y)];
    const std::uint8_t* target = &view_.target[channel_ * plane() + at(y)];
    const std::uint8_t* skip = ignored(y);
    Real* __restrict s = work_.pixels[y % ring_rows * 2 + sum];
    Real* __restrict d = work_.pixels[y % ring_rows * 2 + difference];
    Real* __restrict ss = work_.squares[0];
    Real* __restrict dd = work_.squares[1];
    TUREEN_INDEPENDENT_TURNS
    for (int x = 0; x < width_; ++x) {
      const Real photograph = Real(target[x]) / Real(255);
      const Real colour = skip[x] ? photograph : rendered[x];
      const SsimPixel<Real> pixel = ssim_pixel(colour, photograph);
      s[x] = pixel.sum;
      d[x] = pixel.difference;
      ss[x] = pixel.sum * pixel.sum;
      dd[x] = pixel.difference * pixel.difference;
    }
  }

  TUREEN_ALWAYS_INLINE void weigh(int y) {
    const int slot = y % ring_rows;
    const std::array<const Real*, pixel_planes> in = {work_.pixels[slot * 2 + sum],
                                                      work_.pixels[slot * 2 + difference],
                                                      work_.squares[0], work_.squares[1]};
    for (int p = 0; p < pixel_planes; ++p)
      weigh_along_x(in[p], work_.weighed[slot * pixel_planes + p], columns_);
  }

  /// The rows of `plane` in the block's moments.
  TUREEN_ALWAYS_INLINE std::array<Real*, block_rows> moments(int plane) {
    std::array<Real*, block_rows> rows;
    for (int i = 0; i < block_rows; ++i) rows[i] = work_.moments[plane * block_rows + i];
    return rows;
  }

  /// A block of at most block_rows rows of windows.
  TUREEN_ALWAYS_INLINE void compare(int first, int count) {
    std::array<const Real*, ring_rows> rows;
    for (int p = 0; p < pixel_planes; ++p) {
      for (int i = 0; i < ring_rows; ++i)
        rows[i] = i < reach + count ? work_.weighed[(first + i) % ring_rows * pixel_planes + p]
                                    : work_.zeros[0];
      weigh_along_y(rows, moments(p), columns_);
    }
    for (int i = 0; i < count; ++i) compare_row(first + i, i);
  }

  /// `row`: of the window in its block.
  TUREEN_ALWAYS_INLINE void compare_row(int window, int row) {
    const Real *s = moments(sum)[row], *d = moments(difference)[row],
               *ss = moments(sum_squared)[row], *dd = moments(difference_squared)[row];
    const int slot = window % ring_rows * window_planes;
    Real* __restrict p = work_.windows[slot + by_sum_variance];
    Real* __restrict q = work_.windows[slot + by_difference_variance];
    Real* __restrict r = work_.windows[slot + constant];
    Real* __restrict value = work_.values[0];
    TUREEN_INDEPENDENT_TURNS
    for (int x = 0; x < columns_; ++x) {
      const SsimDissimilarity<Real> here =
          ssim_dissimilarity(SsimMoments<Real>{s[x], d[x], ss[x], dd[x]});
      p[x] = here.by_sum_variance;
      q[x] = here.by_difference_variance;
      r[x] = here.constant;
      value[x] = here.value;
    }
    if (window >= band_.first && window < band_.last) band_.dissimilarity += total(value, columns_);
  }

  /// Reuses the planes of `moments`: they now hold the weighted sums over the windows.
  TUREEN_ALWAYS_INLINE void gather(int y, int count) {
    std::array<const Real*, ring_rows> rows;
    std::array<Real*, block_rows> spread;
    for (int i = 0; i < block_rows; ++i) spread[i] = work_.spread[i] + reach;
    for (int p = 0; p < window_planes; ++p) {
      for (int i = 0; i < ring_rows; ++i) {
        const int window = y - reach + i;
        rows[i] = i < reach + count && window >= 0 && window < window_rows_
                      ? work_.windows[window % ring_rows * window_planes + p]
                      : work_.zeros[0];
      }
      weigh_along_y(rows, spread, columns_);
      for (int i = 0; i < count; ++i) weigh_along_x(work_.spread[i], moments(p)[i], width_);
    }
  }

  /// A block of at most block_rows rows of the gradient.
  TUREEN_ALWAYS_INLINE void write(int first, int count) {
    if (has_ssim_) gather(first, count);
    for (int i = 0; i < count; ++i) write_row(first + i, i);
  }

  /// `row`: of y in its block.
  TUREEN_ALWAYS_INLINE void write_row(int y, int row) {
    const Real l1_scale = view_.l1_weight / Real(3 * plane());
    const Real* s = work_.pixels[y % ring_rows * 2 + sum];
    const Real* d = work_.pixels[y % ring_rows * 2 + difference];
    Real* __restrict gradient = &view_.gradient[channel_ * plane() + at(y)];
    Real* __restrict value = work_.values[0];
    TUREEN_INDEPENDENT_TURNS
    for (int x = 0; x < width_; ++x) {
      gradient[x] = l1_scale * sign(d[x]);
      value[x] = std::abs(d[x]);
    }
    band_.l1 += total(value, width_);
    if (!view_.pixel_loss.empty()) {
      Real* __restrict pixel_loss = &view_.pixel_loss[at(y)];
      for (int x = 0; x < width_; ++x) pixel_loss[x] += value[x];
    }
    if (!has_ssim_) return;

    const Real ssim_scale =
        view_.ssim_weight / (Real(6) * Real(std::size_t(columns_) * window_rows_));
    const std::uint8_t* skip = ignored(y);
    const Real *p = moments(by_sum_variance)[row], *q = moments(by_difference_variance)[row],
               *r = moments(constant)[row];
    TUREEN_INDEPENDENT_TURNS
    for (int x = 0; x < width_; ++x) {
      const Real slope = ssim_derivative(SsimPixel<Real>{s[x], d[x]}, p[x], q[x], r[x]);
      const Real both = gradient[x] + ssim_scale * slope;
      gradient[x] = skip[x] ? Real(0) : both;
    }
  }

  const ImageLossView<Real>& view_;
  Band& band_;
  Workspace<Real> work_;
  int width_;
  int columns_, window_rows_;  // of windows
  bool has_ssim_;
  int first_row_, last_row_;  // of pixels that are read
  std::vector<std::uint8_t>& ignored_;
  int channel_ = 0;
};

TUREEN_VECTOR_CLONES void run_band(const ImageLossView<float>& view, Band& band,
                                   ImageLossScratch<float>::Buffer& buffer) {
  BandLoss<float>(view, band, buffer).run();
}

void run_band(const ImageLossView<double>& view, Band& band,
              ImageLossScratch<double>::Buffer& buffer) {
  BandLoss<double>(view, band, buffer).run();
}

// Bands of nearly equal height.
template <class Real>
std::vector<Band> bands_of(std::span<const ImageLossView<Real>> views) {
  std::vector<Band> bands;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const int height = views[i].height;
    const int count = (height + band_rows - 1) / band_rows;
    for (int b = 0; b < count; ++b)
      bands.push_back(
          {i, int(std::int64_t(height) * b / count), int(std::int64_t(height) * (b + 1) / count)});
  }
  return bands;
}

template <class Real>
void assert_shapes([[maybe_unused]] const ImageLossView<Real>& view) {
  [[maybe_unused]] const std::size_t pixels = std::size_t(view.width) * view.height;
  assert(view.width > 0 && view.height > 0);
  assert(view.rendered.size() == 3 * pixels && view.target.size() == 3 * pixels);
  assert(view.gradient.size() == 3 * pixels);
  assert(view.ignored.empty() || view.ignored.size() == pixels);
  assert(view.pixel_loss.empty() || view.pixel_loss.size() == pixels);
}

template <class Real>
void add_up(std::span<const ImageLossView<Real>> views, std::span<const Band> bands,
            std::span<ImageLoss> results) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    double l1 = 0, dissimilarity = 0;
    ImageLoss& result = results[i] = {};
    for (const Band& band : bands) {
      if (band.view != i) continue;
      l1 += band.l1;
      dissimilarity += band.dissimilarity;
      result.non_finite += band.non_finite;
    }
    const ImageLossView<Real>& view = views[i];
    result.l1 = l1 / (3.0 * view.width * view.height);
    const double columns = view.width - reach, rows = view.height - reach;
    const double dissimilar = columns > 0 && rows > 0 ? dissimilarity / (3 * columns * rows) : 0;
    result.ssim = 1 - dissimilar;
    result.loss = double(view.l1_weight) * result.l1 + double(view.ssim_weight) * dissimilar / 2;
  }
}

}  // namespace

template <class Real>
auto ImageLossScratch<Real>::take() -> Buffer {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return {};
  Buffer buffer = std::move(free_.back());
  free_.pop_back();
  return buffer;
}

template <class Real>
void ImageLossScratch<Real>::give(Buffer&& buffer) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(buffer));
}

template <class Real>
void image_losses(std::span<const ImageLossView<Real>> views, std::span<ImageLoss> results,
                  ImageLossScratch<Real>& scratch, ThreadPool& pool) {
  assert(results.size() == views.size());
  for (const ImageLossView<Real>& view : views) assert_shapes(view);
  std::vector<Band> bands = bands_of(views);
  pool.run(bands.size(), [&](std::size_t task) {
    Band band = bands[task];  // a copy: neighbours in the vector share cache lines
    const ImageLossView<Real>& view = views[band.view];
    auto buffer = scratch.take();
    buffer.rows.resize(std::max(buffer.rows.size(), Workspace<Real>::size(view.width)));
    run_band(view, band, buffer);
    scratch.give(std::move(buffer));
    bands[task] = band;
  });
  add_up<Real>(views, bands, results);
}

template class ImageLossScratch<float>;
template class ImageLossScratch<double>;
template void image_losses(std::span<const ImageLossView<float>>, std::span<ImageLoss>,
                           ImageLossScratch<float>&, ThreadPool&);
template void image_losses(std::span<const ImageLossView<double>>, std::span<ImageLoss>,
                           ImageLossScratch<double>&, ThreadPool&);

}  // namespace tureen::trainer
