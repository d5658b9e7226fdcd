// Two scenes on the same photographs, view by view.
#pragma once

#include <memory>
#include <string>

#include "cli/options/dataset_argument.hpp"
#include "cli/options/drawing_options.hpp"
#include "jobs/eval/evaluation.hpp"

namespace tureen::cli {

struct SceneComparison {
  std::string a, b;         // scenes
  std::string background;   // empty: that of the first scene
  DatasetArgument dataset;  // its path is empty: two images are compared
  DatasetPart split = DatasetPart::test;
  std::string folder;  // for images and a report; empty: none
  DrawingOptions drawing;
  bool json = false;
};

/// DATASET, which is not required, and the options that need it.
void add_scene_comparison(Command& command, SceneComparison& comparison);

/// Throws UsageError, InputError, and the errors of evaluate().
ExitCode compare_scenes(const SceneComparison& comparison);

}  // namespace tureen::cli
