#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "base/little_endian.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/sog/sog.hpp"
#include "formats/sog/sog_levels.hpp"
#include "formats/sog/sog_meta.hpp"
#include "formats/sog/sog_remarks.hpp"
#include "formats/splat/splat_builder.hpp"
#include "image/png.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t palette_columns = 64;
/// An upper bound of the tables of an image's decoder, and of a part's palette.
constexpr std::size_t decoder_bytes = 8 << 20;

/// One SOG, and the splats of it to read.
struct SogPart {
  SogMeta meta;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;  // first, count

  std::uint64_t count() const {
    std::uint64_t sum = 0;
    for (const auto& [first, size] : ranges) sum += size;
    return sum;
  }
  int degree() const { return meta.palette ? meta.palette->degree : 0; }
};

/// The inverse of sign(x) log(1 + |x|).
double unlogged(double value) { return std::copysign(std::expm1(std::abs(value)), value); }

class SogReader {
 public:
  SogReader(SogFiles& files, const ReadOptions& options) : files_(files), options_(options) {}

  Scene read() {
    std::vector<SogPart> parts;
    std::optional<Remark> chosen;
    if (files_.has("lod-meta.json") && !files_.has("meta.json"))
      parts = parts_of_level(chosen);
    else
      parts.push_back(whole_part("meta.json"));
    std::uint64_t total = 0;
    int degree = 0;
    for (const SogPart& part : parts) {
      total += part.count();
      degree = std::max(degree, part.degree());
    }
    const std::string_view profile = parts.front().meta.profile;
    SplatBuilder builder(files_.input(), options_, Gaussians{.flat = profile == "2dgs"}, degree,
                         total);
    ProgressMeter meter(options_);
    for (const SogPart& part : parts) {
      add(part, degree, builder, [&] {
        meter.step([&] { return double(added_) / double(total); });
        ++added_;
      });
    }
    Scene scene = builder.finish(*profile_named(profile), "SOG");
    if (chosen) scene.info.remarks.push_back(*chosen);
    return scene;
  }

 private:
  SogPart whole_part(const std::string& name) {
    SogPart part = part_of(name);
    part.ranges = {{0, part.meta.count}};
    return part;
  }

  SogPart part_of(const std::string& name) {
    files_.input().take_memory(1, sizeof(SogPart), "the description of a SOG");
    SogPart part{.meta = read_sog_meta(files_, name), .ranges = {}};
    auto& palette = part.meta.palette;
    if (palette && palette->degree == 0) {
      const PassingMemory passing(files_.input().budget());
      const int width = image(part.meta.folder + palette->entries).width;
      for (int degree = 1; degree <= 3; ++degree)
        if (std::size_t(width) == palette_columns * coefficients_of(degree))
          palette->degree = degree;
      if (palette->degree == 0) palette.reset();
    }
    return part;
  }

  static std::size_t coefficients_of(int degree) {
    return std::size_t(harmonics::count(degree)) - 1;
  }

  /// The parts of the level that ReadOptions select.
  std::vector<SogPart> parts_of_level(std::optional<Remark>& chosen) {
    const SogLevels levels = read_sog_levels(files_);
    const std::size_t last = levels.levels.size() - 1;
    if (options_.lod) {
      if (*options_.lod > last)
        files_.input().fail("there is no level " + std::to_string(*options_.lod),
                            "the scene has the levels 0 to " + std::to_string(last));
      std::vector<SogPart> parts = parts_of(levels, *options_.lod);
      if (last > 0)
        chosen = Remark{
            &remarks::level_read,
            {{"levels", last + 1}, {"level", *options_.lod}, {"splats", total_count(parts)}}};
      return parts;
    }
    std::uint64_t finest = 0;
    for (const auto& range : levels.levels[0]) finest += range.count;
    for (std::size_t level = 0;; ++level) {
      PassingMemory passing(files_.input().budget());
      std::vector<SogPart> parts;
      if (may_fit(levels, level) || level == last) parts = parts_of(levels, level);
      if (level < last && !fits(parts)) continue;
      passing.keep(parts.size() * sizeof(SogPart));
      if (last > 0)
        chosen = Remark{&remarks::level_chosen,
                        {{"levels", last + 1},
                         {"level", level},
                         {"splats", total_count(parts)},
                         {"finest", finest}}};
      return parts;
    }
  }

