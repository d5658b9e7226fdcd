#include "formats/dataset/photograph.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/decimal.hpp"
#include "formats/common/uri.hpp"
#include "image/box_scale.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

/// The camera for an image from a folder whose images are `shrunk` times smaller than the dataset's
/// full size. Throws InputError if the sizes do not match.
Camera camera_for(const DatasetFrame& frame, const Image8& image, int shrunk,
                  const std::string& file) {
  const glm::ivec2 full =
      frame.size.value_or(glm::ivec2(image.width * shrunk, image.height * shrunk));
  // Sizes that are not divisible may have been rounded up or down.
  const auto fits = [&](int have, int want) { return std::abs(have * shrunk - want) < shrunk; };
  if (!fits(image.width, full.x) || !fits(image.height, full.y))
    throw InputError({file}, "the image is " + size_text(image.width, image.height) +
                                 ", but its camera's is " + size_text(full.x, full.y) +
                                 (shrunk > 1 ? " / " + std::to_string(shrunk) : ""));
  return resampled(frame.camera(full.x, full.y), image.width, image.height);
}

/// The pixels whose area lies within `known`, after the image was scaled from size `from` to size
/// `to`.
PixelRectangle scaled_rectangle(const PixelRectangle& known, glm::ivec2 from, glm::ivec2 to) {
  // 64 bits: sides are at most 2^16.
  const auto up = [](std::int64_t a, std::int64_t b, std::int64_t c) {
    return int((a * b + c - 1) / c);
  };
  const auto down = [](std::int64_t a, std::int64_t b, std::int64_t c) { return int(a * b / c); };
  return {up(known.left, to.x, from.x), up(known.top, to.y, from.y),
          down(known.right, to.x, from.x), down(known.bottom, to.y, from.y)};
}

Image8 cropped(const Image8& image, const PixelRectangle& area) {
  Image8 result(area.right - area.left, area.bottom - area.top);
  for (int y = 0; y < result.height; ++y)
    std::copy_n(&image.at(area.left, area.top + y), result.width, &result.at(0, y));
  return result;
}

/// A value for each pixel of an image: 1 if a mask excludes it, otherwise 0.
using Marks = std::vector<std::uint8_t>;

/// Throws InputError if the size of the mask differs.
Marks read_mask(const std::filesystem::path& file, glm::ivec2 size, const MemoryBudget& budget) {
  Input input = Input::open(file, budget);
  const Image8 mask = read_image(input);
  if (mask.width != size.x || mask.height != size.y)
    throw InputError({input.name()}, "the mask is " + size_text(mask.width, mask.height) +
                                         ", but its image is " + size_text(size.x, size.y));
  input.take_memory(mask.pixels.size(), 2, "the mask");
  Marks marks(mask.pixels.size());
  std::transform(mask.pixels.begin(), mask.pixels.end(), marks.begin(),
                 [](const glm::u8vec4& pixel) { return !(pixel.r | pixel.g | pixel.b); });
  return marks;
}

/// The pixels of box_scaled() that have a marked pixel in their area.
Marks scaled_marks(const Marks& marks, glm::ivec2 from, glm::ivec2 to) {
  if (from == to) return marks;
  // The source pixels [begin, end) of an output pixel. 64 bits: sides are at most 2^16.
  const auto begin = [](int i, int source, int target) {
    return int(std::int64_t(i) * source / target);
  };
  const auto end = [](int i, int source, int target) {
    return int((std::int64_t(i + 1) * source + target - 1) / target);
  };
  Marks result;
  result.reserve(std::size_t(to.x) * std::size_t(to.y));
  for (int y = 0; y < to.y; ++y)
    for (int x = 0; x < to.x; ++x) {
      const int left = begin(x, from.x, to.x), right = end(x, from.x, to.x);
      bool marked = false;
      for (int row = begin(y, from.y, to.y); row < end(y, from.y, to.y); ++row) {
        const auto first = marks.begin() + std::ptrdiff_t(row) * from.x;
        marked = marked || std::find(first + left, first + right, 1) != first + right;
      }
      result.push_back(marked);
    }
  return result;
}

/// Photograph::ignored: the marks within `area`. Throws InputError if they leave no pixel.
Marks ignored_pixels(const Marks& marks, int width, const PixelRectangle& area,
                     const std::string& file) {
  Marks ignored;
  for (int y = area.top; y < area.bottom; ++y) {
    const auto row = marks.begin() + std::ptrdiff_t(y) * width;
    ignored.insert(ignored.end(), row + area.left, row + area.right);
  }
  const auto count = std::size_t(std::count(ignored.begin(), ignored.end(), 1));
  if (count == ignored.size())
    throw InputError({file}, "the mask leaves no pixel of its photograph");
  if (count == 0) ignored.clear();
  return ignored;
}

}  // namespace

