#include "formats/dataset/photograph.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/decimal.hpp"
#include "image/box_scale.hpp"
#include "image/codecs/exif.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

glm::ivec2 exchanged(glm::ivec2 size) { return {size.y, size.x}; }

/// Sizes that are not divisible may have been rounded up or down.
bool is_part(glm::ivec2 image, glm::ivec2 full, int factor) {
  return std::abs(image.x * factor - full.x) < factor &&
         std::abs(image.y * factor - full.y) < factor;
}

/// How many times smaller the image is than the dataset's full size, beyond the `shrunk` of its
/// folder. Throws InputError if the sizes do not match.
int factor_of(const DatasetFrame& frame, const Image8& image, int shrunk, const std::string& file) {
  // Smaller images would not be worth a training; a larger factor would hide other mistakes.
  constexpr int most = 16;
  const glm::ivec2 size(image.width, image.height), full = frame.size.value_or(size * shrunk);
  for (int factor = 1; factor <= most; ++factor)
    if (is_part(size, full, shrunk * factor)) return factor;
  throw InputError(
      {file}, "the image is " + size_text(image.width, image.height) + ", but its camera's is " +
                  size_text(full.x, full.y) + (shrunk > 1 ? " / " + std::to_string(shrunk) : "") +
                  (exchanged(size) == full / shrunk ? ", with the sides exchanged" : ""));
}

/// The camera of an image of this size.
Camera camera_for(const DatasetFrame& frame, const Image8& image, glm::ivec2 full) {
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

/// The marks of a mask, for an image of this size. Throws InputError if the mask is neither as
/// large nor larger by an integer factor.
Marks read_mask(const std::filesystem::path& file, glm::ivec2 size, const MemoryBudget& budget) {
  Input input = Input::open(file, budget);
  const Image8 mask = read_image(input);
  const glm::ivec2 found(mask.width, mask.height);
  const int factor = std::max(1, int(std::lround(double(found.x) / size.x)));
  if (!is_part(size, found, factor))
    throw InputError({input.name()}, "the mask is " + size_text(mask.width, mask.height) +
                                         ", but its image is " + size_text(size.x, size.y));
  input.take_memory(mask.pixels.size(), 2, "the mask");
  Marks marks(mask.pixels.size());
  std::transform(mask.pixels.begin(), mask.pixels.end(), marks.begin(),
                 [](const glm::u8vec4& pixel) { return !(pixel.r | pixel.g | pixel.b); });
  return scaled_marks(marks, found, size);
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

std::optional<NearFiles::Found> find_image(const DatasetFrame& frame, int images_folder,
                                           NearFiles& files) {
  std::optional<NearFiles::Found> found = files.find(frame.folder, frame.file);
  if (found && images_folder > 1)
    found->is_exact = found->is_exact ||
                      std::filesystem::path(found->path).replace_extension().lexically_normal() ==
                          (frame.folder / frame.file).replace_extension().lexically_normal();
  return found;
}

std::optional<std::filesystem::path> find_mask(const DatasetFrame& frame, int images_folder,
                                               NearFiles& files) {
  if (!frame.mask.empty()) {
    if (const auto found = files.find(frame.folder, frame.mask)) return found->path;
    throw InputError({(frame.folder / frame.mask).string()},
                     "the mask of " + frame.name + " is missing");
  }
  std::string name = frame.file;
  for (const std::string& images :
       {"images_" + std::to_string(images_folder), std::string("images")})
    if (const std::string prefix = images + "/"; name.starts_with(prefix))
      name.erase(0, prefix.size());
  for (const std::string& masks :
       {"masks_" + std::to_string(images_folder), std::string("masks")}) {
    std::error_code ignored;
    const std::filesystem::path folder = frame.dataset / masks;
    if (!std::filesystem::is_directory(folder, ignored)) continue;
    for (const std::string& wanted : {name + ".png", name})
      if (const auto found = files.find(folder, wanted)) return found->path;
  }
  return std::nullopt;
}

int scaled_side(int side, double scale) { return std::max(1, int(std::lround(side * scale))); }

ReadPhotograph read_photograph(const DatasetFrame& frame, const FoundPhotograph& found,
                               const DatasetOptions& options, const MemoryBudget& budget) {
  PassingMemory passing(budget);
  Input input = Input::open(found.image, budget);
  ReadPhotograph result;
  const std::vector<std::byte> bytes = input.read_rest();
  Image8 image = decode_image(bytes, input.name(), budget);
  if (const int orientation = exif_orientation(bytes); orientation > 1) {
    const glm::ivec2 stored(image.width, image.height);
    result.was_turned = frame.size && stored.x != stored.y && swaps_sides(orientation) &&
                        is_part(exchanged(stored), *frame.size, options.images_folder);
    if (!result.was_turned) result.ignored_orientation = orientation;
    if (result.was_turned) image = turned(image, orientation);
  }
  result.shrunk = factor_of(frame, image, options.images_folder, input.name());
  const glm::ivec2 stored(image.width, image.height);
  Marks mask;
  if (found.mask) mask = read_mask(*found.mask, stored, budget);
  if (frame.face) {
    image = face_image(image, *frame.face);
    if (found.mask) mask = face_marks(mask, stored, *frame.face);
  }
  Camera camera = camera_for(frame, image, frame.size.value_or(stored * options.images_folder));
  const glm::ivec2 full(image.width, image.height);
  PixelRectangle known{0, 0, full.x, full.y};
  if (!frame.lens.is_pinhole()) {
    // The image in floats with a border, and the undistorted image.
    input.take_memory(std::uint64_t(full.x + 4) * std::uint64_t(full.y + 4),
                      sizeof(glm::vec4) + sizeof(glm::u8vec4) + 1, "the image without its lens");
    Undistorted without_lens = undistorted(image, camera, frame.lens);
    image = std::move(without_lens.image);
    known = without_lens.known;
    if (found.mask) mask = undistorted_marks(mask, camera, frame.lens);
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
  if (found.mask) mask = scaled_marks(mask, full, size);

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
  if (crop) image = cropped(image, known);
  result.alpha = alpha_counts(image);
  photograph.image = std::move(image);
  if (found.mask) photograph.ignored = ignored_pixels(mask, size.x, known, found.mask->string());
  passing.keep(photograph.bytes());
  return result;
}

}  // namespace tureen
