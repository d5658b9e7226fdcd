// The main loop: reads events, changes the state, carries out requests and draws a frame. It sleeps
// while nothing moves.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/steady_seconds.hpp"
#include "tracing/progressive_image.hpp"
#include "viewer/background_program.hpp"
#include "viewer/files/file_watch.hpp"
#include "viewer/files/session.hpp"
#include "viewer/frame_clock.hpp"
#include "viewer/gui/checks.hpp"
#include "viewer/gui/gui.hpp"
#include "viewer/gui/window.hpp"
#include "viewer/input/double_click.hpp"
#include "viewer/input/navigation_input.hpp"
#include "viewer/state.hpp"
#include "viewer/worker.hpp"

namespace tureen::viewer {

struct ApplicationOptions {
  std::vector<std::filesystem::path> scenes;  // several are combined, each as a layer
  std::filesystem::path dataset;              // empty: none
  std::filesystem::path training;             // log of a run to follow; empty: none
  DrawingChoice drawing = {};
  bool smooth_at_rest = true;                    // false: switches off Settings::smooth_at_rest
  bool trace = false;                            // State::trace at the start
  std::optional<std::uint64_t> max_splats = {};  // ReadOptions::max_splats of every file
  std::optional<std::size_t> lod = {};           // ReadOptions::lod of every file that is opened
  gl::Api api = gl::Api::desktop;
  std::optional<glm::ivec2> window = {};          // in points; default: of the last run
  std::optional<std::filesystem::path> settings;  // file; nullopt: not stored
  std::optional<Session> replay;                  // replaces the user's events
  std::filesystem::path record;                   // file for the session; empty: none
  std::function<bool()> interrupted = {};  // called before each frame; true closes the window
  std::filesystem::path images;            // folder for images; empty: that of the settings
};

/// Measurements of a run.
struct RunReport {
  /// From the construction of Application to the first image of a scene; -1: no image.
  double first_image_seconds = -1;
  /// Longest time of a frame on the main thread while a scene loads, without the drawing.
  double longest_busy_ms = 0;
  /// Frames of the scene in colours, with those of the image at rest.
  int drawn = 0;
};

class Application {
 public:
  /// Opens the window. Throws ContextError.
  explicit Application(ApplicationOptions options);
  ~Application();

  /// Runs until the window is closed or the session ends, then writes the session and the settings.
  /// Throws OutputError if they cannot be written. If the device is lost, also writes both files if
  /// possible, then throws ContextError.
  void run();

  const RunReport& report() const { return report_; }
  /// The error messages shown at the end of a session.
  std::vector<std::string> errors() const;

 private:
  // -- a frame
  void frame();
  std::vector<Event> gather();
  bool waits_for_control() const;
  std::vector<Event> gather_live();
  void update_gui();
  void lay_out(glm::ivec2 points, glm::ivec2 pixels);
  void dispatch(const std::vector<Event>& events);
  void handle(const Event& event);
  void move(double seconds);
  void draw(const std::vector<Event>& events, double busy_seconds);
  void draw_image();
  void draw_scene();
  bool at_rest() const;
  bool stands_still() const;
  bool smooths() const;
  bool refines() const;
  double wait_seconds() const;
  double clock() const;
  double seconds_since_start() const { return steady_seconds() - start_; }

  // -- the end
  void keep_session();
  void keep_settings();

  // -- requests (application_requests.cpp, application_loading.cpp, application_images.cpp,
  // application_debug_views.cpp)
  void carry_out();
  void carry_out(const OpenPath& request);
  void carry_out(const AddPaths& request);
  void carry_out(const Perform& request);
  void carry_out(const Undo& request);
  void carry_out(const Redo& request);
  void carry_out(const GoToStep& request);
  void carry_out(const SaveScene& request);
  void carry_out(const SaveSceneAs& request);
  void carry_out(const OpenPhotographs& request);
  void carry_out(const CloseDataset& request);
  void carry_out(const ReloadScene& request);
  void carry_out(const ChooseLevel& request);
  void carry_out(const ChooseDrawing& request);
  void carry_out(const ShowRecorded& request);
  void carry_out(const FocusAt& request);
  void carry_out(const TakeImage& request);
  void carry_out(const SavePage& request);
  void carry_out(const CopyCommand& request);
  void carry_out(const ToggleFullscreen& request);
  void carry_out(const AddKeyframe& request);
  void carry_out(const ShowKeyframe& request);
  void carry_out(const MakeTurntable& request);
  void carry_out(const FlyAlongCameras& request);
  void carry_out(const SavePath& request);
  void carry_out(const LoadPath& request);
  void carry_out(const WriteAnimation& request);
  void carry_out(const TellTraining& request);
  void carry_out(const CancelJob& request);
  void carry_out(const FindCameras& request);
  void carry_out(const OfferTraining& request);
  void carry_out(const StartTraining& request);
  void carry_out(const StopTraining& request);
  void carry_out(const CopyTrainingCommand& request);
  void carry_out(const StopWriting& request);
  void carry_out(const Quit& request);
  /// The relation of a loaded scene to the one that is shown.
  enum class Relation {
    other,    // replaces it
    changed,  // the same files, read again, or prepared in another way
    grown,    // the same with further files
  };
  /// Scenes that the worker reads. With Relation::other, `paths` has all files. Otherwise
  /// it has only the files that the shown scene does not have.
  struct Loading {
    Relation relation = Relation::other;
    std::vector<std::filesystem::path> paths;
    std::optional<ChooseLevel> level = {};  // with Relation::changed
  };
  /// The progress and the errors of a Loading; each has its own.
  struct Reading {
    std::filesystem::path current;
    struct Failure {
      std::filesystem::path path;
      std::string reason;
    };
    std::vector<Failure> failures;  // of files that are not shown
  };
  void load(const Loading& loading);
  void reload(std::optional<ChooseLevel> level = {});
  Worker::Completion load_in_background(const Loading& loading,
                                        const std::shared_ptr<SceneSource>& before,
                                        const StageRequest& request,
                                        const std::shared_ptr<Reading>& files);
  /// A part of a large file that is shown while all of it is read.
  struct Preview {
    std::shared_ptr<const Reading> reading;
    int opened = 0;
  };
  void post_previews(const std::filesystem::path& path, const StageRequest& request,
                     const std::shared_ptr<const Reading>& reading);
  bool shows_preview() const;
  bool shows_preview_of(const Reading& reading) const;
  void show_read(SceneSource source, Stage stage, Relation relation, const Reading& reading);
  void end_loading(const Reading& files, Relation relation);
  void add(const SceneSource& more, const SceneSource& known);
  void show_opened(SceneSource source, Stage stage);
  void show_again(SceneSource read, Stage stage);
  void show_notes();

