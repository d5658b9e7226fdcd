// Guarantees of the renderer: ties, devices that are too small, big soups in many layers, far
// origins.
#include "runtime/renderer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"
#include "scene/lattice.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {
namespace renderer_test {

Image8 draw(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
            const Camera& camera, const RenderOptions& options = {}) {
  Renderer renderer = renderer_of(context, soup, origin, options);
  renderer.draw({camera});
  return renderer.read_color();
}

TEST(Renderer, CoincidentFacesAreWonByTheLowerIndexWhateverTheirBuckets) {
  // Five copies of one triangle: the first is transparent, the second partly cut out, the third
  // opaque. The third shows in the second's holes, and the fourth and fifth never show.
  TriangleSoup soup;
  soup.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  soup.triangles.assign(5, glm::uvec3(0, 1, 2));
  LatticeTexture texture;
  std::vector<std::uint8_t> texels;
  const std::uint8_t alphas[5][3] = {
      {0, 0, 0}, {255, 0, 0}, {255, 255, 255}, {255, 255, 255}, {255, 0, 255}};
  for (std::uint32_t t = 0; t < 5; ++t) {
    texture.patches.push_back({3 * t, 0});
    for (int k = 0; k < 3; ++k) {
      const std::uint8_t shade = std::uint8_t(40 * (t + 1));
      texels.insert(texels.end(), {shade, shade, shade, 0, 0, 0, 0, alphas[t][k]});
    }
  }
  texture.texels = texels;
  soup.appearance = texture;
  const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 200, 200);
  const gl::Context context = gl::Context::create(osmesa);
  std::size_t seen[256] = {};
  for (const glm::u8vec4& pixel : draw(context, soup, {}, camera).pixels) ++seen[pixel.r];
  EXPECT_EQ(seen[40], 0u) << "transparent";
  EXPECT_GT(seen[80], 500u) << "cut out, but first";
  EXPECT_GT(seen[120], 500u) << "behind its holes";
  EXPECT_EQ(seen[160], 0u) << "later copies";
  EXPECT_EQ(seen[200], 0u) << "later copies";
}

TEST(Renderer, ASoupFarFromTheOriginLooksTheSame) {
  const gl::Context context = gl::Context::create(osmesa);
  const TriangleSoup soup = random_soup(5, {.kind = Kind::lattice_mlp});
  Random random(5);
  const Camera camera = random_camera(random, 320, 240);
  const Image8 expected = draw(context, soup, {}, camera);
  for (int exponent = 4; exponent <= 28; exponent += 6) {
    const glm::dvec3 offset = std::ldexp(1.0, exponent) * glm::dvec3(1, -1, 1);
    Camera moved = camera;
    moved.view_from_world[3] =
        glm::dvec4(glm::dmat3(camera.view_from_world) * -(camera.eye() + offset), 1.0);
    const Image8 image = draw(context, soup, offset, moved);
    std::size_t off = 0, off_by_more = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const glm::ivec4 difference =
          abs(glm::ivec4(image.pixels[i]) - glm::ivec4(expected.pixels[i]));
      const int largest = std::max({difference.r, difference.g, difference.b, difference.a});
      off += largest > 0;
      off_by_more += largest > 1;
    }
    // The camera's matrix is accurate to 2^-53 of the offset: 2^-25 units, 1e-5 pixels at 2^28.
    // That rounds some colours to the next step. At 2^28 this changes 50 pixels, and 20 to 66 with
    // seeds 6 to 16; the bound of one in a thousand is 76. At 2^22 it changes none, and at most 3
    // with those seeds.
    EXPECT_LE(off, exponent == 28 ? image.pixels.size() / 1000 : 9u) << "2^" << exponent;
    // Edges or alphas that fall to the other side: none here, at most one with other seeds.
    EXPECT_LE(off_by_more, 3u) << "2^" << exponent;
  }
}

// A stray face makes a scene large; this must not clip faces near an eye inside the scene.
TEST(Renderer, AStrayFaceFarAwayDoesNotClipWhatIsNear) {
  const gl::Context context = gl::Context::create(osmesa);
  ASSERT_TRUE(context.capabilities().clip_control);
  TriangleSoup soup;
  soup.positions = {{-9, -9, -1}, {9, -9, -1}, {0, 18, -1}, {9e4, 0, 0}, {9e4, 1, 0}, {9e4, 0, 1}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}};
  soup.appearance = FaceColors{{{1, 0, 0, 1}, {0, 1, 0, 1}}};
  const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.8, 16, 16);
  for (const glm::u8vec4& pixel : draw(context, soup, {}, camera).pixels)
    ASSERT_EQ(pixel, glm::u8vec4(255, 0, 0, 255));
}

