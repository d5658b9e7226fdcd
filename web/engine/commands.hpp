// The one way from JavaScript into this program: a command by its name, JSON in, JSON out, and a
// buffer for bytes. web/viewer/engine.ts is the other side.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "web/engine/values.hpp"

namespace tureen::web {

/// Takes what JSON.parse would give; returns null where there is nothing to say.
using Command = std::function<Json(const Json& arguments)>;
using Commands = std::map<std::string, Command>;

/// The bytes that go with a command: written by the caller before it, or by the command for the
/// caller. One for all commands, and good until the next one that uses it.
std::vector<std::byte>& buffer();

/// For the instance in the worker: reads scenes and prepares them.
Commands loader_commands();
/// For the instance of the page: draws what was prepared.
Commands viewer_commands();
/// For that of bench.html.
Commands bench_commands();

/// Tells the page that a command under way is so far: 0..1.
void report_progress(double fraction);

/// Bytes of a blob of the scene that is being unpacked (web/engine/prepared_archive.hpp): the page
/// keeps them, as Module.blobs.
void pull_block(std::size_t blob, std::uint64_t offset, std::span<std::byte> out);

}  // namespace tureen::web
