// The files of a SOG scene: in a folder, or in a zip archive.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/archive/zip_archive.hpp"

namespace tureen {

class SogFiles {
 public:
  /// `path`: the folder, a file in it, or an archive. Throws InputError.
  explicit SogFiles(const std::filesystem::path& path);
  explicit SogFiles(Input archive);

  bool has(const std::string& name) const;
  /// Whether read() would accept a file of this name that is added: to a folder, and not outside.
  bool may_gain(const std::string& name) const;
  /// The bytes of a file, counted in the budget. Throws InputError if it is missing or its name
  /// leads out of the folder.
  std::vector<std::byte> read(const std::string& name);
  /// Its size in bytes, in an archive as stored; 0 if it is missing.
  std::uint64_t size_of(const std::string& name) const;
  /// The name of a file in errors.
  std::string shown(const std::string& name) const;

  /// For the budget, and errors about the scene as a whole.
  Input& input() { return archive_ ? archive_->input() : *place_; }

 private:
  std::filesystem::path folder_;
  std::optional<ZipArchive> archive_;
  std::optional<Input> place_;  // without bytes: name and budget of a folder
};

}  // namespace tureen
