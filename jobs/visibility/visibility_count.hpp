// Visible pixels of each face and texel over a list of views, and the selection of the most visible
// faces.
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

/// Visible pixels of each face over all views, one count a face. The Renderer identifies each
/// pixel's face exactly, so counts are the same on every run on one device. The context must be
/// current. `progress` is called with the fraction done, 0..1, and may throw. Throws the Renderer's
/// errors.
std::vector<std::uint64_t> count_visible_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress = {});

/// Pixels covered by the soup in each view, one count a view. The conditions are those of
/// count_visible_pixels.
std::vector<std::uint64_t> count_covered_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress = {});

/// Visibility of each texel over all views: the sum of its interpolation weights at pixel centres
/// (lattice::footprint). The sum over a face's texels is approximately its number of pixels. A
/// pixel is not counted if the device assigns it to a face but its centre lies outside the face's
/// exact edges. The soup must have a lattice texture. The other conditions are those of
/// count_visible_pixels.
std::vector<float> count_visible_texels(const gl::Context& context, const TriangleSoup& soup,
                                        glm::dvec3 origin, std::span<const Camera> views,
                                        const std::function<void(double)>& progress = {});

/// The most visible faces: 1 for each selected face, 0 for the others. Selects `fraction` (above 0,
/// at most 1) of all faces, rounded, at least one; faces with more pixels first, then the lower
/// index. A larger fraction selects a superset.
std::vector<std::uint8_t> most_visible(std::span<const std::uint64_t> pixels, double fraction);

}  // namespace tureen
