#include "cli/drawing_options.hpp"

#include "cli/choice.hpp"

namespace tureen::cli {

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
  command.add_flag_callback(
      "--no-specialise", [&options] { options.plan.specialise = false; },
      "leave nothing out that the scene does not need (for comparisons)");
}

}  // namespace tureen::cli
