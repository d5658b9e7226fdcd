// Many runs of vertices in one call, if the context supports it.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Triangles from the bound vertex array: counts[i] vertices beginning at first[i], run by run.
void draw_runs(const Capabilities& capabilities, std::span<const std::int32_t> first,
               std::span<const std::int32_t> counts);

}  // namespace tureen::gl
