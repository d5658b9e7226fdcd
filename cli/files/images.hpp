// Views drawn one after another and written, with the time of each.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/debug_views/debug_view_renderer.hpp"
#include "runtime/image_tiles.hpp"
#include "runtime/renderer.hpp"

namespace tureen::cli {

/// Milliseconds a frame, each from before the draw to after the device has finished.
struct FrameTimes {
  std::vector<double> ms;

  double median() const;
  /// The smallest that 95 % of all are not above.
  double p95() const;
};

/// What draws: a renderer, of colours or of debug views.
struct Drawer {
  std::function<void(const Camera& camera)> draw;  // and waits for the device
  std::function<Image8()> read;
  std::function<ImageTiles()> tiles;
  int supersampling = 1;
  double resolution_scale = 1.0;
};

/// `renderer`, `debug_renderer` and `device` must outlive them.
Drawer drawer_of(Renderer& renderer, const gl::Capabilities& device);
Drawer drawer_of(DebugViewRenderer& debug_renderer, const gl::Capabilities& device);

struct WrittenImages {
  std::vector<std::string> paths;
  FrameTimes times;
};

enum class Sheet { none, of_several };

struct ImageNames {
  std::string pattern;  // as cli/files/image_file.hpp takes it
  Sheet sheet = Sheet::of_several;
};

/// An image each, and where it is wanted a contact sheet of several beside them. What the device
/// cannot draw at once is drawn in tiles, whose times are added up. Throws OutputError.
WrittenImages draw_images(const Drawer& drawer, const gl::Capabilities& device,
                          const std::vector<Camera>& cameras, const ImageNames& names);

/// Frame by frame into a video (image/video_file.hpp), whole or not at all.
WrittenImages draw_video(const Drawer& drawer, const std::vector<Camera>& cameras,
                         double frames_per_second, const std::string& path);

/// `frames` frames through all cameras in turn. The first ones, which compile shaders and fill
/// caches, are drawn before and not counted. Throws UsageError for images that would be drawn in
/// tiles.
FrameTimes benchmark(const Drawer& drawer, const gl::Capabilities& device,
                     const std::vector<Camera>& cameras, int frames);

}  // namespace tureen::cli
