// The one family of exceptions that every room throws: what went wrong, where, and why.
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

class Error : public std::runtime_error {
 public:
  Error(Place place, const std::string& reason)
      : std::runtime_error(to_string(place) + reason), place_(std::move(place)), reason_(reason) {}

  const Place& place() const noexcept { return place_; }
  const std::string& reason() const noexcept { return reason_; }

 private:
  Place place_;
  std::string reason_;
};

/// The input is bad or of a kind we do not read. The program exits with 3.
struct InputError : Error {
  using Error::Error;
};

/// The request makes no sense (an option, a conversion that cannot be). The program exits with 2.
struct UsageError : Error {
  explicit UsageError(const std::string& reason) : Error({}, reason) {}
};

/// No OpenGL context can be had, or it lacks what we need. The program exits with 4.
struct ContextError : Error {
  explicit ContextError(const std::string& reason) : Error({}, reason) {}
};

/// The scene does not fit on this device; the reason forecasts what would. Exits with 5.
struct DeviceLimitError : Error {
  explicit DeviceLimitError(const std::string& reason) : Error({}, reason) {}
};

/// A file could not be written. The program exits with 5.
struct OutputError : Error {
  using Error::Error;
};

}  // namespace tureen
