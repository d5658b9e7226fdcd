#include "formats/sog/sog_levels.hpp"

#include <charconv>
#include <limits>

#include "base/json/json_view.hpp"

namespace tureen {

namespace {

constexpr std::uint64_t max_levels = 64;  // each has half of the splats of the one before
constexpr std::uint64_t max_range = std::numeric_limits<std::uint32_t>::max();

/// `node` is nested as deep as the JSON, which is limited.
void add_ranges(const JsonView& node, SogLevels& result) {
  if (const auto children = node.find("children"))
    for (std::size_t i = 0; i < children->size(); ++i) add_ranges(children->at(i), result);
  const auto lods = node.find("lods");
  if (!lods) return;
  if (!lods->value().is_object()) lods->fail("expected an object");
  for (const auto& [key, value] : lods->value().items()) {
    const JsonView view = (*lods)[key.c_str()];
    std::size_t level = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), level);
    if (error != std::errc() || end != key.data() + key.size() || level >= result.levels.size())
      view.fail("there is no such level");
    const JsonView file = view["file"];
    const std::uint64_t index = file.natural(max_range);
    if (index >= result.filenames.size()) file.fail("there is no such file");
    result.levels[level].push_back({std::uint32_t(index), view["offset"].natural(max_range),
                                    view["count"].natural(max_range)});
  }
}

}  // namespace

SogLevels read_sog_levels(SogFiles& files) {
  const std::vector<std::byte> bytes = files.read("lod-meta.json");
  const std::string file = files.shown("lod-meta.json");
  const nlohmann::json json = parse_json(
      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, 0, files.input().budget());
  const JsonView root(json, file);
  if (const auto version = root.find("version"); version && version->natural() != 1)
    version->fail(
        "version " + std::to_string(version->natural()) + " of streamed SOG is not supported",
        "the supported version is 1");
  SogLevels result;
  const JsonView levels = root["lodLevels"], names = root["filenames"];
  const std::uint64_t count = levels.natural(max_levels);
  if (count == 0) levels.fail("expected at least 1");
  result.levels.resize(std::size_t(count));
  for (std::size_t i = 0; i < names.size(); ++i) result.filenames.push_back(names.at(i).text());
  if (const auto environment = root.find("environment");
      environment && !environment->value().is_null())
    result.environment = environment->text();
  add_ranges(root["tree"], result);
  return result;
}

}  // namespace tureen
