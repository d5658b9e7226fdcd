// What `tureen tradeoff --import` makes of several runs, for people and for programs: tables, a
// JSON document (docs/json.md) and a CSV file.
#pragma once

#include <string>
#include <vector>

#include "cli/report.hpp"
#include "cli/tradeoff_scenes.hpp"

namespace tureen::cli {

/// What the document calls itself, and the version of its layout.
inline constexpr const char* tradeoff_scenes_format = "tureen tradeoff scenes";
inline constexpr int tradeoff_scenes_version = 1;

Json to_json(const TradeoffScenes& scenes);

/// The tables for a terminal, with what was left out.
void say_tables(const TradeoffScenes& scenes);

/// The scene in which an outcome of the means is farthest from its reference: one of the labels.
const std::string& worst_scene(const TradeoffScenes& scenes, const Outcome& mean);

/// What not all runs have, a sentence for each of the sets of runs that lack something.
std::vector<std::string> left_out_lines(const TradeoffScenes& scenes, const ScenesPanel& panel);

/// How far the means differ by chance, and the hypervolume.
std::string summary(const ScenesPanel& panel);

}  // namespace tureen::cli
