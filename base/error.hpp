// The one family of exceptions that every module throws: what went wrong, where and why, and what a
// person can do about it.
// A caller's bug is an assertion instead; no library exits or prints.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace tureen {

/// Where in an input something went wrong. `byte` counts from 0, `line` from 1; either may be
/// absent, and a place without a file is the machine or the request itself.
struct Place {
  std::string file;
  std::optional<std::uint64_t> byte;
  std::optional<std::uint64_t> line;
};

/// "file:line: " or "file: byte N: " or "".
std::string to_string(const Place& place);

/// what() is the place, the reason and the hint. The reason holds for every program. The hint names
/// what a person can do at the command line (an option, another name, a command); it may be empty,
/// and a page leaves it away.
class Error : public std::runtime_error {
 public:
  Error(Place place, std::string reason, std::string hint = {})
      : std::runtime_error(to_string(place) + reason + (hint.empty() ? "" : "; " + hint)),
        place_(std::move(place)),
        reason_(std::move(reason)),
        hint_(std::move(hint)) {}

  const Place& place() const noexcept { return place_; }
  const std::string& reason() const noexcept { return reason_; }
  const std::string& hint() const noexcept { return hint_; }
  std::string without_hint() const { return to_string(place_) + reason_; }

 private:
  Place place_;
  std::string reason_;
  std::string hint_;
};

/// The input is bad or of a kind we do not read. The program exits with 3.
struct InputError : Error {
  using Error::Error;
};

/// The request makes no sense (an option, a conversion that cannot be). The program exits with 2.
struct UsageError : Error {
  explicit UsageError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// No OpenGL context can be had, or it lacks what we need. The program exits with 4.
struct ContextError : Error {
  explicit ContextError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// The scene does not fit on this device; the reason forecasts what would. Exits with 5.
struct DeviceLimitError : Error {
  explicit DeviceLimitError(std::string reason, std::string hint = {})
      : Error({}, std::move(reason), std::move(hint)) {}
};

/// A file could not be written. The program exits with 5.
struct OutputError : Error {
  using Error::Error;
};

}  // namespace tureen
