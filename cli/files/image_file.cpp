#include "cli/files/image_file.hpp"

#include <algorithm>

#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/output.hpp"
#include "image/png.hpp"

namespace tureen::cli {

namespace {

std::string padded(int index, int digits) {
  std::string text = std::to_string(index);
  return std::string(std::max(0, digits - int(text.size())), '0') + text;
}

/// `pattern` with its "%d" replaced; `replaced`: whether there was one.
std::string expanded(const std::string& pattern, int index, bool& replaced) {
  std::string result;
  replaced = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      result += pattern[i];
    } else if (i + 1 < pattern.size() && pattern[i + 1] == '%') {
      result += '%';
      ++i;
    } else {
      std::size_t end = i + 1;
      while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end]))) ++end;
      // Widths have at most two digits, as in "%03d" and "%12d".
      const std::string width = pattern.substr(i + 1, end - i - 1);
      if (end == pattern.size() || pattern[end] != 'd' || width.size() > 2 || replaced)
        throw UsageError("'" + pattern + "' is not a name for several images",
                         "use %d or %03d once for the number, and %% for a percent sign");
      result += padded(index, width.empty() ? 0 : std::stoi(width));
      replaced = true;
      i = end;
    }
  }
  return result;
}

}  // namespace

Image8 read_image(const std::filesystem::path& path) {
  Input input = open_existing(path);
  return read_image(input);
}

void write_image(const Image8& image, const std::filesystem::path& path) {
  write_file(path, encode_png(image));
}

void require_png_name(const std::filesystem::path& path) {
  if (extension_of(path) != ".png")
    throw UsageError("'" + path.string() + "' does not end in .png; images are written as PNG");
}

std::filesystem::path image_name(const std::string& pattern, int index, int count) {
  bool replaced = false;
  std::filesystem::path path = expanded(pattern, index, replaced);
  if (replaced || count == 1) return path;
  const int digits = std::max(2, int(std::to_string(count - 1).size()));
  const std::string extension = path.extension().string();
  std::string name = path.stem().string() + "_" + padded(index, digits) + extension;
  return path.replace_filename(name);
}

}  // namespace tureen::cli
