// Draws views, measures the time of each, and writes them as images or as a video.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/image_tiles.hpp"
#include "runtime/renderer.hpp"
#include "scene/image_source.hpp"

namespace tureen::cli {

/// A renderer, and what its images need.
struct Drawer {
  /// Draws a frame, and waits for the device. Slow renderers call `progress` with the fraction
  /// done.
  std::function<void(const FrameInput& input, const std::function<void(double)>& progress)> draw;
  std::function<Image8()> read;
  std::function<ImageTiles()> tiles;
  /// Whether an image exceeds the limits of the device, or its targets would need more than 1 GiB.
  std::function<bool(const Camera& camera)> needs_tiles;
  bool warms_up = true;  // the first frame compiles shaders; its time does not count
};

/// `renderer` and `device` must outlive the Drawer.
Drawer drawer_of(Renderer& renderer, const gl::Capabilities& device);
/// Images of any size from a slow renderer, which calls `progress`. `source` and `progress` must
/// outlive the Drawer. `opaque`: alpha becomes 1.
Drawer drawer_of(ImageSource& source, std::function<void(double)>& progress, bool opaque);

struct WrittenImages {
  std::vector<std::string> paths;
  std::vector<double> ms;  // per frame, from before the draw to after the device has finished
};

enum class Sheet { none, of_several };

struct ImageNames {
  std::string pattern;  // of image_name(), cli/files/image_file.hpp
  Sheet sheet = Sheet::of_several;
};

/// The contact sheet beside the images of this pattern.
std::filesystem::path contact_sheet_name(const std::string& pattern);

/// Writes one image per camera. With Sheet::of_several and more than one camera, also writes
/// contact_sheet.png beside them. Images beyond the limits of the device are drawn in tiles; their
/// time is the sum over the tiles. Throws OutputError.
WrittenImages draw_images(const Drawer& drawer, const std::vector<Camera>& cameras,
                          const ImageNames& names);

/// Writes the frames as a video (image/video_file.hpp), completely or not at all.
WrittenImages draw_video(const Drawer& drawer, const std::vector<Camera>& cameras,
                         double frames_per_second, const std::string& path);

/// Milliseconds of `frames` frames, with all cameras in turn. The 3 to 10 frames before them
/// compile shaders and fill caches, and are not counted. Throws UsageError for images that need
/// tiles.
std::vector<double> benchmark(const Drawer& drawer, const std::vector<Camera>& cameras, int frames);

}  // namespace tureen::cli