std::optional<std::filesystem::path> find_mask(const DatasetFrame& frame) {
  if (frame.mask.empty()) return {};
  const std::filesystem::path path = resolve_name_from_folder(frame.folder, frame.mask);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError({path.string()}, "the mask of " + frame.name + " is missing");
  return path;
}

std::optional<std::filesystem::path> find_image(const DatasetFrame& frame, int images_folder) {
  std::error_code ignored;
  if (!frame.folder.empty() && !std::filesystem::is_directory(frame.folder, ignored)) return {};
  const auto exists = [&](const std::string& name) -> std::optional<std::filesystem::path> {
    const std::filesystem::path path = resolve_name_from_folder(frame.folder, name);
    if (std::filesystem::is_regular_file(path, ignored)) return path;
    return {};
  };
  if (auto path = exists(frame.file)) return path;
  const std::string bare = std::filesystem::path(frame.file).replace_extension().string();
  for (const char* extension : {".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"}) {
    if (auto path = exists(frame.file + extension)) return path;
    if (images_folder == 1) continue;
    if (auto path = exists(bare + extension)) return path;
  }
  return {};
}

int scaled_side(int side, double scale) { return std::max(1, int(std::lround(side * scale))); }

ReadPhotograph read_photograph(const DatasetFrame& frame, const std::filesystem::path& file,
                               const DatasetOptions& options, const MemoryBudget& budget) {
  PassingMemory passing(budget);
  Input input = Input::open(file, budget);
  Image8 image = read_image(input);
  Camera camera = camera_for(frame, image, options.images_folder, input.name());
  const glm::ivec2 full(image.width, image.height);
  PixelRectangle known{0, 0, full.x, full.y};
  const std::optional<std::filesystem::path> mask_file = find_mask(frame);
  Marks mask;
  if (mask_file) mask = read_mask(*mask_file, full, budget);
  if (!frame.lens.is_pinhole()) {
    // The image in floats with a border, and the undistorted image.
    input.take_memory(std::uint64_t(full.x + 4) * std::uint64_t(full.y + 4),
                      sizeof(glm::vec4) + sizeof(glm::u8vec4) + 1, "the image without its lens");
    Undistorted without_lens = undistorted(image, camera, frame.lens);
    image = std::move(without_lens.image);
    known = without_lens.known;
    if (mask_file) mask = undistorted_marks(mask, camera, frame.lens);
    if (known.right == 0)
      throw InputError({input.name()},
                       "the distortion of its lens cannot be undone: less than half of the "
                       "image would remain");
  }
  const glm::ivec2 size(scaled_side(full.x, options.scale), scaled_side(full.y, options.scale));
  known = scaled_rectangle(known, full, size);
  if (known.left >= known.right || known.top >= known.bottom)
    throw InputError({input.name()}, "no pixels remain at " + size_text(size.x, size.y) +
                                         ", scaled by " + float_text(float(options.scale)));
  camera = resampled(camera, size.x, size.y);
  // The scaled image, and perhaps a cropped copy.
  input.take_memory(std::uint64_t(size.x) * std::uint64_t(size.y), 2 * sizeof(glm::u8vec4),
                    "the scaled image");
  image = box_scaled(image, size.x, size.y);
  if (mask_file) mask = scaled_marks(mask, full, size);

  ReadPhotograph result;
  Photograph& photograph = result.photograph;
  photograph.camera = std::move(camera);
  photograph.camera.name = frame.name;
  photograph.camera.width = known.right - known.left;
  photograph.camera.height = known.bottom - known.top;
  photograph.camera.cx -= known.left;
  photograph.camera.cy -= known.top;
  result.lost_columns = size.x - photograph.camera.width;
  result.lost_rows = size.y - photograph.camera.height;
  const bool crop = result.lost_columns + result.lost_rows > 0;
  photograph.image = crop ? cropped(image, known) : std::move(image);
  if (mask_file) photograph.ignored = ignored_pixels(mask, size.x, known, mask_file->string());
  passing.keep(photograph.image.pixels.size() * sizeof photograph.image.pixels[0] +
               photograph.ignored.size());
  return result;
}

}  // namespace tureen
