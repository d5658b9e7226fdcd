// The program's output: prose for people on standard error, JSON for programs on standard output.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "base/json/json_text.hpp"

namespace tureen {
struct Remark;
struct SceneInfo;
}  // namespace tureen

namespace tureen::cli {

/// After this, say() and progress print nothing: --quiet.
void be_quiet();
bool is_quiet();

/// Prints the line even with --quiet: errors.
void say_error(const std::string& line);

/// Prints one line on standard error. Escapes control characters and line breaks from files, so
/// that they neither control the terminal nor imitate another message (base/shown_text.hpp).
void say(const std::string& line);

/// Prints indented lines under a heading; prints nothing if there are no lines.
void say_list(const std::string& heading, const std::vector<std::string>& lines);

/// Prints on standard output. Throws OutputError if it cannot be written, as do the two functions
/// below.
void print_text(const std::string& text);

/// Prints the document on standard output. Control characters are escaped.
void print_json(const Json& document);

/// The same in one line, for programs that read output line by line.
void print_json_line(const Json& document);

/// Sentences for people: the file's own notes, then the remarks, with the options that change what
/// the reader assumed.
std::vector<std::string> notes_of(const SceneInfo& info);
std::vector<std::string> notes_of(const std::vector<Remark>& remarks);

/// {"kind", "severity", "counts", "values", "names", "scene"} for each remark: whole numbers,
/// other numbers and texts in the order of the kind's fields; empty lists are omitted.
Json remarks_json(const std::vector<Remark>& remarks);

/// The time of day, "2026-11-21T15:04:05Z".
std::string utc_now();

/// "917 bytes", "1.2 KiB", "34 MiB".
std::string bytes_text(std::uint64_t bytes);

/// "(1, -2.5, 0.333333)".
std::string vector_text(const glm::dvec3& vector);

}  // namespace tureen::cli
