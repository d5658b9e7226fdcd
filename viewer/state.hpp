// All that the window knows, and what may be asked of it. Panels read the state, change what is
// plainly a setting, and ask for the rest; viewer/application carries it out between frames.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "camera/camera_controls.hpp"
#include "formats/dataset/dataset.hpp"
#include "runtime/debug_views/debug_view_renderer.hpp"
#include "viewer/animation.hpp"
#include "viewer/comparison.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/files/file_list.hpp"
#include "viewer/files/settings.hpp"
#include "viewer/frame_clock.hpp"
#include "viewer/messages.hpp"
#include "viewer/stage.hpp"
#include "viewer/worker.hpp"

namespace tureen::viewer {

/// A scene, photographs or a camera path: told by what it holds.
struct OpenPath {
  std::filesystem::path path;
};
struct OpenPhotographs {
  std::filesystem::path path;
};
struct CloseDataset {};
struct ReloadScene {};
/// Draw the scene by this choice.
struct ChooseDrawing {
  DrawingChoice choice;
};
/// Look through the recorded camera of this index.
struct ShowRecorded {
  int index = 0;
};
struct TakeImage {
  glm::ivec2 size{0};  // (0, 0): the window's
  bool transparent = false;
};
/// The command that draws this image without a window goes to the clipboard.
struct CopyCommand {};
struct ToggleFullscreen {};
struct AddKeyframe {};
struct ShowKeyframe {
  std::size_t index = 0;
};
struct MakeTurntable {};
struct SavePath {
  std::filesystem::path file;
};
struct LoadPath {
  std::filesystem::path file;
};
struct WriteAnimation {};
/// Of images and animations.
struct StopWriting {};
struct Quit {};

using Request =
    std::variant<OpenPath, OpenPhotographs, CloseDataset, ReloadScene, ChooseDrawing, ShowRecorded,
                 TakeImage, CopyCommand, ToggleFullscreen, AddKeyframe, ShowKeyframe, MakeTurntable,
                 SavePath, LoadPath, WriteAnimation, StopWriting, Quit>;

/// The photographs at hand; those to train on first.
struct Photographs {
  std::filesystem::path path;
  std::vector<Photograph> list;
  std::size_t train_count = 0;
  std::vector<std::string> notes;
};

/// The image-taking panel's fields.
struct ImageWish {
  bool window_size = true;
  glm::ivec2 size{3840, 2160};
  bool transparent = false;
};

struct State {
  Settings settings;
  std::unique_ptr<Stage> stage;  // nothing before the first scene
  DrawingChoice wanted;          // what the stage is, or is being prepared to be, drawn by
  DebugViewChoice debug_view;
  std::unique_ptr<DebugViewRenderer> debug_renderer;  // of the stage, once something was looked at
  std::optional<Photographs> photographs;
  CameraControls controls;
  int recorded = -1;  // the recorded camera that was last gone to
  Comparison comparison;
  Animation animation;
  Messages messages;
  ImageWish image;
  bool show_interface = true;
  bool show_keys = false;
  FileList files;
  bool show_files = false;  // the window to pick a file in
  bool draw_continuously = false;
  std::optional<Worker::Status> busy, writing;
  /// Of the image, which leaves room for the panels at its right.
  glm::ivec2 points{1, 1}, pixels{1, 1};
  double now = 0;  // seconds of the window's clock

  /// Those of the photographs, or else of the scene.
  std::vector<const Camera*> recorded_cameras() const;
  /// The view as a keyframe of the animation.
  CameraKeyframe keyframe_of_now(double seconds) const;
  /// The photograph whose camera the view is, unmoved.
  const Photograph* photograph() const;

  template <class Wish>
  void ask(Wish wish) {
    requests.emplace_back(std::move(wish));
  }
  std::deque<Request> requests;
};

}  // namespace tureen::viewer
