#include "trainer/diffsoup/config_file.hpp"

#include "base/json/json_file.hpp"
#include "base/json/json_view.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::trainer {

namespace {

Preset preset_of(const JsonView& root, Preset otherwise) {
  const std::optional<JsonView> named = root.find("preset");
  return named ? Preset(named->one_of(preset_words())) : otherwise;
}

}  // namespace

Config read_config(Input input, const ConfigDefaults& defaults) {
  const nlohmann::json document = read_json(input, RepeatedKeys::refused);
  const JsonView root(document, input.name());
  const Preset kind = preset_of(root, defaults.preset);
  Config config = defaults.published ? published(kind) : preset(kind);

  assign_fields(config, config_fields(), root);
  if (const std::optional<std::string> reason = defect(config)) root.fail(*reason);
  return config;
}

std::string config_to_json(const Config& config) { return fields_to_json(config, config_fields()); }

}  // namespace tureen::trainer
