// How the runtime draws, on the command line: the options that all commands share which draw.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/plan.hpp"
#include "runtime/preset_check.hpp"
#include "soup/scene.hpp"

namespace tureen::cli {

enum class PresetUse {
  scene,     // the scene's own preset is obeyed where it holds what it promises
  faithful,  // the scene is drawn as it is stored
};

struct DrawingOptions {
  gl::Backend backend = gl::Backend::automatic;
  PlanPreferences plan = {};  // its preset has what was asked for here, not the scene's knobs
  PresetUse preset_use = PresetUse::scene;
  ScenePreset scene_preset = {};
};

/// Takes over the scene's preset, where there is one and the options ask for it, and the views on
/// which it will be checked. The scene's primitives are a TriangleSoup.
void use_preset_of(const Scene& scene, DrawingOptions& options);

/// A renderer as the options ask for; whether it obeys a preset is told by its sentence.
CheckedRenderer make_renderer(const gl::Context& context, const TriangleSoup& soup,
                              glm::dvec3 origin, const DrawingOptions& options,
                              glm::vec4 background);

/// What the plan says, for people: with the sentence on the preset first, where there is one.
std::vector<std::string> plan_sentences(const CheckedRenderer& renderer);

/// --context, --pipeline, --preset, --no-specialise, --keep, --shading and --supersample, which is
/// part of options.plan.preset. `options` must live until the arguments are parsed.
void add_drawing_options(CLI::App& command, DrawingOptions& options);

/// --scale, which is part of it, too; after add_drawing_options. Not where a dataset's photographs
/// have a --scale of their own.
void add_drawing_scale(CLI::App& command, DrawingOptions& options);

}  // namespace tureen::cli
