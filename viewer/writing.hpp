// Writes images and animations of any size, with their own renderer in the background. The window
// stays usable.
#pragma once

#include <filesystem>

#include "camera/camera_path.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/scene/stage.hpp"

namespace tureen::viewer {

struct ImageJob {
  SceneSource scene;
  Camera camera;  // with the image's size, which may exceed the device's limit
  DebugViewChoice debug_view = {};
  bool transparent = false;
  bool at_rest = false;  // the image at rest (Renderer::draw_at_rest), where the scene has one
  int rays = 0;          // jittered ones per pixel, without OpenGL; 0: by the renderer
  std::filesystem::path path;
};

/// Writes a PNG, drawn in tiles and written row by row. Releases its device memory at the end.
/// Throws OutputError, DeviceLimitError and the exceptions of StageRequest::progress; then nothing
/// is written.
void write_image(const ImageJob& job, const StageRequest& request);

struct AnimationJob {
  SceneSource scene;
  CameraPath path;
  FrameRate rate;
  /// A video file if its name is one (image/video_file.hpp), otherwise a folder for frames.
  std::filesystem::path output;
};

/// Throws as write_image(). Frames written before an exception remain; of a video nothing remains.
void write_animation(const AnimationJob& job, const StageRequest& request);

}  // namespace tureen::viewer
