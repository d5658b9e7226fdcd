// What a scene file may name by URI: data within the URI itself, or a file in the scene's own
// folder and nowhere else; and the same for files that name others plainly. The file is untrusted;
// so are the names in it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.hpp"

namespace tureen {

/// Why a URI is refused; the caller knows which file and which place in it to name.
struct UriError {
  std::string reason;
};

/// The bytes of a data: URI in base64 of any media type, or nothing where `uri` is no data: URI.
/// Throws UriError where it is one but cannot be decoded.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri);

/// The file of the relative path `name`, as it is, in `folder` or below it. Refused as below.
std::filesystem::path resolve_name_in_folder(const std::filesystem::path& folder,
                                             const std::string& name);

/// The file of a name that the format fixes, opened; refused likewise, as an InputError: a folder
/// from untrusted hands may hold links.
Input open_in_folder(const std::filesystem::path& folder, const std::string& name,
                     MemoryBudget budget);

/// The file that the relative reference `uri` names, percent-decoded, in `folder` or below it. An
/// absolute path, a scheme, a "..", and a link that leads out of the folder are refused with a
/// UriError, before anything is opened. The file need not exist.
std::filesystem::path resolve_in_folder(const std::filesystem::path& folder, std::string_view uri);

}  // namespace tureen