  static std::uint64_t total_count(const std::vector<SogPart>& parts) {
    std::uint64_t splats = 0;
    for (const SogPart& part : parts) splats += part.count();
    return splats;
  }

  /// Whether the splats of the level are no more than requested.
  bool may_fit(const SogLevels& levels, std::size_t level) const {
    std::uint64_t splats = 0;
    for (const auto& range : levels.levels[level]) splats += range.count;
    return splats > 0 && (!options_.max_splats || splats <= *options_.max_splats);
  }

  /// Whether the budget holds the splats, twice while they are sorted, with keys of 17 bytes, and
  /// the images of one part, 7 of 4 bytes per splat, with their sources.
  bool fits(const std::vector<SogPart>& parts) {
    const std::uint64_t total = total_count(parts);
    std::uint64_t largest = 0;
    int degree = 0;
    for (const SogPart& part : parts) {
      largest = std::max(largest, part.meta.count);
      degree = std::max(degree, part.degree());
    }
    if (total == 0 || (options_.max_splats && total > *options_.max_splats)) return false;
    const std::uint64_t each = 2 * bytes_per_splat(Gaussians{}, degree) + 17;
    return total * each + largest * 56 + decoder_bytes <= files_.input().budget().left();
  }

  std::vector<SogPart> parts_of(const SogLevels& levels, std::size_t level) {
    std::map<std::uint32_t, std::size_t> part_of_file;
    std::vector<SogPart> parts;
    if (!levels.environment.empty()) parts.push_back(whole_part(levels.environment));
    for (const SogLevels::Range& range : levels.levels[level]) {
      const auto [found, is_new] = part_of_file.try_emplace(range.file, parts.size());
      if (is_new) parts.push_back(part_of(levels.filenames[range.file]));
      SogPart& part = parts[found->second];
      if (range.offset > part.meta.count || range.count > part.meta.count - range.offset)
        files_.input().fail("a range of splats leaves " + levels.filenames[range.file] +
                            ", which has " + std::to_string(part.meta.count));
      part.ranges.emplace_back(range.offset, range.count);
    }
    if (parts.empty()) files_.input().fail("level " + std::to_string(level) + " has no splats");
    return parts;
  }

  Image8 image(const std::string& name) {
    const std::vector<std::byte> bytes = files_.read(name);
    return decode_image(bytes, files_.shown(name), files_.input().budget());
  }
  /// An image with a pixel for each splat.
  Image8 image_of(const SogMeta& meta, const std::string& name) {
    Image8 result = image(meta.folder + name);
    if (result.pixels.size() < meta.count)
      throw InputError({files_.shown(meta.folder + name)},
                       "an image of " + std::to_string(result.width) + " x " +
                           std::to_string(result.height) + " cannot hold " +
                           std::to_string(meta.count) + " splats");
    return result;
  }

  template <class Step>
  void add(const SogPart& part, int degree, SplatBuilder& builder, Step&& step) {
    const SogMeta& meta = part.meta;
    const PassingMemory passing(files_.input().budget());
    const Image8 low = image_of(meta, meta.means_low), high = image_of(meta, meta.means_high),
                 scales = image_of(meta, meta.scales), turns = image_of(meta, meta.rotations),
                 colors = image_of(meta, meta.colors);
    Image8 indices, entries;
    std::uint64_t palette_count = 0;
    const std::size_t each = coefficients_of(part.degree());
    if (const auto& palette = meta.palette) {
      indices = image_of(meta, palette->indices);
      entries = image(meta.folder + palette->entries);
      const std::uint64_t room = std::uint64_t(entries.height) * palette_columns;
      palette_count = palette->count > 0 ? palette->count : room;
      if (std::size_t(entries.width) != palette_columns * each || palette_count > room)
        throw InputError({files_.shown(meta.folder + palette->entries)},
                         "a palette of " + std::to_string(palette_count) +
                             " entries does not have the size " + std::to_string(entries.width) +
                             " x " + std::to_string(entries.height));
    }
    std::array<glm::vec3, harmonics::count(3)> coefficients{};
    const auto used = std::span(coefficients).first(std::size_t(harmonics::count(degree)));
    for (const auto& [first, size] : part.ranges)
      for (std::size_t i = std::size_t(first); i < std::size_t(first + size); ++i) {
        step();
        SplatValues splat;
        for (int k = 0; k < 3; ++k) {
          const double fraction = double(low.pixels[i][k] + 256 * high.pixels[i][k]) / 65535;
          splat.center[k] = unlogged(meta.low[k] + (meta.high[k] - meta.low[k]) * fraction);
          splat.scales[k] = float(meta.scale_values[std::size_t(k)][scales.pixels[i][k]]);
          coefficients[0][k] = float(meta.color_values[std::size_t(k)][colors.pixels[i][k]]);
        }
        if (std::string_view(meta.profile) == "2dgs") splat.scales.z = 0;
        splat.rotation = rotation_of(turns.pixels[i]);
        splat.opacity = meta.opacity_values[colors.pixels[i].a];
        if (meta.palette) {
          const std::size_t entry = indices.pixels[i].r + 256u * indices.pixels[i].g;
          if (entry >= palette_count)
            splat.rotation = glm::dquat(0, 0, 0, 0);  // not in the palette: to be dropped
          else
            look_up(*meta.palette, entries, entry, each, used);
        }
        builder.add(splat, used);
      }
  }

