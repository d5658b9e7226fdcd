#include "cli/options/drawing_options.hpp"

#include <algorithm>

#include "cli/report.hpp"

namespace tureen::cli {

namespace {

Specialisation specialisation_of(const std::string& name) {
  if (const auto known = specialisation_named(name)) return *known;
  std::vector<std::string> names;
  for (const SpecialisationName& known : specialisation_names()) names.emplace_back(known.name);
  throw unknown_word("--keep", name, names);
}

}  // namespace

void add_context_option(Command& command, gl::Backend& backend) {
  add_choice<gl::Backend>(command, "--context NAME", backend,
                          {{"auto", gl::Backend::automatic},
                           {"egl", gl::Backend::egl},
                           {"osmesa", gl::Backend::osmesa}},
                          "source of OpenGL: auto (default: EGL, else OSMesa), egl or osmesa");
}

Option add_splat_order(Command& command, std::function<void(Quality::SplatOrder)> set,
                       const std::string& help) {
  const auto choose = [set = std::move(set)](std::size_t index) {
    set(Quality::SplatOrder(index));
  };
  return add_word_option(command, "--splat-order NAME",
                         {splat_order_names.begin(), splat_order_names.end()}, choose, help);
}

void add_drawing_options(Command& command, DrawingOptions& options) {
  add_context_option(command, options.backend);
  add_choice<PipelineKind>(command, "--pipeline NAME", options.pipeline,
                           {{"auto", PipelineKind::tureen},
                            {"baseline", PipelineKind::baseline},
                            {"published", PipelineKind::baseline}},
                           "pipeline: auto (default, Tureen's own) or baseline (soups as in "
                           "DiffSoup's viewer, splats as instanced quads)");
  const Option no_specialise = command.add_flag(
      "--no-specialise", [&options] { options.plan.specialise = false; },
      "apply no specialisation: also draw and compute the parts that the scene does not need");
  command
      .add_option(
          "--keep NAMES",
          [&options](const std::vector<std::string>& names) {
            for (const std::string& name : names)
              options.plan.specialisations =
                  options.plan.specialisations.without(specialisation_of(name));
          },
          "do not apply these specialisations (keep the work that they skip): names from "
          "docs/specialisations.md, separated by commas, such as alpha-test,background")
      .comma_list()
      .excludes(no_specialise);
  add_choice<ShadingStage>(
      command, "--shading NAME", options.plan.shading_stage,
      {{"fragment", ShadingStage::fragment}, {"compute", ShadingStage::compute}},
      "shader of the shading pass, for scenes that have one: fragment (default) or compute");
  add_choice<SplatBlending>(command, "--blend NAME", options.plan.splat_blending,
                            {{"auto", SplatBlending::automatic},
                             {"raster", SplatBlending::raster},
                             {"tiles", SplatBlending::tiles}},
                            "blending of splats: raster (on the GPU), tiles (on the CPU), or auto "
                            "(default: tiles on software OpenGL, but not with --as-published)");
  add_splat_order(
      command, [&options](Quality::SplatOrder order) { options.splat_order = order; },
      "order of splats in a pixel; the scene's own by default. centre: by their centres. exact: "
      "along the pixel's ray, on the CPU, several times slower. stochastic: by their centres, "
      "without blending; noisy, but right as the mean of many samples");
  add_sampling_options(command, options);
}

void add_sampling_options(Command& command, DrawingOptions& options) {
  command.add_option(
      "--supersample N", options.supersampling,
      "N x N samples per pixel for smooth edges, 1 to 8; the scene's own number by default",
      between(1, 8));
  command.add_flag("--opaque", options.opaque,
                   "draw triangle windows as opaque triangles instead of blending them");
}

void add_drawing_scale(Command& command, DrawingOptions& options) {
  command
      .add_option("--scale S", options.resolution_scale,
                  "resolution scale: fraction of rows and columns drawn before enlarging, 0.25 to "
                  "1; below 1 is faster but blurred",
                  between(0.25, 1.0))
      .excludes(command.option("--supersample"));
}

void apply_opaque(Scene& scene, const DrawingOptions& options) {
  if (options.opaque) make_opaque(scene);
}

PlanPreferences preferences_for(const Scene& scene, const DrawingOptions& options) {
  PlanPreferences preferences = options.plan;
  const bool has_soup = std::any_of(
      scene.layers.begin(), scene.layers.end(),
      [](const Layer& layer) { return std::holds_alternative<TriangleSoup>(layer.primitives); });
  if (preferences.shading_stage != PlanPreferences{}.shading_stage && !has_soup)
    say("--shading has no effect: the scene has only splats");
  if (preferences.as_published && splat_count(scene) == 0)
    say("--as-published has no effect: the scene has no splats");
  if (preferences.splat_blending != SplatBlending::automatic && splat_count(scene) == 0)
    say("--blend has no effect: the scene has no splats");
  if (options.splat_order && splat_count(scene) == 0)
    say("--splat-order has no effect: the scene has no splats");
  else if (options.splat_order && options.pipeline == PipelineKind::baseline)
    say("--splat-order has no effect: the baseline blends in the order of the centres");
  Quality& quality = preferences.quality;
  quality = scene.quality;
  // Each of these options replaces both settings; they exclude each other.
  if (options.supersampling || options.resolution_scale) {
    quality.supersampling = options.supersampling.value_or(1);
    quality.resolution_scale = options.resolution_scale.value_or(1);
  }
  quality.splat_order = options.splat_order.value_or(quality.splat_order);
  return preferences;
}

}  // namespace tureen::cli
