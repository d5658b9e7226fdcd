// Constants shared by the writer and the reader of TUREEN_triangle_soup: names of enumerators and
// the size of a strip. docs/format.md is the specification.
#pragma once

#include <cstdint>

#include "formats/glb/component_types.hpp"

namespace tureen::glb_layout {

/// The glTF extension by which a node, and so a layer, is hidden. Ratified by Khronos.
inline constexpr const char visibility_extension[] = "KHR_node_visibility";

/// The glTF extension of Gaussian splats, ratified by Khronos, and ours within it.
inline constexpr const char splatting_extension[] = "KHR_gaussian_splatting";
inline constexpr const char splats_extension[] = "TUREEN_splats";

// A strip of lattice texels is two images of the same size, filled row by row. Its maximum size is
// 8 MiB decoded; a streaming reader holds at most one strip.
inline constexpr std::uint32_t strip_width = 1024;
inline constexpr std::uint32_t strip_rows = 1024;
inline constexpr std::uint32_t strip_texels = strip_width * strip_rows;

// Names of enumerations, in the order of their enumerators.
inline constexpr const char* domains[] = {"face", "vertex"};
inline constexpr const char* wraps[] = {"repeat", "mirror", "clamp"};
inline constexpr const char* filters[] = {"nearest", "linear"};
inline constexpr const char* splat_projections[] = {"ewa", "plane"};
inline constexpr const char* splat_low_passes[] = {"none", "dilation", "mip", "screen"};
inline constexpr const char* colors[] = {"network", "harmonics", "base"};
inline constexpr const char* sites[] = {"automatic", "deferred", "forward"};

}  // namespace tureen::glb_layout
