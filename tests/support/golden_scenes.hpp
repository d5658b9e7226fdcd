// Scenes of the approved images in tests/golden, for every way to draw them: natively
// (tests/runtime/golden_test.cpp) and in a browser (tests/web/goldens.test.mjs).
#pragma once

#include "scene/scene.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

/// A random soup of this kind over a bright background, with one camera of 320 x 240 pixels.
Scene golden_scene(Kind kind);

/// `example` with one camera of 160 x 120 pixels, over black. The view is close enough to
/// distinguish lattices and edges.
Scene golden_debug_view_scene(Scene example);

/// Index of the example's camera for its golden image, at 320 x 240.
inline constexpr std::size_t golden_example_camera = 40;

/// Two soups with different networks at different lattice levels, and a textured mesh between them.
/// The last layer is rotated, mirrored and scaled. One camera.
Scene layered_scene(std::uint64_t seed);

/// A ball of splats of each kernel, in front of and behind a soup. One camera.
Scene golden_splats();

/// The example, a textured mesh beside it, and the example again: turned, mirrored and smaller.
Scene golden_layers(Scene example);

}  // namespace tureen::test
