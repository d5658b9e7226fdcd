// How much of each face and texel a list of views shows, and which faces that makes worth drawing.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Pixels of each face over all views, one count a face. They are those that the Renderer shows,
/// every pixel named exactly by its face; the same on every run of one device. The context must be
/// current. `progress` is called with the fraction done, 0..1, and may throw. Throws what the
/// Renderer throws.
std::vector<std::uint64_t> count_visible_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress = {});

/// Pixels that each view shows of the soup, one count a view; otherwise as above.
std::vector<std::uint64_t> count_covered_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress = {});

/// How often each texel shows over all views: the sum of the weights with which pixels' centres
/// take it (lattice::footprint). A face's texels come to about its pixels: those whose centre the
/// device finds in a face that exact edges do not are left out. The soup has a lattice texture;
/// otherwise as above.
std::vector<float> count_visible_texels(const gl::Context& context, const TriangleSoup& soup,
                                        glm::dvec3 origin, std::span<const Camera> views,
                                        const std::function<void(double)>& progress = {});

/// The most visible part of the faces: 1 for each that belongs to it, 0 for the others. Of all
/// faces `fraction` (above 0, at most 1), rounded, and at least one; faces with more pixels first,
/// of equal ones the lower index. A larger fraction keeps what a smaller one keeps.
std::vector<std::uint8_t> most_visible(std::span<const std::uint64_t> pixels, double fraction);

/// The soup of these faces alone, in their order.
TriangleSoup keep_most_visible(const TriangleSoup& soup, std::span<const std::uint64_t> pixels,
                               double fraction);

}  // namespace tureen