  // -- the document (application_document.cpp, application_saving.cpp)
  /// After a change: the device, the view, the drawing options and the title follow.
  void follow_document();
  /// The up axis that the user has given the view is the document's.
  void follow_up_axis();
  void sync_stage();
  /// Prepares the document in the background with the wanted options, and shows it.
  void prepare(JobKind kind, bool for_debug_views,
               const std::function<void(const std::string&)>& failed);
  void show(Stage stage);
  DrawingChoice choice_of_document() const;
  /// After drawing options were refused: the document has those that are drawn.
  void keep_drawn_options();
  void show_files_of_scene();
  void show_title();
  void report_refused(const std::vector<RefusedLayer>& layers);
  /// Whether unsaved changes would be lost; then asks the user.
  bool asks_before(const Leave& leave);
  /// Opens the dataset of these photographs, or of this video; without one, asks for its name.
  void ask_about_photographs(const std::filesystem::path& path);
  void measure_training();
  void ask_for_name(const std::optional<Leave>& then);
  std::filesystem::path own_file() const;
  void compare_when_needed();
  void prepare_debug_view_when_needed();
  void watch_files();
  void watch_training_program();

  // -- rays (application_tracing.cpp)
  struct Rays;
  /// Whether the image by rays is, or may become, the visible one.
  bool traces() const;
  int traced_samples() const;
  /// Begins the image by rays of this camera, or continues it. `camera` and document have not
  /// changed since forget_traced().
  void trace(const Camera& camera);
  /// Abandons the image by rays: something has changed.
  void forget_traced();

  /// Writes the file in the background. `remark`: for the message after its path.
  void write(const std::filesystem::path& path, std::function<void(const StageRequest&)> work,
             const std::string& remark = "");
  bool has_scene();
  std::filesystem::path image_path(const std::string& extension);
  void save_window_image(const std::string& name);

  double start_ = steady_seconds();
  RunReport report_;
  ApplicationOptions options_;
  std::optional<Replay> replay_;
  Window window_;
  State state_;  // its GL objects are destroyed before the window
  std::unique_ptr<Gui> gui_;
  double gui_scale_ = 1, gui_density_ = 1;
  Checks checks_;
  FrameClock frame_clock_;
  NavigationInput navigation_;
  DoubleClick double_click_;
  std::optional<Session> recorded_;
  std::vector<std::filesystem::path> promised_;     // paths of images that are being written
  std::vector<Event> pending_, clicks_;             // of a session's click, a frame for each
  std::vector<FileWatch> watches_;                  // of the scene's files
  std::vector<std::filesystem::path> shown_paths_;  // of show_files_of_scene()
  std::optional<Loading> loading_;
  std::optional<Preview> preview_;  // the last one
  std::optional<BackgroundProgram> training_program_;
  double watched_ = 0, last_ = 0;
  double searched_ = 0;  // when the progress of searcher_ was shown
  int frames_wanted_ = 2;
  int opened_ = 0;                          // how many scenes were opened
  int shown_ = 0;                           // how many stages were shown
  std::vector<LayerId> uploading_;          // layers that a worker uploads
  std::optional<Quality> refused_quality_;  // the device lacks the memory for its samples
  bool image_is_current_ = false;
  /// Whether a worker prepares the scene for debug views (true) or for colours (false).
  std::optional<bool> preparing_debug_views_;
  /// Whether a worker prepares the scene again with the options state_.wanted.
  bool preparing_drawing_ = false;
  Camera drawn_camera_;
  glm::vec4 drawn_background_{0.0f};
  bool drawn_smooth_ = false;  // whether the image may have become the image at rest
  DebugViewChoice drawn_debug_view_;
  bool quit_ = false, vsync_ = false;
  std::optional<Quit> quit_when_written_;  // the user wants to close the window, at this time
  double quit_asked_ = 0;
  std::shared_ptr<Rays> rays_;  // kept while State::trace
  std::shared_ptr<tracing::ProgressiveImage> traced_image_;
  Worker worker_, writer_, tracer_, searcher_;  // last: their jobs may use all of the above
};

}  // namespace tureen::viewer