// Alpha interpolated between three equal values must not be less, or the face has holes.
TEST(Renderer, AnAlphaOfOneHalfThroughoutHasNoHoles) {
  const gl::Context context = gl::Context::create(osmesa);
  RenderOptions generic;
  generic.plan.specialise = false;
  for (const Kind kind : {Kind::lattice, Kind::vertex_colors}) {
    TriangleSoup soup = random_soup(8, {.kind = kind, .level = 5, .float_texels = true});
    if (auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) {
      auto& texels = std::get<std::vector<float>>(texture->texels);
      for (std::size_t i = LatticeTexture::features; i < texels.size();
           i += LatticeTexture::channels)
        texels[i] = 0.5f;
    } else {
      for (glm::vec4& color : std::get<VertexColors>(soup.appearance).rgba) color.a = 0.5f;
    }
    Random random(8);
    const Camera camera = random_camera(random, 320, 240);
    const Image8 expected = draw(context, soup, {}, camera);
    const Image8 image = draw(context, soup, {}, camera, generic);
    EXPECT_EQ(image.pixels, expected.pixels) << to_string(kind);
  }
}

TEST(Renderer, AnImageTooLargeForTheDeviceIsRefused) {
  const gl::Context context = gl::Context::create(osmesa);
  Renderer renderer = renderer_of(context, random_soup(9, {.kind = Kind::lattice}), {});
  Random random(9);
  const int side = context.capabilities().max_image_side;
  ASSERT_GT(side, 0);
  EXPECT_THAT(
      error_of<DeviceLimitError>([&] { renderer.draw({random_camera(random, side + 1, 1)}); }),
      Names(std::to_string(side + 1) + "x1"));
  renderer.draw({random_camera(random, side, 1)});
  EXPECT_EQ(renderer.read_color().width, side);
}

// Other code that shares the context may change its state; runtime/renderer.hpp gives the limits.
TEST(Renderer, ForeignStateChangesNothing) {
  for (const gl::ContextRequest& request : {osmesa, egl_es30})
    for (const Kind kind : {Kind::lattice_mlp, Kind::face_colors}) {
      const gl::Context context = gl::Context::create(request);
      const TriangleSoup soup = random_soup(10, {.kind = kind});
      Random random(10);
      const Camera camera = random_camera(random, 64, 48);
      const Image8 expected = draw(context, soup, {}, camera);

      const auto disturb = [] {
        for (const GLenum capability :
             {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_RASTERIZER_DISCARD,
              GL_SAMPLE_ALPHA_TO_COVERAGE, GL_POLYGON_OFFSET_FILL})
          glEnable(capability);
        glScissor(0, 0, 1, 1);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
        glDepthMask(GL_FALSE);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 7);
        glPixelStorei(GL_UNPACK_SKIP_PIXELS, 1);
        glPixelStorei(GL_PACK_ROW_LENGTH, 100);
      };
      disturb();
      Renderer renderer = renderer_of(context, soup, {});
      disturb();
      renderer.draw({camera});
      disturb();
      EXPECT_EQ(renderer.read_color().pixels, expected.pixels) << to_string(kind);
    }
}

// leave_context() releases what the next draw creates again. Tests of the window switch between two
// contexts.
TEST(Renderer, DrawsTheSameAfterItLeftTheContext) {
  const gl::Context context = gl::Context::create(osmesa);
  const std::vector<PlanPreferences> plans = {
      {}, {.site = ShadingSite::forward}, {.quality = {.supersampling = 2}}};
  for (const PlanPreferences& plan : plans) {
    const TriangleSoup soup = random_soup(11, {.kind = Kind::lattice_mlp, .level = 2});
    Random random(11);
    const Camera camera = random_camera(random, 64, 48);
    Renderer renderer = renderer_of(context, soup, {}, {.plan = plan});
    renderer.draw({camera});
    const Image8 expected = renderer.read_color();
    renderer.leave_context();
    renderer.draw({camera});
    EXPECT_EQ(renderer.read_color().pixels, expected.pixels);
  }
}

TEST(Renderer, NamesTheSameFacesOnEs) {
  const TriangleSoup soup = random_soup(12, {.kind = Kind::lattice});
  Random random(12);
  const Camera camera = random_camera(random, 64, 48);
  std::vector<std::uint32_t> faces[2];
  for (int i = 0; i < 2; ++i) {
    const gl::Context context = gl::Context::create(i == 0 ? osmesa : egl_es30);
    Renderer renderer = renderer_of(context, soup, {});
    renderer.draw({camera});
    faces[i] = faces_of(renderer);
  }
  EXPECT_EQ(faces[0], faces[1]);
  EXPECT_NE(std::count(faces[0].begin(), faces[0].end(), no_face), std::ptrdiff_t(64 * 48));
}

