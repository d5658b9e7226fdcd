// The page's commands to its PageView.
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "camera/capture.hpp"
#include "camera/recorded_path.hpp"
#include "camera/view_state.hpp"
#include "formats/scene_file.hpp"
#include "runtime/plan/plan_description.hpp"
#include "scene/edit/edits.hpp"
#include "web/engine/page_options.hpp"
#include "web/engine/scene_path.hpp"
#include "web/engine/unpacking.hpp"

namespace tureen::web {

namespace {

CameraControls& controls(Engine& engine) { return engine.page().controls(); }

/// {"blend": of splats: "auto", "raster" or "tiles"}. "limits" is for the loader's commands. Again
/// after "lose_device", when the canvas has a new context.
Json start(Engine& engine, const Json& options) {
  const Json blend = options.is_null() ? Json("auto") : options.at("blend");
  gl::Context context = gl::Context::external(nullptr, gl::Api::es);
  if (engine.view)
    engine.view->regain_device(std::move(context));
  else
    engine.view.emplace(std::move(context), blending_of(blend),
                        [&engine] { return make_page_sorter(engine.sorting); });
  const gl::Capabilities& device = engine.page().capabilities();
  Json limits = to_json(device_limits(device));
  limits["blend"] = blend;
  return object({{"renderer", device.renderer},
                 {"vendor", device.vendor},
                 {"gl_version", device.version},
                 {"limits", limits},
                 {"max_image_side", device.max_image_side}});
}

// -- scenes -------------------------------------------------------------------------------------

ShownScene scene_of(const Json& scene, const Json& names) {
  ShownScene shown{.subject = subject_of(scene.at("subject")),
                   .cameras = {},
                   .first_view = {},
                   .background = glm::vec3(vector_of(scene.at("background"))),
                   .names = names.get<std::vector<std::string>>()};
  if (const Json& view = scene.at("first_view"); !view.is_null())
    shown.first_view = camera_of(view);
  for (const Json& camera : scene.at("cameras")) shown.cameras.push_back(camera_of(camera));
  return shown;
}

/// {"scene": result of "read", "role": "preview" or "scene", "names": of its layers}
void show(Engine& engine, const Json& arguments) {
  PageView& view = engine.page();
  const ShownScene scene = scene_of(arguments.at("scene"), arguments.at("names"));
  if (arguments.at("role") == "preview") return view.show_preview(unpacked(engine), scene);
  view.drop_scene();  // before unpacking: the device's memory may not hold both scenes
  view.show(unpacked(engine), scene);
}

void clear(Engine& engine) {
  engine.arriving.reset();
  engine.page().drop_preview();
  engine.page().drop_scene();
}

/// The scene's plan, number of drawn primitives, and memory.
Json facts(Engine& engine, const Json&) {
  const Renderer* const renderer = engine.page().renderer();
  Json plan = Json::array();
  std::size_t drawn = 0, device_bytes = 0;
  bool by_processor = false;
  if (renderer) {
    for (const std::shared_ptr<LayerPlan>& layer : renderer->plan().layers) {
      const auto* soup = std::get_if<SoupPlan>(layer.get());
      drawn += soup ? soup->faces.size() : std::get<SplatPlan>(*layer).drawn.size();
    }
    plan = describe(renderer->plan());
    device_bytes = renderer->device_bytes();
    // As in the window: less than triangles beside them would take.
    by_processor = renderer->plan().splats_in_tiles && device_bytes < 50'000;
  }
  return object({{"plan", plan},
                 {"drawn", drawn},
                 {"device_bytes", device_bytes},
                 {"by_processor", by_processor}});
}

/// The box around all layers, and its extent, as texts: the page shows the digits of the window.
Json box(Engine& engine, const Json&) {
  const auto& layers = engine.page().document().layers;
  const Subject box = subject_of(std::vector<LayerPlace>(layers.begin(), layers.end()), {});
  const auto joined = [](const glm::dvec3& v, const std::string& between) {
    return short_decimal(v.x, 4) + between + short_decimal(v.y, 4) + between +
           short_decimal(v.z, 4);
  };
  return object({{"extent", joined(box.high - box.low, " \u00d7 ")},
                 {"low", joined(box.low, ", ")},
                 {"high", joined(box.high, ", ")}});
}

// -- the document -------------------------------------------------------------------------------

Json layers(Engine& engine, const Json&) {
  Json list = Json::array();
  for (const DocumentLayer& layer : engine.page().document().layers) {
    const auto& [triangles, splats, device_bytes] = engine.page().facts(layer.id);
    list.push_back(object({{"id", layer.id},
                           {"name", layer.name},
                           {"triangles", triangles},
                           {"splats", splats},
                           {"visible", layer.visible},
                           {"transform", to_json(layer.world_from_layer)},
                           {"placement", to_json(engine.page().placement(layer))},
                           {"deviceBytes", device_bytes}}));
  }
  return list;
}

Json steps(Engine& engine, const Json&) {
  const History& history = engine.page().history();
  Json names = Json::array();
  for (const History::Step& step : history.steps()) names.push_back(step.name);
  return object({{"names", names}, {"position", history.position()}});
}

/// {"layer": id, "transform"?: 16 numbers, column by column, or "placement"?, "visible"?}
void set_layer(Engine& engine, const Json& arguments) {
  PageView& view = engine.page();
  const LayerId layer = arguments.at("layer");
  std::optional<bool> visible;
  if (const auto given = arguments.find("visible"); given != arguments.end())
    visible = given->get<bool>();
  if (const auto matrix = arguments.find("transform"); matrix != arguments.end())
    view.place_layer(layer, matrix_of(*matrix), visible);
  else if (const auto placement = arguments.find("placement"); placement != arguments.end())
    view.place_layer(layer, placement_of(*placement), visible);
  else if (visible)
    view.show_layer(layer, *visible);
}

/// {"id"} of a layer that is read again, or {"name"} of a new one. The head and the blobs are those
/// of one layer.
void upload_layer(Engine& engine, const Json& arguments) {
  PageView& view = engine.page();
  if (const auto id = arguments.find("id"); id != arguments.end())
    view.upload_again(unpacked(engine), id->get<LayerId>());
  else
    view.upload(unpacked(engine), arguments.at("name").get<std::string>());
}

// -- looking around -----------------------------------------------------------------------------

/// The side of an image for poses, which do not depend on it.
constexpr int any_side = 1000;

Json pose(Engine& engine) {
  const Camera camera = controls(engine).camera(any_side, any_side);
  const ViewState state = state_of(camera, controls(engine).up(), controls(engine).distance());
  return object({{"eye", to_json(camera.eye())},
                 {"target", to_json(state.target)},
                 {"up", to_json(state.up)},
                 {"fov", controls(engine).fov()},
                 {"roll", state.roll}});
}

bool is_angle(double fov) { return fov > 0 && fov < std::numbers::pi; }

bool is_direction(const glm::dvec3& axis) {
  return glm::length(axis) > 0 && std::isfinite(glm::length(axis));
}

void set_up(Engine& engine, const Json& axis) {
  if (!is_direction(vector_of(axis))) throw UsageError("the up axis must be a direction");
  engine.page().set_up(vector_of(axis));
}

void set_fov(Engine& engine, const Json& fov) {
  if (!is_angle(fov.get<double>())) throw UsageError("the angle must be above 0 and below pi");
  controls(engine).set_fov(fov);
}

/// {"pose", "glide"}
void set_pose(Engine& engine, const Json& arguments) {
  const Json& pose = arguments.at("pose");
  const glm::dvec3 eye = vector_of(pose.at("eye")), target = vector_of(pose.at("target"));
  const glm::dvec3 up = vector_of(pose.at("up"));
  const double distance = glm::length(target - eye), fov = pose.at("fov");
  if (!(distance > 0 && std::isfinite(distance) && is_angle(fov) && is_direction(up)))
    throw UsageError(
        "a view needs different eye and target points, an angle between 0 and pi, and an up "
        "direction");
  ViewState state =
      state_of(look_at(eye, target, up, fov, any_side, any_side), glm::normalize(up), distance);
  state.roll += pose.at("roll").get<double>();
  controls(engine).set_up(up);  // no step: it belongs to the view
  controls(engine).adopt(camera_of(state, any_side, any_side));
  controls(engine).set_target_depth(distance);
  if (!arguments.at("glide").get<bool>()) controls(engine).arrive();
}

NamedView named_view(const std::string& name) {
  for (const NamedView view : named_views) {
    if (key_of(view) == name) return view;
  }
  throw UsageError("there is no view \"" + name + "\"");
}

void show_camera(Engine& engine, const Json& index) {
  if (!engine.page().shows_scene()) return;
  const auto& cameras = engine.page().scene().cameras;
  if (index.get<std::size_t>() >= cameras.size())
    throw UsageError("there is no camera " + index.dump());
  controls(engine).adopt(cameras[index.get<std::size_t>()]);
}

/// {"what": "turntable" or "cameras", "seconds": of a loop or the whole path, or null}: plays a
/// turn about what the recorded cameras look at, or about the present target, or a flight along the
/// cameras. null: ends it.
void play(Engine& engine, const Json& arguments) {
  PageView& view = engine.page();
  if (arguments.is_null()) return view.play({});
  if (!view.shows_scene()) throw UsageError("there is no scene: open one first");
  const std::vector<Camera>& cameras = view.scene().cameras;
  const Json& given = arguments.at("seconds");
  const auto seconds = given.is_null() ? std::nullopt : std::optional(given.get<double>());
  if (arguments.at("what") == "cameras") {
    CameraPathData path = path_along(cameras, seconds);
    if (path.keyframes.empty()) throw UsageError("the scene has no recorded cameras for a path");
    return view.play(CameraPath(std::move(path)));
  }
  constexpr double default_turn = 16;  // seconds; about 23 degrees per second
  const double turn = seconds.value_or(default_turn);
  const CameraControls& controls = view.controls();
  const auto& layers = view.document().layers;
  const std::vector<LayerPlace> boxes(layers.begin(), layers.end());
  if (const auto capture = capture_of(cameras, controls.up(), boxes))
    return view.play(CameraPath(turntable(*capture, lens_of(*capture, any_side, any_side), turn)));
  view.play(CameraPath(turntable({.first = controls.camera(any_side, any_side),
                                  .distance = controls.distance(),
                                  .up = controls.up(),
                                  .seconds = turn})));
}

// -- drawing ------------------------------------------------------------------------------------

/// {"width", "height", "seconds"}; returns PageView::Next as a number.
Json draw(Engine& engine, const Json& arguments) {
  return int(
      engine.page().draw(arguments.at("width"), arguments.at("height"), arguments.at("seconds")));
}

/// {"width", "height"}: writes the pixels of the current view to the buffer: RGBA, row 0 on top.
void image(Engine& engine, const Json& arguments) {
  if (!engine.page().shows_scene()) throw UsageError("there is no scene for an image");
  const Image8 image = engine.page().image(arguments.at("width"), arguments.at("height"));
  engine.buffer.resize(image.pixels.size() * sizeof image.pixels[0]);
  std::memcpy(engine.buffer.data(), image.pixels.data(), engine.buffer.size());
}

/// {"folder", "paths", "level"?: maximum lattice level, "max_splats"?, "source": number of the
/// source}: reads a source again, for debug views that need more data than the renderer has. Source
/// 0 is the first.
void read_for_debug_views(Engine& engine, const Json& arguments) {
  if (arguments.at("source") == 0) engine.reread.clear();
  Scene scene = read_scene(scene_path(arguments), read_options(arguments));
  if (const auto level = arguments.find("level"); level != arguments.end()) {
    for (Layer& layer : scene.layers) {
      auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
      if (soup && std::holds_alternative<LatticeTexture>(soup->appearance))
        *soup = edited(std::move(*soup), {.lattice_level = level->get<int>()}, {});
    }
  }
  engine.reread.push_back(std::move(scene));
}

/// [[source, layer of the source, its id], ..]. Keeps what was read for them.
void keep_read_layers(Engine& engine, const Json& shown) {
  PageView::ReadScene read{.scenes = std::exchange(engine.reread, {}), .layers = {}, .options = {}};
  read.options = page_options(read.scenes.at(0), engine.page().splat_blending());
  for (const Json& place : shown) {
    const Scene& scene = read.scenes.at(place.at(0).get<std::size_t>());
    read.layers[place.at(2)] = &scene.layers.at(place.at(1).get<std::size_t>()).primitives;
  }
  engine.page().keep_read_scene(std::move(read));
}

/// {"name", "first"?, "count"?}
void show_debug_view(Engine& engine, const Json& arguments) {
  const auto name = arguments.at("name").get<std::string>();
  const auto what = debug_view_named(name);
  if (!what) throw UsageError("there is no debug view \"" + name + "\"");
  engine.page().show(*what,
                     {.first = arguments.value("first", 0), .count = arguments.value("count", 3)});
}

Json legend(Engine& engine, const Json&) {
  Json entries = Json::array();
  for (const LegendEntry& entry : engine.page().legend())
    entries.push_back(
        object({{"color", to_json(glm::dvec3(entry.color) / 255.0)}, {"text", entry.text}}));
  return entries;
}

/// A command without a result.
template <class Action>
Command on_view(Action action) {
  return does(
      [action](Engine& engine, const Json& arguments) { action(engine.page(), arguments); });
}

}  // namespace

Commands viewer_commands() {
  return {
      {"start", start},
      {"lose_device", does([](Engine& engine, const Json&) {
         engine.arriving.reset();
         engine.page().lose_device();
       })},
      {"take_head", does([](Engine& engine, const Json&) { take_head(engine); })},
      {"upload_block", does(upload_block)},
      {"forget_head", does([](Engine& engine, const Json&) { engine.arriving.reset(); })},
      // Before the blocks of another scene: the device's memory may not hold both.
      {"drop_scene", on_view([](PageView& view, const Json&) { view.drop_scene(); })},
      {"drop_preview", on_view([](PageView& view, const Json&) { view.drop_preview(); })},
      {"show", does(show)},
      {"clear", does([](Engine& engine, const Json&) { clear(engine); })},
      {"facts", facts},
      {"box", box},

      {"layers", layers},
      {"set_layer", does(set_layer)},
      {"remove_layer", on_view([](PageView& view, const Json& id) { view.remove_layer(id); })},
      {"move_layer", on_view([](PageView& view, const Json& a) { view.move_layer(a[0], a[1]); })},
      {"hold", on_view([](PageView& view, const Json& held) { view.hold(held); })},
      {"steps", steps},
      // The layers that must be uploaded first; then nothing has changed.
      {"go_to", [](Engine& engine, const Json& step) { return Json(engine.page().go_to(step)); }},
      {"forget_steps", on_view([](PageView& view, const Json&) { view.forget_steps(); })},
      {"missing", [](Engine& engine, const Json&) { return Json(engine.page().missing()); }},
      {"upload_layer", does(upload_layer)},
      // "is_step"
      {"add_uploaded",
       [](Engine& engine, const Json& step) { return Json(engine.page().add_uploaded(step)); }},
      {"drop_uploaded", on_view([](PageView& view, const Json&) { view.drop_uploaded(); })},
      {"give_up", on_view([](PageView& view, const Json& layers) {
         view.give_up(layers.get<std::vector<LayerId>>());
       })},

      {"viewport", on_view([](PageView& view, const Json& a) { view.set_viewport(a[0], a[1]); })},
      {"mode", on_view([](PageView& view, const Json& a) {
         view.controls().set_mode(a == "fly" ? NavigationMode::fly : NavigationMode::orbit);
       })},
      {"orbit", on_view([](PageView& view, const Json& a) { view.controls().orbit(a[0], a[1]); })},
      {"pan", on_view([](PageView& view, const Json& a) { view.controls().pan(a[0], a[1]); })},
      {"turn_head",
       on_view([](PageView& view, const Json& a) { view.controls().look(a[0], a[1]); })},
      {"dolly", on_view([](PageView& view, const Json& a) {
         if (a.size() == 1)
           view.controls().dolly(a[0]);
         else
           view.controls().dolly(a[0], {a[1].get<double>(), a[2].get<double>()});
       })},
      {"scale_speed",
       on_view([](PageView& view, const Json& a) { view.controls().scale_speed(a[0]); })},
      {"speed", [](Engine& engine, const Json&) { return Json(controls(engine).speed()); }},
      {"fly", on_view([](PageView& view, const Json& a) {
         view.fly({.direction = vector_of(a[0]), .factor = a[1]});
       })},
      {"frame", on_view([](PageView& view, const Json&) { view.controls().frame(); })},
      {"home", on_view([](PageView& view, const Json&) { view.home(); })},
      {"named_view", on_view([](PageView& view, const Json& a) {
         view.controls().look_from(named_view(a.get<std::string>()));
       })},
      {"camera", does(show_camera)},
      {"up", does(set_up)},
      {"fov", does(set_fov)},
      {"gliding", on_view([](PageView& view, const Json& a) {
         view.controls().set_smoothing(a.get<bool>() ? CameraControls().smoothing() : 0.0);
       })},
      {"arrive", on_view([](PageView& view, const Json&) { view.controls().arrive(); })},
      {"pose", [](Engine& engine, const Json&) { return pose(engine); }},
      {"set_pose", does(set_pose)},
      {"focus",
       [](Engine& engine, const Json& a) {
         return Json(engine.page().focus({a.at(0).get<double>(), a.at(1).get<double>()},
                                         {a.at(2).get<double>(), a.at(3).get<double>()}));
       }},

      {"play", does(play)},
      {"shown_camera",
       [](Engine& engine, const Json& size) {
         return to_json(controls(engine).camera(size.at(0), size.at(1)));
       }},
      {"draw", draw},
      {"smooth_at_rest",
       on_view([](PageView& view, const Json& smooth) { view.smooth_at_rest(smooth); })},
      {"sort_in_frames", on_view([](PageView& view, const Json&) { view.sort_in_frames(); })},
      {"picture", does(image)},
      {"background",
       [](Engine& engine, const Json&) { return to_json(glm::dvec3(engine.page().background())); }},
      {"set_background", on_view([](PageView& view, const Json& a) {
         view.set_background(glm::vec3(vector_of(a)));
       })},
      {"is_read_for_debug_views",
       [](Engine& engine, const Json&) { return Json(engine.page().has_read_scene()); }},
      {"read_for_debug_views", does(read_for_debug_views)},
      {"keep_read_layers", does(keep_read_layers)},
      {"debug_view", does(show_debug_view)},
      {"legend", legend}};
}

}  // namespace tureen::web
