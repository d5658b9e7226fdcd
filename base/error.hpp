// The exceptions that every module throws: the failure, its place, its reason and a possible
// remedy. A caller's bug is an assertion instead. No library exits or prints.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace tureen {

/// Where an input failed. `byte` counts from 0, `line` from 1; either may be absent. Without a
/// file, the machine or the request caused the error.
struct FilePosition {
  std::string file;
  std::optional<std::uint64_t> byte = {};
  std::optional<std::uint64_t> line = {};
};

/// "file:line: " or "file: byte N: " or "".
std::string to_string(const FilePosition& position);

/// what() joins the place, the reason and the hint. The reason is valid in every program. The hint
/// names a remedy on the command line: an option, another name, a command. It may be empty. The web
/// page does not show it.
class Error : public std::runtime_error {
 public:
  Error(FilePosition position, std::string reason, std::string hint = {})
      : std::runtime_error(to_string(position) + reason + (hint.empty() ? "" : "; " + hint)),
        position_(std::move(position)),
        reason_(std::move(reason)),
        hint_(std::move(hint)) {}

  const FilePosition& position() const noexcept { return position_; }
  const std::string& reason() const noexcept { return reason_; }
  const std::string& hint() const noexcept { return hint_; }
  std::string without_hint() const { return to_string(position_) + reason_; }

 private:
  FilePosition position_;
  std::string reason_;
  std::string hint_;
};

/// The input is bad or of an unsupported kind. The program exits with 3.
struct InputError : Error {
  using Error::Error;
};

/// The request is impossible: a wrong option or conversion. The program exits with 2.
struct UsageError : Error {
  explicit UsageError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// No OpenGL context is available, or it lacks a required feature. The program exits with 4.
struct ContextError : Error {
  explicit ContextError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// The scene does not fit on this device; the reason forecasts what would fit. The program exits
/// with 5.
struct DeviceLimitError : Error {
  explicit DeviceLimitError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// A file could not be written. The program exits with 5.
struct OutputError : Error {
  using Error::Error;
};

}  // namespace tureen
