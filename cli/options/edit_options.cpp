#include "cli/options/edit_options.hpp"

#include "cli/options/drawing_options.hpp"

namespace tureen::cli {

void add_edit_options(Command& command, Edits& edits) {
  command.add_option("--lattice-level L", edits.lattice_level,
                     "finest lattice level, 0 to 7; finer textures are projected to it",
                     between(0, lattice::max_level));
  add_choice<Edits::Color>(command, "--color NAME", edits.color,
                           {{"network", Edits::Color::network},
                            {"baked", Edits::Color::baked},
                            {"base", Edits::Color::base}},
                           "conversion from texels to colour: network (default, the scene's color "
                           "MLP), baked (its mean over all directions) or base (features 0 to 2 "
                           "alone)");
  add_choice<bool>(command, "--texel-bits N", edits.byte_texels, {{"32", false}, {"8", true}},
                   "largest number of bits per texel channel: 32 (default, as stored) or 8");
}

void QualityOptions::apply_to(Quality& quality) const {
  const Quality::SplatOrder order = splat_order.value_or(quality.splat_order);
  if (sampling) quality = *sampling;
  quality.splat_order = order;
}

void add_quality_options(Command& command, QualityOptions& quality) {
  const Option samples = command.add_option(
      "--supersample N",
      [&quality](const std::string& text) {
        quality.sampling = Quality{.supersampling = int(*number_from(text))};
      },
      "quality setting stored in OUT: N x N samples per pixel, 1 to 8", between(1, 8));
  command
      .add_option(
          "--resolution-scale S",
          [&quality](const std::string& text) {
            quality.sampling = Quality{.resolution_scale = *number_from(text)};
          },
          "quality setting stored in OUT: fraction of rows and columns to draw, 0.25 to 1",
          between(0.25, 1.0))
      .excludes(samples);
  add_splat_order(
      command, [&quality](Quality::SplatOrder order) { quality.splat_order = order; },
      "quality setting stored in OUT: order of splats, centre, exact or stochastic");
}

}  // namespace tureen::cli
