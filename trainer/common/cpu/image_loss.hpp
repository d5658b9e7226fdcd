// The image loss of training and its gradient on the processor: separable windows over planes of
// floats, a band of rows a task.
//
//   loss = l1_weight * mean |C - G| + ssim_weight * (1 - SSIM) / 2
//
// over one view; C is what was rendered, G the photograph, see
// trainer/common/kernels/image_loss.hpp. The SSIM is that of image/ssim.hpp with SsimBorder::valid.
// The paper's weights are 0.8 and 0.2; the half is in the authors' program only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "trainer/common/cpu/thread_pool.hpp"

namespace tureen::trainer {

/// One view and where its results go. All planes are [channel][y][x], row 0 the top row, without
/// gaps. Real is float to train with, double to test with.
template <class Real>
struct ImageLossView {
  int width = 0;
  int height = 0;
  std::span<const Real> rendered;        // 3 planes, nominally in [0, 1], not clamped
  std::span<const std::uint8_t> target;  // 3 planes, value = byte / 255
  /// 1 for pixels that do not count, one plane; may be empty: all count.
  std::span<const std::uint8_t> ignored = {};
  Real l1_weight = Real(0.8);
  Real ssim_weight = Real(0.2);
  /// Written, 3 planes: the derivative of this view's loss by `rendered`.
  std::span<Real> gradient;
  /// Written, one plane: sum over the channels of |C - G|, 0 where ignored; may be empty.
  std::span<Real> pixel_loss = {};
};

struct ImageLoss {
  double l1 = 0;    // mean |C - G|
  double ssim = 1;  // mean over the windows and channels
  double loss = 0;  // as above
  /// Pixels with a channel that is NaN or infinite. They are ignored like those that the caller
  /// names: C is taken to be G there, in all channels, so that neighbours are not touched, and the
  /// gradient is 0. Means are still over all pixels.
  std::size_t non_finite = 0;
};

/// Memory that image_losses() works in, kept between calls: about 100 rows of floats a thread.
template <class Real>
class ImageLossScratch {
 public:
  struct Buffer {
    std::vector<Real> rows;
    std::vector<std::uint8_t> ignored;
  };

  /// One that nobody uses, with unspecified contents; one thread's until it is given back.
  Buffer take();
  void give(Buffer&& buffer);

 private:
  std::mutex mutex_;
  std::vector<Buffer> free_;
};

/// The losses of several views; results[i] is that of views[i]. A view that is narrower or lower
/// than the window of SSIM has no such term: its ssim is 1 and its loss and gradient are those of
/// L1 alone. The same bits with any number of threads.
template <class Real>
void image_losses(std::span<const ImageLossView<Real>> views, std::span<ImageLoss> results,
                  ImageLossScratch<Real>& scratch, ThreadPool& pool);

/// That of one.
template <class Real>
ImageLoss image_loss(const ImageLossView<Real>& view, ImageLossScratch<Real>& scratch,
                     ThreadPool& pool) {
  ImageLoss result;
  image_losses<Real>({&view, 1}, {&result, 1}, scratch, pool);
  return result;
}

}  // namespace tureen::trainer
