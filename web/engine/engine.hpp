// One instance of the engine: all that its commands share. An instance draws, in the page; others
// read a scene or sort splats, in workers. Each uses only its own part.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/tureen_glb/early_texels.hpp"
#include "web/engine/arriving_scene.hpp"
#include "web/engine/commands.hpp"
#include "web/engine/loader.hpp"
#include "web/engine/page_view.hpp"
#include "web/engine/splat_sorting.hpp"

namespace tureen::web {

struct Bench;  // web/engine/bench.cpp

struct Engine {
  Commands commands;
  /// JSON for the next command, and of the last one. JavaScript writes it here: Emscripten's own
  /// strings go to the stack, which is too small for a scene with many cameras.
  std::string arguments, answer;
  /// The bytes of a command: input from the caller, or output for the caller. Valid until the next
  /// command that uses it.
  std::vector<std::byte> buffer;

  Loader loader;
  EarlyTexels early_texels;  // for "read"
  SplatSorting sorting;

  BlobReader read_blob = pull_block;
  std::optional<ArrivingScene> arriving;
  std::optional<PageView> view;
  std::vector<Scene> reread;  // by "read_for_debug_views", one for each source of the page
  std::shared_ptr<Bench> bench;

  Engine() = default;
  Engine(const Engine&) = delete;  // its parts refer to each other
  Engine& operator=(const Engine&) = delete;

  /// The view of a canvas, after "start".
  PageView& page() { return view.value(); }
};

}  // namespace tureen::web
