#include "formats/splat/ksplat.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "base/extension.hpp"
#include "base/little_endian.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/splat/splat_builder.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr std::size_t ksplat_header = 4096, ksplat_section = 1024;
constexpr int ksplat_max_degree = 2;

struct KsplatSection {
  std::uint64_t splats = 0, stored = 0, bucket_size = 0, buckets = 0, full = 0, partial = 0;
  std::uint64_t steps = 0;  // in half of a bucket's box
  double side = 0;
  int degree = 0;
};

class KsplatReader {
 public:
  KsplatReader(Input& input, const ReadOptions& options) : input_(input), options_(options) {}

  Scene read() {
    std::array<std::byte, ksplat_header> head;
    input_.seek(0);
    input_.read(head, "the header");
    if (head[0] != std::byte{0} || head[1] == std::byte{0})
      input_.fail_at(0, "not a .ksplat file of version 0.1");
    level_ = int(little_number(head, 20, 2));
    if (level_ > 2)
      input_.fail_at(20, "level of compression " + std::to_string(level_) + " is not 0, 1 or 2");
    low_ = double(little_float(head, 36));
    high_ = double(little_float(head, 40));
    if (low_ == 0) low_ = -1.5;
    if (high_ == 0) high_ = 1.5;
    const std::uint64_t headers = little_number(head, 4, 4);
    if (headers > input_.remaining() / ksplat_section)
      input_.fail_at(4, "a file of this size cannot have " + std::to_string(headers) + " sections");
    std::vector<KsplatSection> sections;
    input_.take_memory(headers, sizeof(KsplatSection), "the sections");
    std::uint64_t total = 0;
    int degree = 0;
    for (std::uint64_t i = 0; i < headers; ++i) {
      sections.push_back(read_section_header());
      total += sections.back().splats;
      degree = std::max(degree, sections.back().degree);
    }
    if (total > input_.size() / bytes_per_stored_splat(0))
      input_.fail_at(0, "a file of this size cannot hold " + std::to_string(total) + " splats");
    SplatBuilder builder(input_, options_, Gaussians{}, degree, total);
    ProgressMeter meter(options_);
    for (const KsplatSection& section : sections) add(section, degree, builder, meter);
    return builder.finish(*profile_named("3dgs"), ".ksplat");
  }

 private:
  std::size_t part_size() const { return level_ == 0 ? 4 : 2; }
  std::size_t coefficient_size() const { return level_ == 0 ? 4 : level_ == 1 ? 2 : 1; }
  std::size_t bytes_per_stored_splat(int degree) const {
    return 10 * part_size() + 4 +
           3 * std::size_t(harmonics::count(degree) - 1) * coefficient_size();
  }

  KsplatSection read_section_header() {
    std::array<std::byte, ksplat_section> head;
    const std::uint64_t place = input_.position();
    input_.read(head, "a section header");
    const auto number = [&](std::size_t at) { return little_number(head, at, 4); };
    KsplatSection section{.splats = number(0),
                          .stored = number(4),
                          .bucket_size = number(8),
                          .buckets = number(12),
                          .full = number(32),
                          .partial = number(36),
                          .steps = number(24),
                          .side = double(little_float(head, 16)),
                          .degree = int(little_number(head, 40, 2))};
    if (section.steps == 0) section.steps = 32767;
    if (section.degree > ksplat_max_degree)
      input_.fail_at(place + 40, "harmonics of degree " + std::to_string(section.degree) +
                                     "; the largest in .ksplat is 2");
    if (section.splats > section.stored)
      input_.fail_at(place, "a section with more splats than it stores");
    if (section.buckets > 0 && little_number(head, 20, 2) != 12)
      input_.fail_at(place + 20, "buckets with other than 12 bytes");
    return section;
  }

  double real(std::span<const std::byte> bytes, std::size_t at) const {
    if (level_ == 0) return double(little_float(bytes, at));
    return double(glm::unpackHalf1x16(std::uint16_t(little_number(bytes, at, 2))));
  }

