#include "scene/document/place_text.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/error.hpp"
#include "base/json/json_text.hpp"

namespace tureen {

namespace {

constexpr char parts_help[] =
    "NAME=PARTS, with parts such as at:1,2,3/turn:0,0,90/scale:2/mirror, mirror:no, hidden or "
    "visible";

[[noreturn]] void fail(std::string_view text, const std::string& reason) {
  throw UsageError("the place '" + std::string(text) + "' " + reason, parts_help);
}

/// The parts of `text` between separators.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == text.npos) return parts;
    begin = end + 1;
  }
}

/// A finite decimal number that is the whole text.
std::optional<double> number_of(const std::string& text) {
  if (text.find_first_not_of("0123456789+-.eE") != text.npos) return {};
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end || !std::isfinite(value)) return {};
  return value;
}

/// The shortest text that reads back as the same number.
std::string exact_text(double value) {
  const std::string text = Json(value).dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

/// Reads the parts of a place.
class PlaceReader {
 public:
  explicit PlaceReader(std::string_view text) : text_(text) {
    const std::size_t equals = text.rfind('=');
    if (equals == text.npos || equals == 0) fail(text, "has no NAME=");
    change_.layer = text.substr(0, equals);
    for (const std::string_view part : split(text.substr(equals + 1), '/')) read(part);
  }
  PlaceChange change() && { return std::move(change_); }

 private:
  void read(std::string_view part) {
    const std::size_t colon = part.find(':');
    const std::string_view key = part.substr(0, colon);
    const std::string_view value = colon == part.npos ? "" : part.substr(colon + 1);
    const auto numbers = [&](std::size_t count) { return numbers_of(part, value, count); };
    if (key == "at") {
      set(change_.position, vector_of(numbers(3)), key);
    } else if (key == "turn") {
      set(change_.angles, vector_of(numbers(3)), key);
    } else if (key == "scale") {
      const double scale = numbers(1)[0];
      if (!(scale > 0)) fail(text_, "has a scale that is not above 0");
      set(change_.scale, scale, key);
    } else if (part == "mirror" || part == "mirror:no") {
      set(change_.mirror, part == "mirror", key);
    } else if (part == "hidden" || part == "visible") {
      set(change_.visible, part == "visible", "hidden or visible");
    } else {
      fail(text_, "has an unknown part: '" + std::string(part) + "'");
    }
  }

  template <class T>
  void set(std::optional<T>& value, const T& given, std::string_view key) const {
    if (value) fail(text_, "has two parts " + std::string(key));
    value = given;
  }

  std::vector<double> numbers_of(std::string_view part, std::string_view value,
                                 std::size_t count) const {
    std::vector<double> numbers;
    for (const std::string_view each : split(value, ',')) {
      const std::optional<double> number = number_of(std::string(each));
      if (!number) break;
      numbers.push_back(*number);
    }
    if (numbers.size() != count || split(value, ',').size() != count)
      fail(text_, "needs " + std::string(count == 1 ? "a number" : "three numbers") + " in '" +
                      std::string(part) + "'");
    return numbers;
  }

  static glm::dvec3 vector_of(const std::vector<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
  }

  std::string_view text_;
  PlaceChange change_;
};

}  // namespace

PlaceChange parse_place(std::string_view text) { return PlaceReader(text).change(); }

std::string place_text(const std::string& layer, const Similarity& place, bool visible) {
  const auto list = [](const glm::dvec3& v) {
    return exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z);
  };
  return layer + "=at:" + list(place.position) + "/turn:" + list(place.angles) +
         "/scale:" + exact_text(place.scale) + (place.mirror ? "/mirror" : "/mirror:no") +
         (visible ? "/visible" : "/hidden");
}

void place_layers(Scene& scene, const std::vector<PlaceChange>& changes) {
  for (const PlaceChange& change : changes) {
    Layer& layer = layer_named(scene, change.layer);
    if (change.visible) layer.visible = *change.visible;
    Similarity place = similarity_of(layer.world_from_layer);
    if (!change.position && !change.angles && !change.scale && !change.mirror) continue;
    place.position = change.position.value_or(place.position);
    place.angles = change.angles.value_or(place.angles);
    place.scale = change.scale.value_or(place.scale);
    place.mirror = change.mirror.value_or(place.mirror);
    Layer moved{.world_from_layer = matrix_of(place)};
    if (const auto reason = defect(moved))
      throw UsageError("the place of " + change.layer + " cannot be used: " + *reason);
    layer.world_from_layer = moved.world_from_layer;
  }
}

}  // namespace tureen
