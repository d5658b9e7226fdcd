// The scenes that the approved images in tests/golden show, for every way to draw them: natively
// (tests/runtime/golden_test.cpp) and in a browser (tests/web/goldens.test.mjs).
#pragma once

#include "scene/scene.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

/// A random soup of this kind over a bright background; its one camera has 320 x 240 pixels.
Scene golden_scene(Kind kind);

/// A view of the example from near by, where lattices and edges can be told apart, over black:
/// `example` with one camera, of 160 x 120 pixels.
Scene golden_debug_view_scene(Scene example);

/// Of the example's cameras the one that its golden is drawn from, at 320 x 240.
inline constexpr std::size_t golden_example_camera = 40;

}  // namespace tureen::test
