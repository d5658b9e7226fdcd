// The program's output: prose for people on standard error, JSON for programs on standard output.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "jobs/results/json_text.hpp"

namespace tureen {
struct Remark;
}

namespace tureen::cli {

using results::Json;
using results::json_text;

/// A line of prose, never more than one: what files say steers no terminal and passes for no line
/// of ours (base/shown_text.hpp).
void say(const std::string& line);

/// Lines under a heading, indented; nothing when there are none.
void say_list(const std::string& heading, const std::vector<std::string>& lines);

/// Standard output; throws OutputError where it cannot be written, as do the two below.
void print_text(const std::string& text);

/// The document on standard output; control characters are escaped.
void print_json(const Json& document);

/// The same in one line, for programs that read output line by line.
void print_json_line(const Json& document);

/// Their kinds and values, {"kind", "counts", "values", "names"}; empty lists are omitted.
Json remarks_json(const std::vector<Remark>& remarks);

/// The time of day, "2026-11-21T15:04:05Z".
std::string utc_now();

/// "917 bytes", "1.2 KiB", "34 MiB".
std::string bytes_text(std::uint64_t bytes);

}  // namespace tureen::cli
