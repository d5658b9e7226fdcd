// Images and animations for keeps, drawn by a renderer of their own in the background: the window
// goes on, whatever their size.
#pragma once

#include <filesystem>

#include "camera/camera_path.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/stage.hpp"

namespace tureen::viewer {

struct ImageJob {
  StageSource scene;
  Camera camera;  // with the image's size, which may be beyond the device's
  DebugViewChoice debug_view = {};
  bool transparent = false;
  std::filesystem::path path;
};

/// A PNG, drawn in tiles and written row by row. What is made for it on the device is gone at
/// the end. Throws OutputError, DeviceLimitError and what
/// StageRequest::progress throws; then nothing is written.
void write_image(const ImageJob& job, const StageRequest& request);

struct AnimationJob {
  StageSource scene;
  CameraPath path;
  FrameRate rate;
  /// A video where its name is one's (image/video_file.hpp), otherwise a folder for frames.
  std::filesystem::path output;
};

/// Likewise; frames that were written before an end by force stay, of a video nothing.
void write_animation(const AnimationJob& job, const StageRequest& request);

}  // namespace tureen::viewer
