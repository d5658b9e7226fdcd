// The page's commands to its PageView.
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "camera/view_state.hpp"
#include "formats/scene_file.hpp"
#include "runtime/plan/plan_description.hpp"
#include "scene/edit/edits.hpp"
#include "web/engine/commands.hpp"
#include "web/engine/page_options.hpp"
#include "web/engine/page_view.hpp"
#include "web/engine/scene_path.hpp"
#include "web/engine/unpacking.hpp"

namespace tureen::web {

namespace {

PageView& view() { return page_view(); }
CameraControls& controls() { return view().controls(); }

/// {"blend"?: of splats: "auto", "raster" or "tiles"}. "limits" is for the loader's commands.
Json start(const Json& options) {
  const Json blend = options.is_null() ? Json("auto") : options.at("blend");
  start_page_view(blending_of(blend));
  const gl::Capabilities& device = view().capabilities();
  Json limits = to_json(device_limits(device));
  limits["blend"] = blend;
  return object({{"renderer", device.renderer},
                 {"vendor", device.vendor},
                 {"gl_version", device.version},
                 {"limits", limits},
                 {"max_image_side", device.max_image_side}});
}

// -- scenes -------------------------------------------------------------------------------------

ShownScene scene_of(const Json& scene) {
  ShownScene shown{.subject = subject_of(scene.at("subject")), .cameras = {}, .first_view = {}};
  if (const Json& view = scene.at("first_view"); !view.is_null())
    shown.first_view = camera_of(view);
  for (const Json& camera : scene.at("cameras")) shown.cameras.push_back(camera_of(camera));
  return shown;
}

Json layers() {
  Json list = Json::array();
  for (const auto& [place, triangles, splats, device_bytes] : view().layers())
    list.push_back(object({{"triangles", triangles},
                           {"splats", splats},
                           {"visible", place.visible},
                           {"transform", to_json(place.world_from_layer)},
                           {"placement", to_json(similarity_of(place.world_from_layer))},
                           {"device_bytes", device_bytes}}));
  return list;
}

Json facts() {
  std::size_t drawn = 0;
  for (const std::shared_ptr<LayerPlan>& layer : view().renderer().plan().layers) {
    const auto* soup = std::get_if<SoupPlan>(layer.get());
    drawn += soup ? soup->faces.size() : std::get<SplatPlan>(*layer).drawn.size();
  }
  return object({{"plan", describe(view().renderer().plan())},
                 {"drawn", drawn},
                 {"device_bytes", view().renderer().device_bytes()},
                 {"layers", layers()}});
}

/// {"scene": result of "read", "role": "preview" or "scene"}
Json show(const Json& arguments) {
  const ShownScene scene = scene_of(arguments.at("scene"));
  if (arguments.at("role") == "preview") {
    view().show_preview(unpacked(), scene);
    return facts();
  }
  view().drop_scene();  // before unpacking: the device's memory may not hold both scenes
  view().show(unpacked(), scene);
  return facts();
}

void clear() {
  forget_head();
  view().drop_preview();
  view().drop_scene();
}

// -- layers: each command returns facts(), except those that only place or show a layer, which
// return layers() --------------------------------------------------------------------------------

/// The head and the blobs are those of the layers.
Json add_layers(const Json&) {
  view().add_layers(unpacked());
  return facts();
}

/// {"layer", "transform"?: 16 numbers, column by column, or "placement"?, "visible"?}
Json set_layer(const Json& arguments) {
  const std::size_t layer = arguments.at("layer");
  if (const auto matrix = arguments.find("transform"); matrix != arguments.end())
    view().place_layer(layer, matrix_of(*matrix));
  if (const auto placement = arguments.find("placement"); placement != arguments.end())
    view().place_layer(layer, matrix_of(placement_of(*placement)));
  if (const auto visible = arguments.find("visible"); visible != arguments.end())
    view().show_layer(layer, visible->get<bool>());
  return layers();
}

Json remove_layer(const Json& layer) {
  view().remove_layer(layer);
  return facts();
}

/// {"from", "to"}
Json move_layer(const Json& arguments) {
  view().move_layer(arguments.at("from"), arguments.at("to"));
  return facts();
}

// -- looking around -----------------------------------------------------------------------------

/// The side of an image for poses, which do not depend on it.
constexpr int any_side = 1000;

Json pose() {
  const Camera camera = controls().camera(any_side, any_side);
  const ViewState state = state_of(camera, controls().up(), controls().distance());
  return object({{"eye", to_json(camera.eye())},
                 {"target", to_json(state.target)},
                 {"up", to_json(state.up)},
                 {"fov", controls().fov()},
                 {"roll", state.roll}});
}

bool is_angle(double fov) { return fov > 0 && fov < std::numbers::pi; }

bool is_direction(const glm::dvec3& axis) {
  return glm::length(axis) > 0 && std::isfinite(glm::length(axis));
}

void set_up(const Json& axis) {
  if (!is_direction(vector_of(axis))) throw UsageError("the up axis must be a direction");
  controls().set_up(vector_of(axis));
}

void set_fov(const Json& fov) {
  if (!is_angle(fov.get<double>())) throw UsageError("the angle must be above 0 and below pi");
  controls().set_fov(fov);
}

/// {"pose", "glide"}
void set_pose(const Json& arguments) {
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
  controls().set_up(up);
  controls().adopt(camera_of(state, any_side, any_side));
  controls().set_target_depth(distance);
  if (!arguments.at("glide").get<bool>()) controls().arrive();
}

NamedView named_view(const std::string& name) {
  for (const NamedView view : named_views) {
    if (key_of(view) == name) return view;
  }
  throw UsageError("there is no view \"" + name + "\"");
}

void show_camera(const Json& index) {
  if (!view().shows_scene()) return;
  const auto& cameras = view().scene().cameras;
  if (index.get<std::size_t>() >= cameras.size())
    throw UsageError("there is no camera " + index.dump());
  controls().adopt(cameras[index.get<std::size_t>()]);
}

// -- drawing ------------------------------------------------------------------------------------

/// {"width", "height", "seconds"}; returns PageView::Next as a number.
Json draw(const Json& arguments) {
  return int(view().draw(arguments.at("width"), arguments.at("height"), arguments.at("seconds")));
}

/// {"width", "height"}: writes the pixels of the current view to the buffer: RGBA, row 0 on top.
void image(const Json& arguments) {
  if (!view().shows_scene()) throw UsageError("there is no scene for an image");
  const Image8 image = view().image(arguments.at("width"), arguments.at("height"));
  buffer().resize(image.pixels.size() * sizeof image.pixels[0]);
  std::memcpy(buffer().data(), image.pixels.data(), buffer().size());
}

/// The scenes that "read_for_debug_views" has read, one for each source of the page.
std::vector<Scene>& reread() {
  static std::vector<Scene> scenes;
  return scenes;
}

/// {"folder", "paths", "level"?: maximum lattice level, "max_splats"?, "source": number of the
/// source}: reads a source again, for debug views that need more data than the renderer has. Source
/// 0 is the first.
void read_for_debug_views(const Json& arguments) {
  if (arguments.at("source") == 0) reread().clear();
  Scene scene = read_scene(scene_path(arguments), read_options(arguments));
  if (const auto level = arguments.find("level"); level != arguments.end()) {
    for (Layer& layer : scene.layers) {
      auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
      if (soup && std::holds_alternative<LatticeTexture>(soup->appearance))
        *soup = edited(std::move(*soup), {.lattice_level = level->get<int>()}, {});
    }
  }
  reread().push_back(std::move(scene));
}

/// [[source, layer of the source], ..]: the shown layers. Keeps what was read for them.
void keep_read_layers(const Json& shown) {
  PageView::ReadScene read{.scenes = std::exchange(reread(), {}), .layers = {}, .options = {}};
  read.options = page_options(read.scenes.at(0), view().splat_blending());
  for (const Json& place : shown) {
    const Scene& scene = read.scenes.at(place.at(0).get<std::size_t>());
    read.layers.push_back(&scene.layers.at(place.at(1).get<std::size_t>()).primitives);
  }
  view().keep_read_scene(std::move(read));
}

/// {"name", "first"?, "count"?}
void show_debug_view(const Json& arguments) {
  const auto name = arguments.at("name").get<std::string>();
  const auto what = debug_view_named(name);
  if (!what) throw UsageError("there is no debug view \"" + name + "\"");
  view().show(*what, {.first = arguments.value("first", 0), .count = arguments.value("count", 3)});
}

Json legend(const Json&) {
  Json entries = Json::array();
  for (const LegendEntry& entry : view().legend())
    entries.push_back(
        object({{"color", to_json(glm::dvec3(entry.color) / 255.0)}, {"text", entry.text}}));
  return entries;
}

}  // namespace

Commands viewer_commands() {
  return {
      {"start", start},
      {"take_head", does(take_head)},
      {"upload_block", does(upload_block)},
      {"forget_head", does([](const Json&) { forget_head(); })},
      // Before the blocks of another scene: the device's memory may not hold both.
      {"drop_scene", does([](const Json&) { view().drop_scene(); })},
      {"drop_preview", does([](const Json&) { view().drop_preview(); })},
      {"show", show},
      {"clear", does([](const Json&) { clear(); })},
      {"add_layers", add_layers},
      {"set_layer", set_layer},
      {"remove_layer", remove_layer},
      {"move_layer", move_layer},

      {"viewport", does([](const Json& a) { view().set_viewport(a[0], a[1]); })},
      {"mode", does([](const Json& a) {
         controls().set_mode(a == "fly" ? NavigationMode::fly : NavigationMode::orbit);
       })},
      {"orbit", does([](const Json& a) { controls().orbit(a[0], a[1]); })},
      {"pan", does([](const Json& a) { controls().pan(a[0], a[1]); })},
      {"turn_head", does([](const Json& a) { controls().look(a[0], a[1]); })},
      {"dolly", does([](const Json& a) {
         if (a.size() == 1)
           controls().dolly(a[0]);
         else
           controls().dolly(a[0], {a[1].get<double>(), a[2].get<double>()});
       })},
      {"scale_speed", does([](const Json& a) { controls().scale_speed(a[0]); })},
      {"speed", [](const Json&) { return Json(controls().speed()); }},
      {"fly",
       does([](const Json& a) { view().fly({.direction = vector_of(a[0]), .factor = a[1]}); })},
      {"frame", does([](const Json&) { controls().frame(); })},
      {"home", does([](const Json&) { controls().reset(); })},
      {"named_view",
       does([](const Json& a) { controls().look_from(named_view(a.get<std::string>())); })},
      {"camera", does(show_camera)},
      {"up", does(set_up)},
      {"fov", does(set_fov)},
      {"gliding", does([](const Json& a) {
         controls().set_smoothing(a.get<bool>() ? CameraControls().smoothing() : 0.0);
       })},
      {"arrive", does([](const Json&) { controls().arrive(); })},
      {"pose", [](const Json&) { return pose(); }},
      {"set_pose", does(set_pose)},
      {"focus",
       [](const Json& a) {
         return Json(view().focus({a.at(0).get<double>(), a.at(1).get<double>()},
                                  {a.at(2).get<double>(), a.at(3).get<double>()}));
       }},

      {"draw", draw},
      {"smooth_at_rest", does([](const Json& smooth) { view().smooth_at_rest(smooth); })},
      {"sort_in_frames", does([](const Json&) { view().sort_in_frames(); })},
      {"picture", does(image)},
      {"background", does([](const Json& a) { view().set_background(glm::vec3(vector_of(a))); })},
      {"is_read_for_debug_views", [](const Json&) { return Json(view().has_read_scene()); }},
      {"read_for_debug_views", does(read_for_debug_views)},
      {"keep_read_layers", does(keep_read_layers)},
      {"debug_view", does(show_debug_view)},
      {"legend", legend}};
}

}  // namespace tureen::web
