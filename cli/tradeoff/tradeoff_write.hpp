// `tureen tradeoff --write`: the scene with its data reduced as chosen.
#pragma once

#include <filesystem>

#include "cli/tradeoff/tradeoff_tables.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// Before anything is measured: minutes of work must not end in a refusal. Throws UsageError where
/// `path` is no GLB, is `scene` itself, or exists and is not to be replaced; OutputError where it
/// cannot be written.
void require_writable_scene(const std::filesystem::path& path, const std::filesystem::path& scene,
                            bool replaces);

/// Writes the scene, whose primitives are a TriangleSoup, with the edits of the choice as a GLB of
/// ours, and names it in the report. Without a choice nothing is written.
void write_chosen(const std::filesystem::path& path, Scene scene, TradeoffReport& report);

}  // namespace tureen::cli
