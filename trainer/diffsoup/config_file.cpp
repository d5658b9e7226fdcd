#include "trainer/diffsoup/config_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/existing_path.hpp"
#include "base/json/json_file.hpp"
#include "base/json/json_view.hpp"
#include "base/suggestion.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::trainer {

namespace {

/// Sets one member to the value in the file and checks its type. Ranges are checked later, all at
/// once.
struct Assign {
  Config& config;
  const ConfigField& field;
  const JsonView& value;

  void operator()(int Config::*member) const {
    const double number = value.number();
    if (number != std::floor(number)) value.fail("expected a whole number, not " + written());
    // A number that does not fit an int is outside every range.
    if (std::abs(number) > std::numeric_limits<int>::max())
      value.fail(field.range.refusal(number, written()));
    config.*member = static_cast<int>(number);
  }
  void operator()(std::uint64_t Config::*member) const { config.*member = value.natural(); }
  void operator()(float Config::*member) const { config.*member = value.number_float(); }
  void operator()(bool Config::*member) const {
    if (!value.value().is_boolean()) value.fail("expected true or false");
    config.*member = value.value().get<bool>();
  }
  void operator()(Color Config::*member) const {
    if (value.size() != 3) value.fail("expected three numbers: red, green, blue");
    for (std::size_t c = 0; c < 3; ++c) (config.*member)[c] = value.at(c).number_float();
  }
  template <class Enumeration>
  void operator()(Enumeration Config::*member) const {
    config.*member = Enumeration(value.one_of(field.words));
  }

 private:
  std::string written() const { return value.value().dump(); }
};

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const ConfigField& field : config_fields()) names.emplace_back(field.name);
  return names;
}

/// Rejects unknown keys and lists all of them in one error.
void require_known(const JsonView& root, const nlohmann::json& document,
                   const std::vector<std::string>& names) {
  std::string unknown, hint;
  for (const auto& [key, ignored] : document.items())
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      unknown += (unknown.empty() ? "\"" : "; \"") + key + "\" is not a training constant";
      const std::string near = did_you_mean(key, names);
      hint += (hint.empty() || near.empty() ? "" : " ") + near;
    }
  if (!unknown.empty()) root.fail(unknown, hint);
}

Preset preset_of(const JsonView& root, Preset otherwise) {
  const std::optional<JsonView> named = root.find("preset");
  return named ? Preset(named->one_of(preset_words())) : otherwise;
}

}  // namespace

Config read_config(Input& input, const ConfigDefaults& defaults) {
  const nlohmann::json document = read_json(input, RepeatedKeys::refused);
  const JsonView root(document, input.name());
  const Preset kind = preset_of(root, defaults.preset);
  Config config = defaults.published ? published(kind) : preset(kind);

  const std::vector<std::string> names = field_names();
  require_known(root, document, names);
  for (const auto& [key, ignored] : document.items()) {
    const auto known = std::find(names.begin(), names.end(), key);
    const ConfigField& field = config_fields()[std::size_t(known - names.begin())];
    std::visit(Assign{config, field, root[field.name]}, field.member);
  }
  if (const std::optional<std::string> reason = defect(config)) root.fail(*reason);
  return config;
}

Config read_config(const std::filesystem::path& path, const ConfigDefaults& defaults) {
  require_there(path);
  Input input = Input::open(path);
  return read_config(input, defaults);
}

std::string config_to_json(const Config& config) {
  std::string text = "{\n";
  for (const ConfigField& field : config_fields())
    text += std::string(text.size() > 2 ? ",\n" : "") + "  \"" + field.name +
            "\": " + value_text(config, field);
  return text + "\n}\n";
}

}  // namespace tureen::trainer
