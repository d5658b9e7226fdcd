// GL state that we depend on and that other users of the context may have changed.
#pragma once

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Every fragment is written: the whole of a width x height target, without blending, culling,
/// stencil, scissor, dithering, sample coverage or masked channels. Depth is tested and written;
/// the caller sets the comparison.
void use_plain_rasterisation(int width, int height);

/// Pixel transfers use main memory, rows without gaps and no pixel buffer.
void use_plain_pixel_transfer();

/// Maps clip space's z to depth from [0, 1], for reversed depth, or from [-1, 1], GL's default.
/// Requires Capabilities::clip_control.
void use_zero_to_one_depth(Api api, bool zero_to_one);

/// Returns when the device has finished drawing into this framebuffer. In a browser glFinish does
/// not wait, so a pixel is read instead.
void wait_for_device(unsigned framebuffer);

}  // namespace tureen::gl