  /// Sets the coefficients from degree 1 on.
  static void look_up(const SogMeta::Palette& palette, const Image8& entries, std::size_t entry,
                      std::size_t each, std::span<glm::vec3> coefficients) {
    const std::size_t first =
        entry / palette_columns * std::size_t(entries.width) + entry % palette_columns * each;
    for (std::size_t k = 0; k < each; ++k)
      for (int c = 0; c < 3; ++c)
        coefficients[k + 1][c] = float(palette.values[entries.pixels[first + k][c]]);
  }

  /// Zeros, for which SplatBuilder drops the splat, if alpha names no part.
  static glm::dquat rotation_of(const glm::u8vec4& pixel) {
    if (pixel.a < 252) return {0, 0, 0, 0};
    std::array<double, 4> parts{};  // w, x, y, z
    const std::size_t largest = pixel.a - 252u;
    double squares = 0;
    int at = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k == largest) continue;
      parts[k] = (double(pixel[at++]) / 255 - 0.5) * std::sqrt(2.0);
      squares += parts[k] * parts[k];
    }
    parts[largest] = std::sqrt(std::max(0.0, 1 - squares));
    return {parts[0], parts[1], parts[2], parts[3]};
  }

  SogFiles& files_;
  const ReadOptions& options_;
  std::uint64_t added_ = 0;
};

bool begins_with(std::string_view text, std::string_view head) {
  return text.substr(0, head.size()) == head;
}
bool ends_with(std::string_view text, std::string_view tail) {
  return text.size() >= tail.size() && text.substr(text.size() - tail.size()) == tail;
}

/// Other programs have files of the name meta.json, too.
bool has_means(std::span<const std::byte> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  return text.find("\"means\"") != std::string_view::npos;
}

}  // namespace

bool is_sog(const fs::path& path, std::span<const std::byte> head) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    if (fs::is_regular_file(path / "lod-meta.json", ignored)) return true;
    if (!fs::is_regular_file(path / "meta.json", ignored)) return false;
    std::array<std::byte, 4096> first;
    Input input = Input::open(path / "meta.json");
    return has_means(std::span(first).first(input.read_some(first)));
  }
  const std::string name = path.filename().string();
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (begins_with(text, "PK\3\4") && head.size() > 30) {
    const std::string_view first = text.substr(30, std::size_t(little_number(head, 26, 2)));
    return ends_with(first, ".webp") || ends_with(first, ".json");
  }
  return name == "lod-meta.json" || (name == "meta.json" && has_means(head));
}

Scene read_sog(const fs::path& path, const ReadOptions& options) {
  SogFiles files(path);
  Scene scene = SogReader(files, options).read();
  std::error_code ignored;
  const bool is_in_folder = path.filename() == "meta.json" || path.filename() == "lod-meta.json";
  if (is_in_folder || fs::is_directory(path, ignored)) {
    const fs::path whole = fs::absolute(path, ignored).lexically_normal();
    const fs::path folder = is_in_folder || !whole.has_filename() ? whole.parent_path() : whole;
    scene.info.name = folder.filename().string();
  }
  return scene;
}

Scene read_sog_archive(Input archive, const ReadOptions& options) {
  SogFiles files(std::move(archive));
  return SogReader(files, options).read();
}

}  // namespace tureen
