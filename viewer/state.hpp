// The state of the window, and its requests. Panels read the state, change settings directly, and
// add requests for everything else. viewer/application carries out the requests between frames.
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
#include "runtime/debug_views/debug_view.hpp"
#include "scene/similarity.hpp"
#include "viewer/animation.hpp"
#include "viewer/comparison.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/files/file_list.hpp"
#include "viewer/files/followed_training.hpp"
#include "viewer/files/settings.hpp"
#include "viewer/frame_clock.hpp"
#include "viewer/messages.hpp"
#include "viewer/scene/gizmo.hpp"
#include "viewer/scene/stage.hpp"
#include "viewer/training_command.hpp"
#include "viewer/worker.hpp"

namespace tureen::viewer {

/// Opens a scene, photographs or a camera path, detected from its name and contents.
struct OpenPath {
  std::filesystem::path path;
  bool discards = false;  // unsaved changes, without a question
};
/// The same for several paths, except that scenes are added as layers to the scene that is shown or
/// loading. Without one, they become its layers.
struct AddPaths {
  std::vector<std::filesystem::path> paths;
};
/// Changes the document. `gesture`: as History::perform().
struct Perform {
  Edit edit;
  std::uint64_t gesture = 0;
};
struct Undo {};
struct Redo {};
/// Undoes or redoes the steps of the document up to this position of its history.
struct GoToStep {
  std::size_t position = 0;
};
/// Leaves the scene: for another one, or by closing the window if the path is empty.
struct Leave {
  std::filesystem::path opens;
};
/// Saves the scene. Asks before a format loses something.
struct SaveScene {
  std::filesystem::path file = {};  // empty: the scene's own; asks if it has none
  bool accepts_losses = false;
  std::optional<Leave> then = {};  // after it was saved
};
/// Asks for the name of the file.
struct SaveSceneAs {};
struct OpenPhotographs {
  std::filesystem::path path;
  bool trains = false;  // then opens the dialog that starts a training
};
/// Writes a dataset with the cameras of photographs, or of a video, and opens it.
struct FindCameras {
  std::filesystem::path photographs, dataset;
};
struct CloseDataset {};
struct ReloadScene {};
/// Reads this level of detail of a file (SceneSource::files).
struct ChooseLevel {
  std::size_t file = 0, level = 0;
};
/// Draws the scene with these options.
struct ChooseDrawing {
  DrawingChoice choice;
};
/// Moves the view to the recorded camera with this index.
struct ShowRecorded {
  int index = 0;
};
/// Makes the visible point at this place the target, and centres it.
struct FocusAt {
  glm::dvec2 place;  // in points from the upper left corner
};
struct TakeImage {
  glm::ivec2 size{0};  // (0, 0): the window's
  bool transparent = false;
};
/// Writes the scene as a web page, where images are saved.
struct SavePage {};
/// Copies the command that draws this image without a window to the clipboard.
struct CopyCommand {};
struct ToggleFullscreen {};
struct AddKeyframe {};
struct ShowKeyframe {
  std::size_t index = 0;
};
struct MakeTurntable {};
/// Replaces the path by a flight along the recorded cameras.
struct FlyAlongCameras {};
struct SavePath {
  std::filesystem::path file;
};
struct LoadPath {
  std::filesystem::path file;
};
struct WriteAnimation {};
/// Tells the training run to pause, continue or finish.
struct TellTraining {
  trainer::RunCommand command = trainer::RunCommand::run;
};
/// Cancels the running job of this kind and those that wait.
struct CancelJob {
  JobKind kind = JobKind::scene;
};
/// Starts a program that trains a scene from the photographs.
struct StartTraining {
  std::filesystem::path scene;  // the file to write
  TrainingStart start = TrainingStart::new_run;
  TrainingChoice choice = {};
};
/// Ends this program. Its checkpoint stays.
struct StopTraining {};
/// Opens the dialog that trains a scene from the photographs, and measures the speed of training on
/// this computer for its forecasts.
struct OfferTraining {
  bool is_for_photographs = false;  // with the options of `tureen train PHOTOS`
};
/// Copies the command that trains a scene from the photographs to the clipboard; that of the
/// training in progress if it has these photographs.
struct CopyTrainingCommand {};
/// Stops writing images and animations.
struct StopWriting {};
/// Closes the window.
struct Quit {
  /// Fate of a training that this window has started.
  enum class Training { ask, stop, let_continue };
  Training training = Training::ask;
  bool discards = false;  // unsaved changes, without a question
};

using Request =
    std::variant<OpenPath, AddPaths, Perform, Undo, Redo, GoToStep, SaveScene, SaveSceneAs,
                 OpenPhotographs, FindCameras, CloseDataset, ReloadScene, ChooseLevel,
                 ChooseDrawing, ShowRecorded, FocusAt, TakeImage, SavePage, CopyCommand,
                 ToggleFullscreen, AddKeyframe, ShowKeyframe, MakeTurntable, FlyAlongCameras,
                 SavePath, LoadPath, WriteAnimation, TellTraining, CancelJob, StartTraining,
                 StopTraining, OfferTraining, CopyTrainingCommand, StopWriting, Quit>;

/// The photographs of the dataset, training ones first.
struct Photographs {
  std::filesystem::path path;
  std::vector<Photograph> list;
  std::size_t train_count = 0;
  std::vector<std::string> notes;
  FullPhotographs full;        // of the training ones
  bool stay_is_noted = false;  // whether the message was shown
};

/// A training that this window has started.
struct StartedTraining {
  std::filesystem::path dataset, scene;
  TrainingStart start = TrainingStart::new_run;
  TrainingChoice choice = {};
  /// Of the scene at the start, and of the checkpoint when it was stopped; nullopt: no such file.
  FileTime scene_before = {}, checkpoint_before = {};
  bool is_stopped = false;  // it is about to end
};

/// The fields of the panel *Layers*.
struct LayerEditing {
  LayerId selected = 0;
  /// The numbers of the selected layer, and their matrix. They are kept while the matrix is the
  /// layer's, because other numbers may have the same matrix.
  Similarity numbers;
  glm::dmat4 matrix{1.0};
};

/// The gizmo over the selected layer.
struct GizmoState {
  GizmoTool tool = GizmoTool::off;
  GizmoAxes axes = GizmoAxes::world;
  std::optional<GizmoDrag> drag = {};
  bool is_hovered = false;  // in the last frame
};

/// The dialog about photographs without cameras.
struct CameraSearch {
  std::filesystem::path photographs;
  std::string dataset;  // to write, as typed
};

/// The dialogs about saving; each is open if it has a value.
struct SavingDialogs {
  struct Name {
    std::filesystem::path folder;
    std::string typed;  // relative to the folder
    std::optional<Leave> then;
  };
  struct Losses {
    SaveScene request;
    std::vector<std::string> lost;
  };
  std::optional<Name> name;      // of the file
  std::optional<Losses> losses;  // of its format
  std::optional<Leave> leaving;  // with unsaved changes
};

/// The fields of the panel *Images*.
struct ImageWish {
  bool window_size = true;
  bool other_size = false;  // numbers instead of a size of the list
  glm::ivec2 size{3840, 2160};
  bool transparent = false;
};

/// The ray-traced image (application_tracing.cpp).
struct TracedView {
  ImageTexture texture;  // with the size of the image; empty: none is drawn yet
  double sharp = 0;      // the part of the pixels that have their own ray, 0..1
  int samples = 0;       // complete ones per pixel
  int wanted = 1;
  bool is_running = false, is_complete = false;
};

/// Whether the user can cancel jobs of this kind. The others end soon.
constexpr bool can_be_cancelled(JobKind kind) {
  return kind == JobKind::scene || kind == JobKind::dataset || kind == JobKind::drawing ||
         kind == JobKind::cameras;
}

/// A shorter job shows no progress.
inline constexpr double progress_delay_seconds = 0.5;

/// The parts of the panel; one is shown.
enum class PanelTab { scene, drawing, camera };

struct State {
  Settings settings;
  Theme theme = Theme::dark;            // that of this frame; the settings' from the next one on
  std::filesystem::path images_option;  // folder of --images, before the settings'; empty: none
  SceneSource source;                   // the scene; without files before the first one
  History history;                      // of source.document
  std::unique_ptr<Stage> stage;         // its document on the device; null before the first scene
  DrawingChoice wanted;                 // options of the stage in preparation, otherwise of `stage`
  DebugViewChoice debug_view;
  std::optional<Photographs> photographs;
  std::optional<FollowedTraining> training;
  std::optional<StartedTraining> started;  // while it is in progress
  CameraControls controls;
  int recorded = -1;  // the last selected recorded camera; -1: none
  Comparison comparison;
  bool trace = false;  // the user wants the ray-traced image
  TracedView traced;
  Animation animation;
  Messages messages;
  LayerEditing layer_editing;
  GizmoState gizmo;
  std::uint64_t gesture = 1;  // of controls that are held: a drag, or typing in a field
  SavingDialogs saving;
  ImageWish image;
  bool show_interface = true;
  PanelTab tab = PanelTab::scene;
  bool shows_checks = false;    // instead of the background
  std::string background_text;  // in its field; what is typed until the field loses the keys
  bool show_keys = false;
  FileList files;
  bool adds_files = false;  // they become layers of the scene
  bool show_files = false;  // the window that opens files
  std::optional<CameraSearch> camera_search;
  std::optional<std::string> scene_to_train;  // text of the dialog that starts a training
  TrainingChoice training_choice;             // of that dialog
  std::optional<double> training_seconds;     // measured_seconds_per_pixel()
  bool measures_training = false;             // training_seconds will come
  bool asks_before_quitting = false;          // the dialog about a training in progress
  bool draw_continuously = false;
  std::optional<Worker::Status> busy, writing, searching;  // of the workers
  /// Size of the image (the window without the panels at its right), in points and in framebuffer
  /// pixels.
  glm::ivec2 points{1, 1}, pixels{1, 1};
  double now = 0;  // seconds of the window's clock

