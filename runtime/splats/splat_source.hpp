// Splats before a device exists: the contents of their texel stores and their centres.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "runtime/passes/texel_store.hpp"
#include "runtime/plan/splat_plan.hpp"
#include "scene/splats.hpp"
#include "splatting/layer.hpp"

namespace tureen {

struct SplatSource {
  TexelLayout layout;              // of both stores
  TexelSource kernel;              // texel_rows / 4 RGBA texels a drawn splat
  TexelSource coefficients;        // harmonics::count(degree) RGB texels a colour of a drawn splat
  std::vector<glm::vec3> centers;  // of the drawn splats, in layer coordinates
};

/// The sources read the splats and plan.drawn. Both must outlive them without moving; the plan
/// object itself may be moved. Throws DeviceLimitError.
SplatSource prepare_splats(const Splats& splats, const SplatPlan& plan, const TexelLayout& layout);
/// The same from the rows of a layer for TilePass, which must outlive the sources.
SplatSource prepare_splats(const splatting::LayerData& layer, const TexelLayout& layout);

}  // namespace tureen