/// A slanted face, z = x / 2 + 0.3, seen from (0.5, 0.2, 4).
TEST(Renderer, TellsThePointThatAPixelShows) {
  TriangleSoup soup;
  soup.positions = {{-1, -1, -0.2f}, {1, -1, 0.8f}, {0, 1, 0.3f}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1.0f)}};
  const glm::dvec3 origin(10, -20, 5);
  const Camera camera = look_at(origin + glm::dvec3(0.5, 0.2, 4), origin, {0, 1, 0}, 0.8, 160, 120);
  for (const NamedContext& named : every_context)
    for (const double scale : {1.0, 0.5}) {
      SCOPED_TRACE(named.name);
      const gl::Context context = gl::Context::create(named.request);
      RenderOptions options;
      options.plan.quality.resolution_scale = scale;
      Renderer renderer = renderer_of(context, soup, origin, options);
      renderer.draw({camera});
      EXPECT_EQ(renderer.point_at({1, 1}), std::nullopt) << "background";
      EXPECT_EQ(renderer.point_at({-1, 60}), std::nullopt) << "beside the image";
      // At a sample's centre; at half the resolution this is a pixel's corner.
      const glm::dvec2 place = scale == 1 ? glm::dvec2(84.5, 66.5) : glm::dvec2(85, 67);
      const auto point = renderer.point_at(place);
      ASSERT_TRUE(point);
      const glm::dvec3 local = *point - origin;
      // 24 bits of depth between about 3 and 5.5 have a step of about 1e-6, as do the corners'
      // floats.
      EXPECT_NEAR(local.z, 0.5 * local.x + 0.3, 1e-5);
      const glm::dvec4 seen = camera.view_from_world * glm::dvec4(*point, 1.0);
      EXPECT_NEAR(camera.cx - camera.fx * seen.x / seen.z, place.x, 1e-6);
      EXPECT_NEAR(camera.cy + camera.fy * seen.y / seen.z, place.y, 1e-6);
    }
}

TEST(Renderer, AlphaByTheTexelIsAlphaByTheCell) {
  Random random(77);
  const Camera camera = random_camera(random, 160, 120);
  for (const bool floats : {false, true})
    for (const int level : {-1, 4}) {
      const TriangleSoup soup = random_soup(
          77, {.kind = Kind::lattice_mlp, .faces = 300, .level = level, .float_texels = floats});
      const gl::Context context = gl::Context::create(osmesa);
      RenderOptions lean;
      lean.plan.max_alpha_cell_bytes = 1000;
      Renderer by_cell = renderer_of(context, soup, {});
      Renderer by_texel = renderer_of(context, soup, {}, lean);
      EXPECT_TRUE(by_cell.plan().soup(0).lattice.alpha_by_cell);
      ASSERT_FALSE(by_texel.plan().soup(0).lattice.alpha_by_cell);
      EXPECT_GT(by_texel.plan().soup(0).lattice.refused_alpha_cell_bytes, 1000u);
      EXPECT_LT(by_texel.device_bytes(), by_cell.device_bytes());
      by_cell.draw({camera});
      by_texel.draw({camera});
      EXPECT_EQ(faces_of(by_texel), faces_of(by_cell)) << "the same arithmetic on the same bytes";
    }
}

TEST(Renderer, TellsWhatItsTargetsTake) {
  const gl::Context context = gl::Context::create(osmesa);
  const TriangleSoup soup = random_soup(78, {.kind = Kind::lattice_mlp, .faces = 100, .level = 2});
  constexpr int width = 160, height = 120;
  // A pixel has 4 bytes of colour, 4 bytes of depth, and the intermediate targets.
  const std::pair<PlanPreferences, double> bytes_a_pixel[] = {
      {{.site = ShadingSite::forward}, 4 + 4},
      {{.site = ShadingSite::deferred}, 4 + 4 + 8},
      {{.site = ShadingSite::deferred, .quality = {.supersampling = 3}}, 9 * 16 + 4},
      {{.site = ShadingSite::deferred, .quality = {.resolution_scale = 0.5}}, 4 + 4},
  };
  for (const auto& [plan, each] : bytes_a_pixel) {
    SCOPED_TRACE(each);
    Renderer renderer = renderer_of(context, soup, {}, {.plan = plan});
    EXPECT_EQ(renderer.target_bytes(), 0u) << "no frame yet";
    renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, width, height)});
    EXPECT_EQ(double(renderer.target_bytes()), each * width * height);
  }
}