  void add(const KsplatSection& section, int degree, SplatBuilder& builder, ProgressMeter& meter) {
    const PassingMemory passing(input_.budget());
    const auto sizes = input_.read_values<std::uint32_t>(section.partial, "the buckets");
    const auto centers = input_.read_values<glm::vec3>(section.buckets, "the buckets");
    const std::size_t stride = bytes_per_stored_splat(section.degree);
    const std::uint64_t end = input_.position() + section.stored * stride;
    if (section.stored > input_.remaining() / stride)
      input_.fail("the file ends within the splats of a section");
    std::array<std::byte, 256 * 64> block;
    const std::size_t at_once = block.size() / stride;
    std::array<glm::vec3, harmonics::count(ksplat_max_degree)> room;
    const auto coefficients = std::span(room).first(std::size_t(harmonics::count(degree)));
    std::uint64_t bucket = section.full, in_bucket = 0;
    for (std::uint64_t first = 0; first < section.splats; first += at_once) {
      const auto some = std::size_t(std::min<std::uint64_t>(at_once, section.splats - first));
      input_.read(std::span(block).first(some * stride), "the splats");
      for (std::size_t i = 0; i < some; ++i) {
        meter.step([&] { return double(input_.position()) / double(input_.size()); });
        const std::uint64_t splat = first + i;
        std::uint64_t own = 0;
        if (level_ > 0) {
          if (section.bucket_size > 0 && splat / section.bucket_size < section.full) {
            own = splat / section.bucket_size;
          } else {
            while (bucket - section.full < sizes.size() &&
                   in_bucket == sizes[std::size_t(bucket - section.full)]) {
              ++bucket;
              in_bucket = 0;
            }
            own = bucket;
            ++in_bucket;
          }
          if (own >= centers.size()) input_.fail("a splat is in no bucket");
        }
        const auto record = std::span(block).subspan(i * stride, stride);
        const SplatValues values =
            unpacked(record, section, level_ > 0 ? centers[std::size_t(own)] : glm::vec3(0));
        unpack_colors(record, section.degree, coefficients);
        builder.add(values, coefficients);
      }
    }
    input_.seek(end);
  }

  SplatValues unpacked(std::span<const std::byte> record, const KsplatSection& section,
                       const glm::vec3& middle) const {
    const std::size_t size = part_size();
    SplatValues splat;
    for (int k = 0; k < 3; ++k) {
      const auto part = std::size_t(k);
      splat.center[k] = real(record, part * size);
      if (level_ > 0)
        splat.center[k] = double(middle[k]) +
                          (double(little_number(record, part * size, 2)) - double(section.steps)) *
                              section.side / 2 / double(section.steps);
      splat.scales[k] = real(record, (3 + part) * size);
    }
    splat.rotation = {real(record, 6 * size), real(record, 7 * size), real(record, 8 * size),
                      real(record, 9 * size)};
    splat.opacity = std::to_integer<int>(record[10 * size + 3]) / 255.0;
    return splat;
  }

  void unpack_colors(std::span<const std::byte> record, int degree,
                     std::span<glm::vec3> coefficients) const {
    std::fill(coefficients.begin(), coefficients.end(), glm::vec3(0));
    const std::size_t size = part_size();
    for (std::size_t c = 0; c < 3; ++c)
      coefficients[0][int(c)] =
          float((std::to_integer<int>(record[10 * size + c]) / 255.0 - 0.5) / harmonics::y00);
    std::size_t at = 10 * size + 4;
    for (int l = 1; l <= degree; ++l)
      for (int c = 0; c < 3; ++c)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k, at += coefficient_size())
          coefficients[std::size_t(k)][c] =
              float(level_ < 2 ? real(record, at)
                               : low_ + (high_ - low_) * std::to_integer<int>(record[at]) / 255.0);
  }

  Input& input_;
  const ReadOptions& options_;
  int level_ = 0;
  double low_ = 0, high_ = 0;
};

}  // namespace

bool is_ksplat(const std::filesystem::path& path) { return extension_of(path) == ".ksplat"; }

Scene read_ksplat(Input& input, const ReadOptions& options) {
  return KsplatReader(input, options).read();
}

Scene read_ksplat(const std::filesystem::path& path, const ReadOptions& options) {
  Input input = Input::open(path);
  return read_ksplat(input, options);
}

}  // namespace tureen
