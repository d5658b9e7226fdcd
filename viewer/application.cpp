#include "viewer/application.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "base/error.hpp"
#include "base/output.hpp"
#include "image/png.hpp"
#include "runtime/gl/api.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"
#include "viewer/gui/colors.hpp"
#include "viewer/gui/item_places.hpp"
#include "viewer/input/take_frame.hpp"
#include "viewer/panels.hpp"
#include "viewer/shortcuts.hpp"

namespace tureen::viewer {

namespace {

/// Dear ImGui reacts to an event in the next frame, and self-sizing windows need one more.
constexpr int frames_after_event = 3;

/// The time constant of smooth motion, in seconds: the default of CameraControls.
const double gliding_seconds = CameraControls().smoothing();

/// Relative change of the screen's scale from which the interface is recreated, with new fonts and
/// closed panels. Rounding while the window is resized changes the scale by less.
constexpr double min_rescaling = 0.05;

/// Wait without events, in seconds. Then the window only checks files for changes.
constexpr double idle_seconds = 0.5;

/// Largest time step of a frame, in seconds, after a pause (idle window, sleeping machine).
constexpr double longest_step = 0.1;

WindowOptions window_options(const ApplicationOptions& options, const Settings& settings) {
  WindowOptions result{.api = options.api, .size = settings.window};
  if (options.replay) result.size = options.replay->window;
  if (options.window) result.size = *options.window;
  return result;
}

Settings settings_of(const ApplicationOptions& options) {
  return options.settings ? read_settings(*options.settings) : Settings{};
}

/// Framebuffer pixels in a point, at least 1.
double density(const Window& window) {
  if (window.pixels().x < 1 || window.size().x < 1) return 1;  // minimised
  return std::max(double(window.pixels().x) / window.size().x, 1.0);
}

/// An event for a frame of its own: Dear ImGui finds out between them what is under the pointer.
std::vector<Event> take_first(std::vector<Event>& events) {
  std::vector<Event> first{std::move(events.front())};
  events.erase(events.begin());
  return first;
}

/// If a click is next, takes it and returns what a pointer does. Throws UsageError if no control in
/// sight has the name.
std::vector<Event> take_click(std::vector<Event>& pending) {
  const auto* const click = pending.empty() ? nullptr : std::get_if<ControlClicked>(&pending[0]);
  if (!click) return {};
  const std::optional<glm::dvec2> place = item_place(click->name);
  if (!place)
    throw UsageError("the session clicks \"" + click->name + "\", and no such control is in sight",
                     "add an \"await\" before it, open its tab and its section, or scroll to it");
  const auto [x, y] = click->by;
  std::vector<Event> result{PointerMoved{place->x, place->y}, ButtonChanged{Button::left, true}};
  for (const double part : {0.25, 0.5, 0.75, 1.0})
    if (x != 0 || y != 0)
      result.emplace_back(PointerMoved{place->x + part * x, place->y + part * y});
  result.emplace_back(ButtonChanged{Button::left, false});
  pending.erase(pending.begin());
  return result;
}

With held_with(const NavigationInput& input) {
  if (!input.held(Key::control) && !input.held(Key::super)) return With::nothing;
  return input.held(Key::shift) ? With::control_shift : With::control;
}

/// Throws OutputError with both paths.
void replace_file(const FileReplaced& files) {
  std::error_code failed;
  std::filesystem::copy_file(files.from, files.to,
                             std::filesystem::copy_options::overwrite_existing, failed);
  if (failed)
    throw OutputError({files.to, {}, {}},
                      "cannot be replaced by " + files.from + ": " + failed.message());
}

}  // namespace

Application::Application(ApplicationOptions options)
    : options_(std::move(options)),
      window_(window_options(options_, settings_of(options_))),
      frame_clock_(window_.context(), [this] { return clock(); }),
      worker_(window_, 0),
      writer_(window_, 1),
      tracer_(window_, std::nullopt),
      searcher_(window_, std::nullopt) {
  if (options_.replay) replay_.emplace(*options_.replay);
  state_.settings = settings_of(options_);
  state_.images_option = options_.images;
  if (!options_.smooth_at_rest) state_.settings.smooth_at_rest = false;
  state_.trace = options_.trace;
  if (!options_.record.empty()) recorded_ = Session{.window = window_.size(), .events = {}};
  // A replay does not wait for the screen.
  vsync_ = state_.settings.vsync && !replay_;
  window_.set_vsync(vsync_);
  if (options_.scenes.size() == 1) state_.ask(OpenPath{options_.scenes.front()});
  if (options_.scenes.size() > 1) state_.ask(AddPaths{options_.scenes});
  if (!options_.training.empty()) state_.training.emplace(options_.training).update();
  if (!options_.dataset.empty()) state_.ask(OpenPhotographs{options_.dataset});
}

Application::~Application() = default;

double Application::clock() const { return replay_ ? replay_->now() : seconds_since_start(); }

void Application::run() {
  try {
    while (!quit_ && !(options_.interrupted && options_.interrupted())) frame();
  } catch (...) {
    // Most likely a lost device. Further write errors add nothing to its message.
    for (const auto keep : {&Application::keep_session, &Application::keep_settings}) {
      try {
        (this->*keep)();
      } catch (const std::exception&) {
      }
    }
    throw;
  }
  keep_session();
  keep_settings();
}

void Application::keep_session() {
  if (recorded_) write_file(options_.record, session_to_json(*recorded_));
}

void Application::keep_settings() {
  if (!options_.settings) return;
  if (!window_.fullscreen()) state_.settings.window = window_.size();
  Settings kept = state_.settings;
  // The option holds for one run only.
  if (!options_.smooth_at_rest && !kept.smooth_at_rest)
    kept.smooth_at_rest = settings_of(options_).smooth_at_rest;
  write_settings(kept, *options_.settings);
}

std::vector<std::string> Application::errors() const {
  std::vector<std::string> result;
  for (const Message& message : state_.messages.list())
    if (message.kind == Message::Kind::error) result.push_back(message.title + ": " + message.text);
  return result;
}

bool Application::at_rest() const {
  return worker_.idle() && writer_.idle() && tracer_.idle() && searcher_.idle() &&
         !state_.animation.plays && pending_.empty() && clicks_.empty() &&
         state_.requests.empty() && frames_wanted_ <= 0 && !state_.controls.moving();
}

bool Application::stands_still() const {
  const bool trains = state_.training && state_.training->command();
  return !state_.draw_continuously && !state_.animation.plays && !state_.controls.moving() &&
         !navigation_.flying() && !trains;
}

/// Whether the image is, or may become, the image at rest: the user wants it, and nothing moves.
bool Application::smooths() const { return state_.settings.smooth_at_rest && stands_still(); }

/// Whether the next frame belongs to the image at rest. None does during a job: on few cores, it
/// would slow down the job.
bool Application::refines() const {
  return smooths() && !traces() && worker_.idle() && writer_.idle() &&
         state_.stage->renderer.can_refine();
}

double Application::wait_seconds() const {
  const bool busy = frames_wanted_ > 0 || state_.controls.moving() || navigation_.flying() ||
                    state_.draw_continuously || state_.animation.plays || !pending_.empty() ||
                    !state_.requests.empty();
  return busy ? 0 : idle_seconds;
}

std::vector<Event> Application::gather_live() {
  std::vector<Event> events = window_.events(wait_seconds());
  pending_.insert(pending_.end(), events.begin(), events.end());
  return take_frame(pending_);
}

/// Whether a session clicks a control that may come with the work in progress, such as its
/// *Cancel*.
bool Application::waits_for_control() const {
  const auto* const click = pending_.empty() ? nullptr : std::get_if<ControlClicked>(&pending_[0]);
  const bool works = !worker_.idle() || !writer_.idle() || !searcher_.idle();
  return click && works && !item_place(click->name);
}

std::vector<Event> Application::gather() {
  if (!replay_) return gather_live();
  for (const Event& event : window_.events(0))
    if (std::holds_alternative<CloseAsked>(event))
      quit_ = true;  // other events come from the session
  if (!clicks_.empty()) return take_first(clicks_);
  if (pending_.empty()) {
    if (replay_->finished()) quit_ = true;
    pending_ = replay_->next(at_rest());
  }
  if (waits_for_control()) {
    frames_wanted_ = std::max(frames_wanted_, 1);
    return {};
  }
  clicks_ = take_click(pending_);
  return clicks_.empty() ? take_frame(pending_) : take_first(clicks_);
}

void Application::frame() {
  const std::vector<Event> events = gather();
  const double began = seconds_since_start();
  const double now = clock();
  if (recorded_) recorded_->add(now, events);
  const double step = replay_ ? Replay::frame_seconds : std::min(now - last_, longest_step);
  last_ = state_.now = now;
  if (!events.empty()) frames_wanted_ = frames_after_event;

  const bool was_loading = state_.busy.has_value(), was_busy = was_loading || state_.writing;
  try {
    // Also after a job that began and ended between two frames: a new message needs more than one.
    for (Worker* worker : {&worker_, &writer_, &tracer_, &searcher_})
      if (worker->collect()) frames_wanted_ = std::max(frames_wanted_, frames_after_event);
  } catch (const std::exception& error) {
    state_.error("The operation failed", error.what());
    frames_wanted_ = std::max(frames_wanted_, frames_after_event);
  }
  state_.busy = worker_.status();
  state_.writing = writer_.status();
  if (quit_when_written_ && writer_.idle()) {
    // A dialog about what was written, or an error, needs the window.
    const bool failed = std::ranges::any_of(state_.messages.list(), [&](const Message& message) {
      return message.kind == Message::Kind::error && message.since >= quit_asked_;
    });
    if (!state_.has_dialog() && !failed) state_.ask(*quit_when_written_);
    quit_when_written_.reset();
  }
  const bool was_searching = state_.searching.has_value();
  state_.searching = searcher_.status();
  // It lasts for minutes: the window does not draw all frames meanwhile.
  if (was_searching != state_.searching.has_value() ||
      (was_searching && now - searched_ > idle_seconds)) {
    searched_ = now;
    frames_wanted_ = std::max(frames_wanted_, 1);
  }
  // A replay on a slower machine then waits until loading has finished there.
  if (recorded_ && was_loading && !state_.busy)
    recorded_->add(now, std::vector<Event>{AwaitRest{}});
  if (state_.busy || state_.writing || was_busy) frames_wanted_ = std::max(frames_wanted_, 1);
  watch_files();
  if (const bool wanted = state_.settings.vsync && !replay_; wanted != vsync_)
    window_.set_vsync(vsync_ = wanted);
  state_.messages.age(now);
  if (state_.messages.fading()) frames_wanted_ = std::max(frames_wanted_, 1);

  update_gui();
  const bool moves = state_.controls.moving() || navigation_.flying() || state_.animation.plays;
  if (frames_wanted_ <= 0 && !moves && !state_.draw_continuously && state_.requests.empty()) return;
  --frames_wanted_;

  const glm::ivec2 pixels = glm::max(window_.pixels(), 1), points = glm::max(window_.size(), 1);
  for (const Event& event : events) gui_->feed(event);
  gui_->begin({.points = points, .pixels = pixels, .seconds = step});
  lay_out(points, pixels);
  dispatch(events);
  move(step);
  follow_up_axis();
  carry_out();
  draw(events, seconds_since_start() - began);
}

/// Creates the interface anew if the screen's scale has changed.
void Application::update_gui() {
  const double dense = density(window_);
  // Points that are larger than pixels already include a part of the scale.
  const double scale = window_.content_scale() / dense;
  const auto differ = [](double a, double b) { return std::abs(a / b - 1) > min_rescaling; };
  if (!gui_ || differ(scale, gui_scale_) || differ(dense, gui_density_)) {
    gui_.reset();
    gui_ = std::make_unique<Gui>(
        window_, GuiOptions{.scale = scale,
                            .density = dense,
                            .font = replay_ ? FontChoice::fixed : FontChoice::machine});
    gui_scale_ = scale;
    gui_density_ = dense;
  }
  set_colors(state_.theme = state_.settings.theme);
}

void Application::lay_out(glm::ivec2 points, glm::ivec2 pixels) {
  points = glm::max(points, 1);
  pixels = glm::max(pixels, 1);
  state_.points = points;
  state_.points.x -= static_cast<int>(panels_width(state_, points.x));
  state_.pixels = glm::max(
      glm::ivec2(glm::round(glm::dvec2(state_.points) * glm::dvec2(pixels) / glm::dvec2(points))),
      1);
  state_.controls.set_viewport(state_.points.x, state_.points.y);
}

void Application::dispatch(const std::vector<Event>& events) {
  const NavigationInput::Taken taken{.pointer = gui_->takes_pointer(),
                                     .keys = gui_->takes_keys() || state_.has_dialog()};
  for (const Event& event : events) {
    navigation_.handle(event, taken, state_.controls);
    if (double_click_.handle(event, taken.pointer, state_.now))
      state_.ask(FocusAt{{double_click_.place().x, double_click_.place().y}});
    if (const auto* key = std::get_if<KeyChanged>(&event); key && key->down && !taken.keys)
      run_shortcut(key->key, held_with(navigation_), state_);
    // Not a key: its place differs between keyboards.
    if (const auto* typed = std::get_if<TextTyped>(&event);
        typed && typed->code_point == '?' && !taken.keys)
      run_shortcut(Key::f1, With::nothing, state_);
    handle(event);
  }
}

void Application::handle(const Event& event) {
  if (std::holds_alternative<CloseAsked>(event)) state_.ask(Quit{});
  if (const auto* dropped = std::get_if<FilesDropped>(&event))
    state_.ask(
        AddPaths{std::vector<std::filesystem::path>(dropped->paths.begin(), dropped->paths.end())});
  if (const auto* size = std::get_if<Resized>(&event); size && replay_)
    window_.resize({size->width, size->height});
  if (const auto* replaced = std::get_if<FileReplaced>(&event)) replace_file(*replaced);
}

void Application::move(double seconds) {
  state_.controls.set_smoothing(state_.settings.smooth_motion ? gliding_seconds : 0.0);
  const Flight flight = navigation_.flight();
  if (state_.controls.moving() || navigation_.flying())
    frames_wanted_ = std::max(frames_wanted_, 1);
  state_.controls.advance(seconds, flight);
  Animation& animation = state_.animation;
  if (navigation_.flying() || navigation_.dragging()) animation.plays = false;
  if (animation.path.empty()) animation.plays = animation.scrubbed = false;
  if (!animation.plays && !animation.scrubbed) return;
  animation.advance(seconds);
  animation.scrubbed = false;  // the panel sets it again while the slider is held
  state_.controls.adopt(animation.camera(state_.pixels));
  state_.controls.arrive();
}

void Application::draw(const std::vector<Event>& events, double busy_seconds) {
  prepare_debug_view_when_needed();
  draw_image();
  compare_when_needed();
  const double began = seconds_since_start();
  draw_panels(state_, frame_clock_);
  draw_overlays(state_);
  busy_seconds += seconds_since_start() - began;
  if (state_.busy) report_.longest_busy_ms = std::max(report_.longest_busy_ms, 1e3 * busy_seconds);
  gui_->draw();
  window_.set_pointer(gui_->pointer());
  for (const Event& event : events)
    if (const auto* image = std::get_if<WindowScreenshot>(&event)) save_window_image(image->name);
  window_.present();
  if (state_.stage && report_.first_image_seconds < 0)
    report_.first_image_seconds = seconds_since_start();
}

void Application::draw_image() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  gl::use_plain_rasterisation(1, 1);  // clearing depends on masks and scissor, not on the viewport
  const ImVec4 empty = color_of(palette(state_.theme).page);
  glClearBufferfv(GL_COLOR, 0, &empty.x);
  if (!state_.stage) return;
  try {
    draw_scene();
  } catch (const DeviceLimitError& error) {
    // Most likely the window is too large for this number of samples per pixel.
    state_.error("The image cannot be drawn", error.reason());
    image_is_current_ = false;
    const DrawingChoice& choice = state_.stage->choice;
    if (quality_of(choice, *state_.source.scene).supersampling == 1 || !worker_.idle()) return;
    refused_quality_ = state_.source.document.quality;
    state_.ask(ChooseDrawing{choice_of_document()});
  }
}

