// A soup that is packed in the reading worker and unpacked for drawing has the same image and plan
// as a soup that was never packed, for every appearance.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/navigation.hpp"
#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/trait_soups.hpp"
#include "web/engine/arriving_scene.hpp"

namespace tureen::web {
namespace prepared_archive_test {

using Blobs = std::vector<std::vector<std::byte>>;

/// Copied in blocks of a few grains, as by a worker.
Blobs all_blobs(const PreparedScene& prepared) {
  Blobs blobs(blob_count(prepared));
  for (std::size_t blob = 0; blob < blobs.size(); ++blob) {
    blobs[blob].resize(blob_size(prepared, blob));
    const std::size_t block = 7 * blob_grain(prepared, blob);
    for (std::size_t offset = 0; offset < blobs[blob].size(); offset += block)
      read_blob(
          prepared, blob, offset,
          std::span(blobs[blob]).subspan(offset, std::min(block, blobs[blob].size() - offset)));
  }
  return blobs;
}

Camera camera_of(const TriangleSoup& soup) {
  const Bounds box = bounds(soup);
  return frame({.low = box.low, .high = box.high}, three_quarter_view, {320, 240});
}

class PreparedArchive : public testing::TestWithParam<test::Kind> {
 protected:
  static const gl::Context& context() {
    static const gl::Context one = gl::Context::create(test::osmesa);
    return one;
  }

  /// Draws with and without packing; expects equal bytes.
  static void expect_same(const TriangleSoup& soup, const RenderOptions& options) {
    const Camera camera = camera_of(soup);
    Renderer here = renderer_of(context(), soup, glm::dvec3(0.0), options);
    here.draw({camera});
    const Image8 expected = here.read_color();

    std::vector<std::byte> head;
    Blobs blobs;
    {
      // Destroyed before the drawing, with everything prepared from it.
      // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
      const TriangleSoup gone = soup;
      const PreparedScene prepared =
          prepare_scene(gone, glm::dvec3(0.0), device_limits(context().capabilities()), options);
      head = pack_head(prepared);
      blobs = all_blobs(prepared);
    }
    const BlobReader read = reader_of(blobs);
    for (const bool uploads_early : {false, true}) {
      SCOPED_TRACE(uploads_early);
      ArrivingScene arriving(head, read);
      if (uploads_early) upload_stores(arriving, head, blobs);
      Renderer there(context(), std::move(arriving).take(), options);
      there.draw({camera});
      EXPECT_EQ(there.read_color().pixels, expected.pixels);
      EXPECT_EQ(faces_of(there), faces_of(here));
      EXPECT_EQ(describe(there.plan()), describe(here.plan()));
      EXPECT_EQ(there.device_bytes(), here.device_bytes());
    }
  }

  static BlobReader reader_of(const Blobs& blobs) {
    return [&](std::size_t blob, std::uint64_t offset, std::span<std::byte> out) {
      ASSERT_LE(offset + out.size(), blobs[blob].size());
      std::copy_n(blobs[blob].begin() + std::ptrdiff_t(offset), out.size(), out.begin());
    };
  }

  /// In blocks of two rows. Then the blobs of the stores are worthless.
  static void upload_stores(ArrivingScene& arriving, std::span<const std::byte> head,
                            Blobs& blobs) {
    const BlobReader none;
    PreparedScene sizes = unpack(head, none);
    for (std::size_t blob = 0; blob < blobs.size(); ++blob) {
      if (!store_of(sizes, blob).source) continue;
      std::vector<std::byte>& bytes = blobs[blob];
      const std::size_t block = 2 * blob_grain(sizes, blob);
      for (std::size_t offset = 0; offset < bytes.size(); offset += block)
        arriving.upload(blob, offset,
                        std::span(bytes).subspan(offset, std::min(block, bytes.size() - offset)));
      std::fill(bytes.begin(), bytes.end(), std::byte{0xff});
    }
  }
};

TEST_P(PreparedArchive, DrawsAsIfItHadNotTravelled) {
  expect_same(test::random_soup(81, {.kind = GetParam(), .faces = 300, .degree = 2}), {});
}

TEST_P(PreparedArchive, NorWithNothingOmitted) {
  RenderOptions options;
  options.plan.specialise = false;
  expect_same(test::random_soup(82, {.kind = GetParam(), .faces = 100, .degree = 2}), options);
}

TEST_P(PreparedArchive, NorAtAnotherResolution) {
  RenderOptions options;
  options.plan.quality = {.resolution_scale = 0.5};
  expect_same(test::random_soup(85, {.kind = GetParam(), .faces = 100, .degree = 2}), options);
  options.plan.quality = {.supersampling = 2, .splat_order = Quality::SplatOrder::stochastic};
  expect_same(test::random_soup(85, {.kind = GetParam(), .faces = 100, .degree = 2}), options);
}

/// Blobs of every kind, in an order that a mistake would change.
TEST_F(PreparedArchive, DrawsAllLayersOfAScene) {
  Scene scene;
  const auto add = [&](Primitives primitives) {
    Layer& layer = scene.layers.emplace_back();
    layer.primitives = std::move(primitives);
    layer.name = std::to_string(scene.layers.size());
  };
  add(test::random_soup(83, {.kind = test::Kind::lattice_mlp, .faces = 80}));
  add(test::random_splats(test::splat_kinds[1], 50, 0.2, 1));
  add(test::random_soup(84, {.kind = test::Kind::uv_textures, .faces = 60}));
  add(test::random_splats(test::splat_kinds[1], 70, 0.1, 2));
  for (const SplatBlending blending : {SplatBlending::tiles, SplatBlending::raster}) {
    RenderOptions options;
    options.plan.splat_blending = blending;
    SCOPED_TRACE(blending == SplatBlending::tiles ? "tiles" : "raster");
    const Camera camera = test::camera_of_ball(3, 160, 120);
    const DeviceLimits limits = device_limits(context().capabilities());
    Renderer here(context(), prepare_scene(scene, limits, options), options);
    here.draw({camera});
    const Image8 expected = here.read_color();
    const PreparedScene prepared = prepare_scene(scene, limits, options);
    const std::vector<std::byte> head = pack_head(prepared);
    Blobs blobs = all_blobs(prepared);
    const BlobReader read = reader_of(blobs);
    ArrivingScene arriving(head, read);
    upload_stores(arriving, head, blobs);
    Renderer there(context(), std::move(arriving).take(), options);
    there.draw({camera});
    EXPECT_EQ(there.read_color().pixels, expected.pixels);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PreparedArchive, testing::ValuesIn(test::all_kinds),
                         [](const auto& each) { return test::to_string(each.param); });

}  // namespace prepared_archive_test
}  // namespace tureen::web
