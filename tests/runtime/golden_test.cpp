// Approved images of small soups with every appearance, in every context. Most goldens use the
// ordinary depth range, so that contexts with and without clip control agree; one golden has
// reversed depth.
#include "tests/support/golden.hpp"

#include <gtest/gtest.h>

#include "formats/scene_file.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/debug_view_renderer.hpp"
#include "tests/support/golden_scenes.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {
namespace golden_test {

Image8 draw_golden(const gl::ContextRequest& request, Kind kind, RenderOptions options) {
  const gl::Context context = gl::Context::create(request);
  const Scene scene = golden_scene(kind);
  options.background = glm::vec4(scene.info.background, 1.0f);
  Renderer renderer = renderer_of(context, only_soup(scene), origin_of(only_layer(scene)), options);
  renderer.draw({scene.cameras.at(0)});
  return renderer.read_color();
}

struct Golden {
  NamedContext context;
  Kind kind;
};

class Goldens : public testing::TestWithParam<Golden> {};

TEST_P(Goldens, Appearance) {
  RenderOptions options;
  options.plan.reversed_depth = false;
  const bool is_reference = GetParam().context.request.backend == gl::Backend::osmesa;
  expect_golden(draw_golden(GetParam().context.request, GetParam().kind, options),
                to_string(GetParam().kind), is_reference ? "" : GetParam().context.name);
}

std::vector<Golden> all_goldens() {
  std::vector<Golden> all;
  for (const NamedContext& context : every_context)
    for (const Kind kind : all_kinds) all.push_back({context, kind});
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Goldens, testing::ValuesIn(all_goldens()), [](const auto& test) {
  return to_string(test.param.kind) + "_" + test.param.context.name;
});

TEST(Golden, ReversedDepth) {
  expect_golden(draw_golden(osmesa, Kind::lattice_mlp, {}), "reversed_depth");
}

// Covers the reader, the conventions of axes and view direction, and the network for a real scene.
// An upside-down, mirrored or dull image would agree with an oracle that shares the mistake.
TEST(Golden, Example) {
  const Scene scene = read_scene(std::string(TUREEN_SOURCE_DIR) + "/examples/soup.glb");
  const gl::Context context = gl::Context::create(osmesa);
  RenderOptions options;
  options.plan.reversed_depth = false;
  options.background = glm::vec4(scene.info.background, 1.0f);
  Renderer renderer = renderer_of(context, only_soup(scene), origin_of(only_layer(scene)), options);
  renderer.draw({resized(scene.cameras.at(golden_example_camera), 320, 240)});
  expect_golden(renderer.read_color(), "example");
}

// A close-up of the example in each debug view. Shows mistakes that the oracle could share: colours
// without information, interrupted lines.
TEST(Golden, DebugViews) {
  const Scene scene =
      golden_debug_view_scene(read_scene(std::string(TUREEN_SOURCE_DIR) + "/examples/soup.glb"));
  for (const NamedContext& named : every_context) {
    const gl::Context context = gl::Context::create(named.request);
    DebugViewRenderer debug_renderer(
        context, only_soup(scene), origin_of(only_layer(scene)),
        {.plan = {.reversed_depth = false}, .background = glm::vec4(scene.info.background, 1.0f)});
    const bool is_reference = named.request.backend == gl::Backend::osmesa;
    for (const DebugViewName& name : debug_view_names()) {
      // Of a soup, the median depth is the depth.
      if (why_not(name.what, only_soup(scene)) || name.what == DebugView::median_depth) continue;
      debug_renderer.show(name.what, {4, 3});
      debug_renderer.renderer().draw({scene.cameras.at(0)});
      expect_golden(debug_renderer.renderer().read_color(), std::string("debug_view_") + name.name,
                    is_reference ? "" : named.name);
    }
  }
}

TEST(Golden, WithoutSpecialisation) {
  RenderOptions options;
  options.plan.specialise = false;
  options.plan.reversed_depth = false;
  expect_golden(draw_golden(osmesa, Kind::lattice_mlp, options), to_string(Kind::lattice_mlp),
                "without_specialisation");
}

// The visibility buffer rounds barycentrics to 16 bits. At level 7, with noise as texels, this
// moves a sample by 1/512 of the distance between texels, at most half a step of a colour.
TEST(Golden, ForwardAndDeferredAgree) {
  for (const Kind kind : {Kind::face_colors, Kind::uv_textures, Kind::lattice_mlp}) {
    RenderOptions options;
    options.plan.site = ShadingSite::forward;
    const Image8 forward = draw_golden(osmesa, kind, options);
    options.plan.site = ShadingSite::deferred;
    const Image8 deferred = draw_golden(osmesa, kind, options);
    for (std::size_t i = 0; i < forward.pixels.size(); ++i)
      for (int c = 0; c < 4; ++c)
        ASSERT_LE(std::abs(int(forward.pixels[i][c]) - int(deferred.pixels[i][c])), 1)
            << to_string(kind) << ", pixel " << i;
  }
}

}  // namespace golden_test
}  // namespace tureen::test
