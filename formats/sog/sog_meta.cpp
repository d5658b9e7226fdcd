#include "formats/sog/sog_meta.hpp"

#include <cmath>
#include <limits>

#include "base/json/json_vector.hpp"
#include "base/json/json_view.hpp"
#include "formats/common/splat_activation.hpp"

namespace tureen {

namespace {

/// A compressed image of noise takes more than a byte per pixel. The bound of SPZ, 1024 times the
/// size of the file, keeps a small file from requesting all memory.
constexpr std::uint64_t splats_a_byte = 1024;

ByteValues between_limits(double low, double high) {
  ByteValues values;
  for (std::size_t b = 0; b < values.size(); ++b) values[b] = low + (high - low) * double(b) / 255;
  return values;
}

/// A codebook of at most 256 values. Old writers store NaN, as null, for the first one.
ByteValues codebook(const JsonView& view) {
  ByteValues values;
  values.fill(std::numeric_limits<double>::quiet_NaN());
  const std::size_t size = view.size();
  if (size == 0 || size > values.size()) view.fail("expected 1 to 256 numbers");
  for (std::size_t i = 0; i < size; ++i)
    if (!view.at(i).value().is_null()) values[i] = view.at(i).number();
  // What such a writer meant: the step of the others before the second value.
  if (std::isnan(values[0]) && size > 2)
    values[0] = values[1] - (values[size - 1] - values[1]) / double(size - 2);
  return values;
}

std::array<ByteValues, 3> by_channel(const JsonView& view) {
  std::array<ByteValues, 3> tables;
  if (const auto book = view.find("codebook")) {
    tables.fill(codebook(*book));
    return tables;
  }
  for (std::size_t c = 0; c < 3; ++c)
    tables[c] = between_limits(view["mins"].at(c).number(), view["maxs"].at(c).number());
  return tables;
}

std::string file_of(const JsonView& view, std::size_t index) {
  return view["files"].at(index).text();
}

SogMeta::Palette read_palette(const JsonView& view, bool is_first_version) {
  SogMeta::Palette palette{.entries = file_of(view, 0), .indices = file_of(view, 1)};
  if (is_first_version) {
    palette.values = between_limits(view["mins"].number(), view["maxs"].number());
    return palette;
  }
  palette.degree = int(view["bands"].natural(3));
  palette.count = view["count"].natural(65536);
  if (palette.count == 0) view["count"].fail("expected 1 to 65536");
  palette.values = codebook(view["codebook"]);
  return palette;
}

}  // namespace

SogMeta read_sog_meta(SogFiles& files, const std::string& name, SogImages images) {
  const PassingMemory passing(files.input().budget());
  const std::vector<std::byte> bytes = files.read(name);
  const std::string file = files.shown(name);
  const nlohmann::json json = parse_json(
      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, 0, files.input().budget());
  const JsonView root(json, file);
  const auto version = root.find("version");
  if (version && version->natural() != 2)
    version->fail("SOG version " + std::to_string(version->natural()) + " is not supported",
                  "supported versions are 1 and 2");
  SogMeta meta;
  meta.folder = name.substr(0, name.rfind('/') + 1);
  const JsonView means = root["means"], scales = root["scales"], colors = root["sh0"];
  const JsonView count = version ? root["count"] : means["shape"].at(0);
  meta.count = count.natural(std::numeric_limits<std::uint32_t>::max());
  meta.low = json_vector<3, double>(means["mins"]);
  meta.high = json_vector<3, double>(means["maxs"]);
  meta.means_low = file_of(means, 0);
  meta.means_high = file_of(means, 1);
  meta.scales = file_of(scales, 0);
  meta.rotations = file_of(root["quats"], 0);
  meta.colors = file_of(colors, 0);
  meta.scale_values = by_channel(scales);  // logarithms
  for (ByteValues& axis : meta.scale_values)
    for (double& value : axis) value = std::exp(value);
  meta.color_values = by_channel(colors);
  meta.opacity_values = between_limits(0, 1);
  if (!version) {
    meta.opacity_values =
        between_limits(colors["mins"].at(3).number(), colors["maxs"].at(3).number());
    for (double& value : meta.opacity_values) value = sigmoid(value);
  }
  if (const auto rest = root.find("shN"); rest && !rest->value().is_null())
    if (!version || (*rest)["bands"].natural(3) > 0) meta.palette = read_palette(*rest, !version);
  const auto model = root.find("model"), antialias = root.find("antialias");
  if (model && model->value() == "2dgs")
    meta.profile = "2dgs";
  else if ((model && model->value() == "antialiased") || (antialias && antialias->value() == true))
    meta.profile = "mip";
  if (images == SogImages::may_lack) return meta;
  const std::uint64_t room =
      files.size_of(meta.folder + meta.means_low) + files.size_of(meta.folder + meta.means_high);
  if (meta.count / splats_a_byte > room)
    count.fail("images of " + std::to_string(room) + " bytes cannot hold " +
               std::to_string(meta.count) + " splats");
  return meta;
}

}  // namespace tureen
