// Frames drawn at another size than they are shown at: larger and averaged down (supersampling), or
// smaller and interpolated up (resolution scale). Each wraps any pipeline, also one of these.
//
// Both filter what is seen, not what is stored: colours are weighted with their alpha, so that a
// transparent background lends no colour to the edges over it.
#pragma once

#include <memory>

#include "runtime/passes/pipeline.hpp"

namespace tureen {

/// The largest picture that a device draws, in pixels a side.
struct PictureLimit {
  gl::Api api = gl::Api::desktop;
  int max_side = 0;
};

/// Draws n x n samples a pixel on a regular grid, as OracleOptions::supersampling does, and shows
/// their mean (a box filter). resize() throws DeviceLimitError where n times the size is more than
/// the device draws.
std::unique_ptr<Pipeline> make_supersampled(std::unique_ptr<Pipeline> pipeline, int n,
                                            const PictureLimit& limit);

/// The size that `scale`, 0 < scale <= 1, draws a picture of `size` pixels at: rounded, at least 1.
int scaled_size(int size, double scale);

/// Draws scaled_size() of both sides, edge to edge the same picture, and interpolates linearly
/// between the centres of its samples. Pixels beyond the outermost centres repeat those samples.
std::unique_ptr<Pipeline> make_upscaled(std::unique_ptr<Pipeline> pipeline, double scale,
                                        const PictureLimit& limit);

}  // namespace tureen
