// The passes that draw soups: a visibility pass that stores the visible fragments, and a shading
// pass that colours them; or one forward pass that writes colours.
#pragma once

#include "runtime/passes/device_soup.hpp"
#include "runtime/passes/pass.hpp"

namespace tureen {

/// Width and height of a work group in invocations: GROUP_SIDE of shading.comp.
inline constexpr int shading_group_side = 8;

/// Whether the visibility pass tests alpha.
enum class AlphaTest {
  as_planned,  // for faces that are not opaque
  never,       // rejected fragments are visible too
};

/// Stores the visible fragments of a soup, which must outlive the pass.
std::unique_ptr<Pass> make_visibility_pass(DeviceSoup& soup,
                                           AlphaTest test = AlphaTest::as_planned);

/// The passes of a soup by its plan and its place; the soup must outlive them.
struct SoupPasses {
  std::unique_ptr<Pass> faces;    // visibility or forward
  std::unique_ptr<Pass> shading;  // of a deferred plan; after `faces` of all soups
};
SoupPasses make_soup_passes(DeviceSoup& soup);

}  // namespace tureen
