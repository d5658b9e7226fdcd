#include "cli/drawing_options.hpp"

#include <algorithm>
#include <array>

#include "cli/choice.hpp"
#include "cli/number_range.hpp"

namespace tureen::cli {

namespace {

Specialisation named(const std::string& name) {
  if (const auto known = specialisation_named(name)) return *known;
  constexpr std::array removed{"transparent-rims", "base-color", "texel-table"};
  if (std::find(removed.begin(), removed.end(), name) != removed.end())
    throw UsageError("--keep no longer takes '" + name + "', a specialisation that was removed",
                     "delete the name");
  std::vector<std::string> names;
  std::string list;
  for (const SpecialisationName& known : specialisation_names()) {
    list += (names.empty() ? "" : ", ") + std::string(known.name);
    names.emplace_back(known.name);
  }
  throw UsageError("--keep takes " + list + ", not '" + name + "'", did_you_mean(name, names));
}

}  // namespace

void add_drawing_options(CLI::App& command, DrawingOptions& options) {
  add_choice<gl::Backend>(command, "--context", options.backend,
                          {{"auto", gl::Backend::automatic},
                           {"egl", gl::Backend::egl},
                           {"osmesa", gl::Backend::osmesa}},
                          "where OpenGL comes from: auto (EGL, else OSMesa), egl or osmesa")
      ->option_text("NAME");
  add_choice<PipelineKind>(
      command, "--pipeline", options.plan.pipeline,
      {{"auto", PipelineKind::tureen}, {"published", PipelineKind::published}},
      "auto (our own), or published: drawn as DiffSoup's viewer draws, the baseline")
      ->option_text("NAME");
  CLI::Option* no_specialise = command.add_flag_callback(
      "--no-specialise", [&options] { options.plan.specialise = false; },
      "apply no specialisation: draw and compute also what the scene does not need");
  command
      .add_option_function<std::vector<std::string>>(
          "--keep",
          [&options](const std::vector<std::string>& names) {
            for (const std::string& name : names)
              options.plan.specialisations = options.plan.specialisations.without(named(name));
          },
          "do not apply these specialisations: names from "
          "docs/leaving-out.md with commas between, as alpha-test,background")
      ->option_text("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes(no_specialise);
  add_choice<ShadingStage>(
      command, "--shading", options.plan.shading_stage,
      {{"fragment", ShadingStage::fragment}, {"compute", ShadingStage::compute}},
      "shader that colours the pixels of scenes that are shaded once a pixel: fragment (default) "
      "or compute",
      {{"measured", "use fragment, the default, or compute"}})
      ->option_text("NAME");
  CLI::Option* supersample = command.add_option_function<int>(
      "--supersample", [&options](int n) { options.quality = Quality{.supersampling = n}; },
      "smooth edges: N x N samples a pixel, 1 to 8; costs N x N times the pixels; the scene's own "
      "number by default");
  supersample->check(between(1, 8))->option_text("N");
}

void add_drawing_scale(CLI::App& command, DrawingOptions& options) {
  command
      .add_option_function<double>(
          "--scale",
          [&options](double scale) { options.quality = Quality{.resolution_scale = scale}; },
          "faster and blurred: draw S of the rows and columns, 0.25 to 1, and enlarge")
      ->check(between(0.25, 1.0))
      ->excludes(command.get_option("--supersample"))
      ->option_text("S");
}

PlanPreferences preferences_for(const Scene& scene, const DrawingOptions& options) {
  PlanPreferences preferences = options.plan;
  preferences.quality = options.quality.value_or(scene.quality);
  return preferences;
}

}  // namespace tureen::cli
