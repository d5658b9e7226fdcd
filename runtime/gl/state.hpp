// The GL state that we depend on and that somebody who shares the context may have changed.
#pragma once

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Every fragment is written where it falls: the whole of a width x height target, no blending,
/// culling, stencil, scissor, dithering, coverage tricks or masked channels. Depth is tested and
/// written; the comparison is the caller's.
void use_plain_rasterisation(int width, int height);

/// Pixels move to and from memory in rows without gaps, and no pixel buffer stands in for memory.
void use_plain_pixel_transfer();

/// No sampler object overrides the filters of the texture on this unit.
void use_texture_sampling(unsigned unit);

/// Clip space's z from 0 to 1 becomes depth, as reversed depth wants it; or from -1 to 1, which is
/// GL's own. Only where there is clip control.
void use_zero_to_one_depth(Api api, bool zero_to_one);

/// Returns when the device has drawn all that it was asked for into this framebuffer. Browsers have
/// a glFinish that does not wait; there a pixel is read.
void wait_for_device(unsigned framebuffer);

}  // namespace tureen::gl
