#include "splatting/gaussians/gaussian_entries.hpp"

#include "splatting/ellipse.hpp"

namespace tureen::splatting {

void list_gaussian(const GaussianEntry& entry, float min_log_alpha, std::uint32_t splat,
                   TileLists& lists) {
  list_ellipse({.x = entry.x,
                .y = entry.y,
                .p = entry.p,
                .q = entry.q,
                .r = entry.r,
                .limit = entry.log_opacity - min_log_alpha,
                .half_width = entry.half_width,
                .half_height = entry.half_height},
               splat, lists);
}

}  // namespace tureen::splatting
