// The image loss of training and its gradient on the processor: separable windows over planes of
// floats, one task for each band of rows.
//
//   loss = l1_weight * mean |C - G| + ssim_weight * (1 - SSIM) / 2
//
// for one view; C is the rendered image, G the photograph (trainer/common/kernels/image_loss.hpp).
// The SSIM is the same as in image/ssim.hpp with SsimBorder::valid. The weights 0.8 and 0.2 are
// from the DiffSoup paper; the factor 1/2 is only in the authors' program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "base/threads/thread_pool.hpp"

namespace tureen::trainer {

/// One view and the buffers for its results. All planes are [channel][y][x], row 0 at the top,
/// without gaps. Real is float in training and double in tests.
template <class Real>
struct ImageLossView {
  int width = 0;
  int height = 0;
  std::span<const Real> rendered;        // 3 planes, nominally in [0, 1], not clamped
  std::span<const std::uint8_t> target;  // 3 planes, value = byte / 255
  /// One plane, 1 for ignored pixels; empty if no pixel is ignored.
  std::span<const std::uint8_t> ignored = {};
  Real l1_weight = Real(0.8);
  Real ssim_weight = Real(0.2);
  /// Output, 3 planes: the derivative of this view's loss by `rendered`.
  std::span<Real> gradient;
  /// Output, one plane: sum over the channels of |C - G|, 0 for ignored pixels; may be empty.
  std::span<Real> pixel_loss = {};
};

struct ImageLoss {
  double l1 = 0;    // mean |C - G|
  double ssim = 1;  // mean over the windows and channels
  double loss = 0;  // the formula above
  /// Number of pixels with a channel that is NaN or infinite. They are ignored like the pixels in
  /// ImageLossView::ignored: C = G in all channels, so neighbours are unaffected, and the gradient
  /// is 0. Means still divide by the number of all pixels.
  std::size_t non_finite = 0;
};

/// Buffers for image_losses(), kept between calls: about 150 rows of floats per thread.
template <class Real>
class ImageLossScratch {
 public:
  struct Buffer {
    std::vector<Real> rows;
    std::vector<std::uint8_t> ignored;
  };

  /// Returns an unused buffer with unspecified contents. The caller must give() it back.
  Buffer take();
  void give(Buffer&& buffer);

 private:
  std::mutex mutex_;
  std::vector<Buffer> free_;
};

/// The losses of several views; results[i] belongs to views[i]. A view that is narrower or lower
/// than the SSIM window has no SSIM term: its ssim is 1, and its loss and gradient come from L1
/// alone. The result has the same bits with any number of threads.
template <class Real>
void image_losses(std::span<const ImageLossView<Real>> views, std::span<ImageLoss> results,
                  ImageLossScratch<Real>& scratch, ThreadPool& pool);

/// The loss of one view.
template <class Real>
ImageLoss image_loss(const ImageLossView<Real>& view, ImageLossScratch<Real>& scratch,
                     ThreadPool& pool) {
  ImageLoss result;
  image_losses<Real>({&view, 1}, {&result, 1}, scratch, pool);
  return result;
}

}  // namespace tureen::trainer