// A device with small textures needs more layers; the image must not change.
TEST(Renderer, SmallTexturesHoldTheSameScene) {
  const gl::Context context = gl::Context::create(osmesa);
  const Scene cloud = cutout_cloud({.triangles = 2000, .level = 5, .width = 320, .height = 180});
  const auto& soup = only_soup(cloud);
  const Image8 large = draw(context, soup, origin_of(only_layer(cloud)), cloud.cameras[0]);
  RenderOptions options;
  options.limits =
      DeviceLimits{.max_texture_size = 64, .max_array_layers = 2048, .clip_control = true};
  EXPECT_EQ(draw(context, soup, origin_of(only_layer(cloud)), cloud.cameras[0], options).pixels,
            large.pixels);
}

TEST(Renderer, ADeviceThatIsTooSmallGetsAForecast) {
  const gl::Context context = gl::Context::create(osmesa);
  const Scene cloud = cutout_cloud({.triangles = 200, .level = 5});
  RenderOptions options;
  options.limits =
      DeviceLimits{.max_texture_size = 64, .max_array_layers = 16, .clip_control = true};
  const auto refusal = error_of<DeviceLimitError>([&] {
    // NOLINTNEXTLINE(bugprone-unused-raii): the test is the construction
    renderer_of(context, only_soup(cloud), origin_of(only_layer(cloud)), options);
  });
  // 16 layers of 64 x 64 texels hold 65,536; a triangle has 561.
  EXPECT_THAT(refusal, Names(116));
}

TEST(Renderer, AnEmptySoupIsAllBackground) {
  const gl::Context context = gl::Context::create(osmesa);
  TriangleSoup soup;
  soup.appearance = FaceColors{};
  RenderOptions options;
  options.background = glm::vec4(0.2f, 0.4f, 0.6f, 0.0f);
  for (const bool specialise : {true, false}) {
    options.plan.specialise = specialise;
    const Image8 image =
        draw(context, soup, {}, look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 16), options);
    for (const glm::u8vec4& pixel : image.pixels) ASSERT_EQ(pixel, glm::u8vec4(51, 102, 153, 0));
  }
}

TEST(Renderer, TheTargetFollowsTheCamera) {
  const gl::Context context = gl::Context::create(osmesa);
  const TriangleSoup soup = random_soup(6, {.kind = Kind::lattice});
  Renderer renderer = renderer_of(context, soup, {});
  Random random(6);
  for (const auto& [width, height] : {std::pair{64, 48}, {33, 77}, {64, 48}}) {
    renderer.draw({random_camera(random, width, height)});
    EXPECT_EQ(renderer.read_color().width, width);
    EXPECT_EQ(faces_of(renderer).size(), std::size_t(width) * std::size_t(height));
  }
}

TEST(Context, NamesWhatWasTriedAndWhatToInstall) {
  // OSMesa has no ES contexts, so no machine can satisfy this request.
  EXPECT_THAT(error_of<ContextError>([] {
                gl::Context::create({.backend = gl::Backend::osmesa, .api = gl::Api::es});
              }),
              Names("OSMesa", "OpenGL ES", "apt-get install"));
}

TEST(Context, SeveralLiveSideBySide) {
  gl::Context first = gl::Context::create(osmesa);
  gl::Context second = gl::Context::create(egl_es30);
  const TriangleSoup soup = random_soup(7, {.kind = Kind::lattice_mlp});
  Random random(7);
  const Camera camera = random_camera(random, 160, 120);
  const Image8 on_second = draw(second, soup, {}, camera);
  first.make_current();
  EXPECT_EQ(draw(first, soup, {}, camera).pixels, on_second.pixels);
}

TEST(Context, DestroyingOneLeavesAnotherCurrent) {
  const TriangleSoup soup = random_soup(7, {.kind = Kind::face_colors});
  Random random(7);
  const Camera camera = random_camera(random, 64, 48);
  gl::Context reference = gl::Context::create(osmesa);
  const Image8 expected = draw(reference, soup, {}, camera);
  for (const NamedContext& kind : every_context) {
    gl::Context context = gl::Context::create(kind.request);
    context = gl::Context::create(kind.request);  // the first is destroyed after this
    EXPECT_EQ(draw(context, soup, {}, camera).pixels, expected.pixels) << kind.name;
  }
}

TEST(Context, AnExternalContextIsTakenOverAsItIs) {
  const gl::Context owner = gl::Context::create(egl_core33);
  const gl::Context external = gl::Context::external(owner.get_proc_address(), gl::Api::desktop);
  EXPECT_EQ(external.backend(), gl::Backend::external);
  EXPECT_EQ(external.capabilities().renderer, owner.capabilities().renderer);
}

}  // namespace renderer_test
}  // namespace tureen::test
