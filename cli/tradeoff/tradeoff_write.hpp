// `tureen tradeoff --write`: the scene with its data reduced as chosen.
#pragma once

#include <filesystem>

#include "cli/tradeoff/tradeoff_tables.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// Runs before anything is measured, so that an error does not cost minutes of work. Throws
/// UsageError if `path` does not end in .glb, is `scene`, or exists without `replaces`; OutputError
/// if it cannot be written.
void require_writable_scene(const std::filesystem::path& path, const std::filesystem::path& scene,
                            bool replaces);

/// Writes a scene with one layer, which must hold a TriangleSoup, with the chosen edits as a Tureen
/// GLB, and adds its name to the report. Without a choice, does nothing.
void write_chosen(const std::filesystem::path& path, Scene scene, TradeoffReport& report);

}  // namespace tureen::cli
