// Resolves the URIs in a scene file: data in the URI itself, or a file in the scene's own folder.
// Also resolves plain file names. The file and the names in it are untrusted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.hpp"

namespace tureen {

/// The reason why a URI is rejected; the caller adds the file and the place in it.
struct UriError {
  std::string reason;
};

/// The bytes of a base64 data: URI with any media type, or nullopt if `uri` is not a data: URI.
/// Throws UriError if it cannot be decoded.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri);

/// The file with the relative path `name`, taken literally, in or below `folder`. Rejects names as
/// resolve_in_folder does.
std::filesystem::path resolve_name_in_folder(const std::filesystem::path& folder,
                                             const std::string& name);

/// The file with the relative path `name`, taken literally, from `folder`; ".." and links may lead
/// out of it. For photographs, which are often stored apart from the cameras. Throws UriError for
/// an absolute path or a scheme. The file may be missing.
std::filesystem::path resolve_name_from_folder(const std::filesystem::path& folder,
                                               const std::string& name);

/// Opens a file whose name the format fixes. Rejects it as above, with an InputError: an untrusted
/// folder may contain links.
Input open_in_folder(const std::filesystem::path& folder, const std::string& name,
                     MemoryBudget budget);

/// The file with the relative reference `uri`, percent-decoded, in or below `folder`. Throws
/// UriError for an absolute path, a scheme, a "..", or a link that leads out of the folder, before
/// anything is opened. The file may be missing.
std::filesystem::path resolve_in_folder(const std::filesystem::path& folder, std::string_view uri);

}  // namespace tureen
