#include "formats/common/uri.hpp"

#include <algorithm>
#include <cstdint>

#include "base/existing_path.hpp"

namespace tureen {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// A stray '%' is kept, because exporters may not encode it.
std::string percent_decoded(std::string_view uri) {
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
        hex_digit(uri[i + 2]) >= 0) {
      result += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // '-' and '_': the URL-safe alphabet
  if (c == '/' || c == '_') return 63;
  return -1;
}

}  // namespace

std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
  if (uri.substr(0, 5) != "data:") return std::nullopt;
  const std::size_t comma = uri.find(',');
  constexpr std::string_view base64 = ";base64";
  if (comma == std::string_view::npos || comma < base64.size() ||
      uri.substr(comma - base64.size(), base64.size()) != base64)
    throw UriError{"a data URI that is not in base64"};
  std::string_view digits = uri.substr(comma + 1);
  while (!digits.empty() && digits.back() == '=') digits.remove_suffix(1);
  // A last group of one digit holds less than a byte.
  if (digits.size() % 4 == 1) throw UriError{"a data URI whose base64 is cut short"};

  std::vector<std::byte> bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : digits) {
    const int digit = base64_digit(c);
    if (digit < 0) throw UriError{"a data URI with a character that is not base64"};
    bits = (bits << 6 | std::uint32_t(digit)) & 0xffffu;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> held & 0xffu));
  }
  return bytes;
}

Input open_in_folder(const std::filesystem::path& folder, const std::string& name,
                     MemoryBudget budget) {
  const std::filesystem::path path = folder / name;
  // If the file's status is unknown, Input::open reports the reason.
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  try {
    if (std::filesystem::status_known(status)) resolve_name_in_folder(folder, name);
  } catch (const UriError& refusal) {
    throw InputError({path.string()}, refusal.reason);
  }
  return Input::open(path, std::move(budget));
}

std::filesystem::path resolve_in_folder(const std::filesystem::path& folder, std::string_view uri) {
  return resolve_name_in_folder(folder, percent_decoded(uri));
}

std::filesystem::path resolve_name_from_folder(const std::filesystem::path& folder,
                                               const std::string& name) {
  const auto refuse = [&](const std::string& reason) {
    throw UriError{"\"" + name + "\" " + reason};
  };
  if (name.empty()) refuse("names no file");
  if (name.find('\0') != std::string::npos) refuse("holds a zero byte");
  // A colon before any slash is a scheme, or a drive on Windows.
  if (const std::size_t colon = name.find(':');
      colon != std::string::npos && name.find_first_of("/\\") >= colon)
    refuse("is a URL or has a drive; only relative paths are opened");
  const std::filesystem::path relative(name);
  if (relative.is_absolute() || relative.has_root_path() || name.front() == '\\')
    refuse("is an absolute path; only relative paths are opened");
  return folder / relative;
}

std::filesystem::path resolve_name_in_folder(const std::filesystem::path& folder,
                                             const std::string& name) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& reason) {
    throw UriError{"\"" + name + "\" " + reason};
  };
  resolve_name_from_folder(folder, name);
  // Windows accepts both slashes as separators.
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  for (const fs::path& part : fs::path(slashes))
    if (part == "..") refuse("leads out of the scene's folder");

  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) refuse("cannot be looked up: " + error.message());
  fs::path target = fs::weakly_canonical(root / fs::path(name), error);
  if (error) refuse("cannot be looked up: " + error.message());
  if (!lies_in(target, root)) refuse("is a link that leads out of the scene's folder");
  return target;
}

}  // namespace tureen
