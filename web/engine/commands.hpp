// The interface from JavaScript to this program: named commands with JSON as input and output, and
// a buffer for bytes. Files of a scene come through Emscripten's file system; commands get their
// paths. web/viewer/engine.ts is the other side.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "web/engine/values.hpp"

namespace tureen::web {

struct Engine;

/// `arguments`: a JSON value. A command without a result returns null.
using Command = std::function<Json(Engine& engine, const Json& arguments)>;
using Commands = std::map<std::string, Command>;

/// A command without a result.
template <class Action>
Command does(Action action) {
  return [action](Engine& engine, const Json& arguments) {
    action(engine, arguments);
    return Json();
  };
}

/// Commands of the instance in the worker, which reads and prepares scenes.
Commands loader_commands();
/// Commands of the instance in the page, which draws prepared scenes.
Commands viewer_commands();
/// Commands of both.
Commands sorting_commands();
/// Commands of the second program; none in the page's own (no_exchange.cpp).
Commands exchange_commands();
/// Commands of the instance in bench.html; none in the page's program (no_bench.cpp).
Commands bench_commands();

/// Reports the progress of the current command to the page, 0..1.
void report_progress(double fraction);

/// Copies bytes from a blob of the scene that is being unpacked (web/engine/prepared_archive.hpp).
/// The page keeps the blobs in Module.blobs.
void pull_block(std::size_t blob, std::uint64_t offset, std::span<std::byte> out);

}  // namespace tureen::web
