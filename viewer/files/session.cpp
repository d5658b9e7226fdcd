#include "viewer/files/session.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "base/json/json_view.hpp"

namespace tureen::viewer {

namespace {

using Json = nlohmann::json;

constexpr std::array button_names = {"left", "right", "middle"};

/// Largest side of a window in points.
constexpr int max_points = 16384;

std::array<double, 2> pair_of(const JsonView& view) {
  if (view.size() != 2) view.fail("expected two numbers");
  return {view.at(0).number(), view.at(1).number()};
}

glm::ivec2 size_of(const JsonView& view) {
  if (view.size() != 2) view.fail("expected a width and a height");
  const glm::ivec2 size(view.at(0).natural(max_points), view.at(1).natural(max_points));
  if (size.x < 1 || size.y < 1) view.fail("a window needs at least one point a side");
  return size;
}

bool truth_of(const JsonView& view) {
  if (!view.value().is_boolean()) view.fail("expected true or false");
  return view.value().get<bool>();
}

/// An event without a value; its JSON value is true.
template <class T>
Event happened(const JsonView& view) {
  if (!truth_of(view)) view.fail("expected true");
  return T{};
}

Key key_of(const JsonView& view) {
  const std::optional<Key> key = key_named(view.text());
  if (!key) view.fail("there is no key \"" + view.text() + "\"");
  return *key;
}

Event event_of(const JsonView& view) {
  if (const auto at = view.find("pointer")) {
    const auto [x, y] = pair_of(*at);
    return PointerMoved{x, y};
  }
  if (const auto name = view.find("button"))
    return ButtonChanged{Button(name->one_of(button_names)), truth_of(view["down"])};
  if (const auto steps = view.find("wheel")) {
    const auto [right, away] = pair_of(*steps);
    return Scrolled{right, away};
  }
  if (const auto key = view.find("key")) return KeyChanged{key_of(*key), truth_of(view["down"])};
  if (const auto text = view.find("text")) {
    if (text->text().size() != 1) text->fail("expected one letter of ASCII");
    return TextTyped{static_cast<unsigned char>(text->text()[0])};
  }
  if (const auto code = view.find("code_point"))
    return TextTyped{static_cast<std::uint32_t>(code->natural(0x10ffff))};
  if (const auto paths = view.find("drop")) {
    FilesDropped dropped;
    for (std::size_t i = 0; i < paths->size(); ++i) dropped.paths.push_back(paths->at(i).text());
    return dropped;
  }
  if (const auto size = view.find("resize")) {
    const glm::ivec2 points = size_of(*size);
    return Resized{points.x, points.y};
  }
  if (const auto focused = view.find("focus")) return FocusChanged{truth_of(*focused)};
  if (const auto close = view.find("close")) return happened<CloseAsked>(*close);
  if (const auto await = view.find("await")) return happened<AwaitRest>(*await);
  if (const auto files = view.find("replace")) {
    if (files->size() != 2) files->fail("expected a file and its replacement");
    return FileReplaced{.from = files->at(1).text(), .to = files->at(0).text()};
  }
  if (const auto name = view.find("click")) {
    ControlClicked clicked{.name = name->text()};
    if (const auto by = view.find("by")) {
      const auto [x, y] = pair_of(*by);
      clicked.by = {x, y};
    }
    return clicked;
  }
  if (const auto name = view.find("picture")) return WindowScreenshot{name->text()};
  view.fail(
      "an event is one of pointer, button, wheel, key, text, code_point, drop, resize, focus, "
      "close, await, replace, click and picture");
}

struct ToJson {
  Json operator()(const PointerMoved& event) const { return {{"pointer", {event.x, event.y}}}; }
  Json operator()(const ButtonChanged& event) const {
    return {{"button", button_names[std::size_t(event.button)]}, {"down", event.down}};
  }
  Json operator()(const Scrolled& event) const { return {{"wheel", {event.right, event.away}}}; }
  Json operator()(const KeyChanged& event) const {
    return {{"key", name_of(event.key)}, {"down", event.down}};
  }
  Json operator()(const TextTyped& event) const { return {{"code_point", event.code_point}}; }
  Json operator()(const FilesDropped& event) const { return {{"drop", event.paths}}; }
  Json operator()(const Resized& event) const { return {{"resize", {event.width, event.height}}}; }
  Json operator()(const FocusChanged& event) const { return {{"focus", event.focused}}; }
  Json operator()(const CloseAsked&) const { return {{"close", true}}; }
  Json operator()(const AwaitRest&) const { return {{"await", true}}; }
  Json operator()(const FileReplaced& event) const { return {{"replace", {event.to, event.from}}}; }
  Json operator()(const ControlClicked& event) const {
    Json json{{"click", event.name}};
    if (event.by.x != 0 || event.by.y != 0) json["by"] = {event.by.x, event.by.y};
    return json;
  }
  Json operator()(const WindowScreenshot& event) const { return {{"picture", event.name}}; }
};

}  // namespace

Session read_session(const std::filesystem::path& file) {
  Input input = Input::open(file);
  const Json json = read_json(input, RepeatedKeys::refused);
  const std::string name = file.string();
  const JsonView root(json, name);
  if (root["tureen_session"].natural() != 1)
    root["tureen_session"].fail("only version 1 is supported");
  Session session;
  session.window = size_of(root["window"]);
  const JsonView events = root["events"];
  double last = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const JsonView event = events.at(i);
    const double at = event["at"].number();
    if (!(at >= last)) event["at"].fail("the time is earlier than that of the previous event");
    last = at;
    session.events.push_back({at, event_of(event)});
  }
  return session;
}

std::string session_to_json(const Session& session) {
  // One event a line, for people who read these files.
  std::string text =
      "{ \"tureen_session\": 1, \"window\": " + Json{session.window.x, session.window.y}.dump() +
      ",\n  \"events\": [";
  for (std::size_t i = 0; i < session.events.size(); ++i) {
    Json event = std::visit(ToJson{}, session.events[i].event);
    event["at"] = session.events[i].seconds;
    text += (i ? ",\n    " : "\n    ") + event.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return text + " ] }\n";
}

void Session::add(double seconds, std::span<const Event> more) {
  for (const Event& event : more) events.push_back({seconds, event});
}

std::vector<Event> Replay::next(bool at_rest) {
  std::vector<Event> events;
  const auto awaits = [this] {
    return !finished() && session_.events[position_].seconds <= clock_ &&
           std::holds_alternative<AwaitRest>(session_.events[position_].event);
  };
  if (awaits()) {
    if (!at_rest) return events;
    events.push_back(session_.events[position_++].event);  // for a recorder
  }
  clock_ += frame_seconds;
  while (!finished() && session_.events[position_].seconds <= clock_ && !awaits()) {
    events.push_back(session_.events[position_++].event);
    if (std::holds_alternative<WindowScreenshot>(events.back())) break;
  }
  return events;
}

}  // namespace tureen::viewer
