// The image by rays that covers the rasteriser's while nothing moves (application_tracing.cpp).
#pragma once

#include "viewer/gui/texture.hpp"

namespace tureen::viewer {

struct TracedView {
  ImageTexture texture;  // with the size of the image; empty: none is drawn yet
  double sharp = 0;      // the part of the pixels that have their own ray, 0..1
  int samples = 0;       // complete ones per pixel
  int wanted = 1;
  bool is_running = false, is_complete = false;
};

}  // namespace tureen::viewer