  /// Absolute folder for images.
  std::filesystem::path folder_of_images() const;
  /// Whether a dialog is open, which takes the keys.
  bool has_dialog() const {
    return camera_search || scene_to_train || asks_before_quitting || saving.name ||
           saving.losses || saving.leaving;
  }
  /// The layer that the panel *Layers* has selected, or the first.
  const DocumentLayer& selected_layer() const;
  /// The scene without the layers that the device refused.
  SceneSource drawn_source() const;
  /// The cameras of the photographs if there are any, otherwise of the scene.
  std::vector<const Camera*> recorded_cameras() const;
  /// The current view as a keyframe; `seconds` is its time in the path.
  CameraKeyframe keyframe_of_now(double seconds) const;
  /// The photograph of the selected camera, if the view has not moved; otherwise null.
  const Photograph* photograph() const;

  void note(const std::string& text) { messages.note(text, now); }
  void error(const std::string& title, const std::string& reason,
             Message::About about = Message::About::other) {
    messages.error(title, reason, now, about);
  }

  template <class Wish>
  void ask(Wish wish) {
    requests.emplace_back(std::move(wish));
  }
  /// Changes the document. `continues`: while the user holds a control, all is one step.
  void edit(Edit edit, bool continues = false) {
    ask(Perform{std::move(edit), continues ? gesture : 0});
  }
  std::deque<Request> requests;
};

}  // namespace tureen::viewer
