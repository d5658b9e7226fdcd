// Frames rendered at another size than displayed: larger and averaged (supersampling), or smaller
// and interpolated (resolution scale). Each wraps any pipeline, including another of these.
//
// Both filter visible colours, not stored ones: colours are weighted by alpha, so a transparent
// background does not affect the colour of edges.
#pragma once

#include <memory>

#include "runtime/passes/pipeline.hpp"

namespace tureen {

/// Largest image that a device draws, in pixels a side.
struct ImageLimit {
  gl::Api api = gl::Api::desktop;
  int max_side = 0;
};

/// Draws n x n samples a pixel on a regular grid, as OracleOptions::supersampling does, and returns
/// their mean (a box filter). resize() throws DeviceLimitError if n times the size exceeds the
/// device's limit.
std::unique_ptr<Pipeline> make_supersampled(std::unique_ptr<Pipeline> pipeline, int n,
                                            const ImageLimit& limit);

/// The rendered size for an image of `size` pixels at `scale`, 0 < scale <= 1: rounded, at least 1.
int scaled_size(int size, double scale);

/// Draws the same image at scaled_size() of both sides, edge to edge, and interpolates bilinearly
/// between its sample centres. Pixels beyond the outermost centres repeat those samples.
std::unique_ptr<Pipeline> make_upscaled(std::unique_ptr<Pipeline> pipeline, double scale,
                                        const ImageLimit& limit);

}  // namespace tureen