void Application::draw_scene() {
  Stage& stage = *state_.stage;
  const Camera camera = state_.controls.camera(state_.pixels.x, state_.pixels.y);
  // Colours until the debug view is prepared.
  const DebugViewChoice debug_view = stage.debug_views ? state_.debug_view : DebugViewChoice{};
  const bool may_smooth = smooths();
  const glm::vec4 background(background_of(state_.source), state_.shows_checks ? 0.0f : 1.0f);
  if (std::exchange(drawn_background_, background) != background || !image_is_current_) {
    stage.renderer.set_background(background);
    image_is_current_ = false;
  }
  // Without smoothing, the image at rest gives way to the frame.
  const bool same = image_is_current_ && drawn_debug_view_ == debug_view &&
                    camera == drawn_camera_ && (may_smooth || !drawn_smooth_);
  if (stage.debug_views) {
    drawn_smooth_ = false;
    // Their frame times would not be those of ordinary frames.
    if (!same) {
      stage.debug_views->show(stage.renderer, debug_view.what, debug_view.features);
      stage.renderer.draw({camera});
    }
  } else if (!same || state_.draw_continuously) {
    frame_clock_.draw(stage.renderer, {camera});
    ++report_.drawn;
    drawn_smooth_ = false;
  } else if (refines()) {
    frame_clock_.refine(stage.renderer);
    ++report_.drawn;
    drawn_smooth_ = true;
  }
  drawn_debug_view_ = debug_view;
  drawn_camera_ = camera;
  image_is_current_ = stage.renderer.splats_in_order();
  if (same)
    trace(camera);
  else
    forget_traced();
  if (!image_is_current_ || refines() || (traces() && !same))
    frames_wanted_ = std::max(frames_wanted_, 1);
  stage.renderer.blit_to(0);
  constexpr double check_points = 8;
  if (state_.shows_checks)
    checks_.draw(window_.context().capabilities().api, state_.pixels, check_points * gui_density_);
}

void Application::save_window_image(const std::string& name) {
  // The back buffer, before it is presented.
  glFinish();
  const glm::ivec2 size = window_.pixels();
  const Image8 image = read_pixels(0, size.x, size.y);
  const std::filesystem::path folder = state_.folder_of_images();
  make_folder(folder);
  write_file(folder / name, encode_png(image));
}

}  // namespace tureen::viewer
