// The search for a compressed file: it stays within its bounds and uses them.
#include "jobs/compress/compress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "formats/scene_file.hpp"
#include "runtime/renderer.hpp"
#include "scene/lattice.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen {
namespace compressed_test {

/// The first faces of the example, with some of its cameras at a fifth of their size.
Scene part_of_the_example(std::size_t faces, std::size_t cameras = 8) {
  Scene scene = read_scene(std::string(TUREEN_SOURCE_DIR) + "/examples/soup.glb");
  auto& soup = only_soup(scene);
  soup.triangles.resize(faces);
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  texture.patches.resize(faces);
  scene.cameras.resize(cameras);
  for (Camera& camera : scene.cameras)
    camera = resized(camera, camera.width / 5, camera.height / 5);
  return scene;
}

Scene with_cameras(Scene scene, std::vector<Camera> cameras) {
  scene.cameras = std::move(cameras);
  return scene;
}

/// The scene's own images, with every channel changed by `off`, up or down.
std::vector<Photograph> own_photographs(const Scene& scene, int off) {
  const gl::Context context = gl::Context::create({});
  Renderer renderer = renderer_of(context, only_soup(scene), origin_of(only_layer(scene)),
                                  {.background = {scene.info.background, 1.0f}});
  std::vector<Photograph> photographs;
  for (const Camera& camera : scene.cameras) {
    renderer.draw({camera});
    Image8 image = renderer.read_color();
    for (auto& pixel : image.pixels)
      for (int c = 0; c < 3; ++c)
        pixel[c] = std::uint8_t(pixel[c] < 128 ? pixel[c] + off : pixel[c] - off);
    photographs.push_back({camera, image});
  }
  return photographs;
}

TEST(Compress, KeepsWithinItsBoundAndUsesIt) {
  const Scene scene = part_of_the_example(500);
  const auto& soup = only_soup(scene);
  const CompressResult large = compress(scene, {.max_loss_db = 0.1});
  const CompressResult small = compress(scene, {.max_loss_db = 1});
  EXPECT_LE(large.loss.db, 0.1);
  EXPECT_LE(small.loss.db, 1);
  EXPECT_GT(large.loss.render_psnr_db, small.loss.render_psnr_db);
  // A step of the search is half a percent of the colour step, so the loss must exceed half of the
  // bound.
  EXPECT_GT(large.loss.db, 0.05);
  EXPECT_GT(small.loss.db, 0.5);
  EXPECT_LT(small.soup.texels.size(), large.soup.texels.size());
  EXPECT_LE(small.position_bits, large.position_bits);
  EXPECT_EQ(large.views, (CompressViews{.cameras = 8, .recorded = 8}));

  // The decoded file has exactly the reported loss.
  const gl::Context context = gl::Context::create({});
  const CompressJudge judge(context, scene, {});
  EXPECT_EQ(judge.loss(decode_compressed(small.soup, small.kept)).db, small.loss.db);
  EXPECT_EQ(judge.loss(soup).render_psnr_db, 100);
}

TEST(Compress, MeasuresAgainstPhotographsWhereThereAreSome) {
  const Scene scene = part_of_the_example(500);
  const CompressResult result =
      compress(scene, {.max_loss_db = 0.05, .photographs = own_photographs(scene, 40)});
  EXPECT_LE(result.loss.db, 0.05);
  EXPECT_EQ(result.views, CompressViews{.photographs = 8});
  // The photographs differ strongly from the scene, so a large loss hardly changes the error.
  EXPECT_LT(result.model_db, 30);
  EXPECT_LT(result.loss.render_psnr_db, 45);
}

Image8 with_upper_half(Image8 image, glm::u8vec4 color) {
  std::fill_n(image.pixels.begin(), image.pixels.size() / 2, color);
  return image;
}

TEST(Compress, MaskedPixelsAreNotJudged) {
  const Scene scene = part_of_the_example(500);
  const TriangleSoup& soup = only_soup(scene);
  std::vector<Photograph> photographs = own_photographs(scene, 20);
  const gl::Context context = gl::Context::create({});
  const CompressJudge whole(context, scene, photographs);
  // The upper half shows something else, which the masks exclude.
  for (Photograph& photograph : photographs) {
    const std::size_t half = photograph.image.pixels() / 2;
    std::vector<std::uint8_t> ignored(2 * half, 0);
    std::fill_n(ignored.begin(), half, std::uint8_t(1));
    photograph.ignored = std::move(ignored);
    photograph.image = with_upper_half(photograph.image(), {255, 0, 255, 255});
  }
  const CompressJudge masked(context, scene, photographs);
  // Each channel differs by 20.
  EXPECT_NEAR(masked.model_db(), whole.model_db(), 0.1);
  EXPECT_EQ(masked.loss(soup).db, 0);
  EXPECT_EQ(whole.loss(soup).db, 0);
  // Images of another soup differ from the model's there, too.
  const CompressedSoup coarse =
      encode_compressed(soup, {.position_bits = 20, .texels = {.alpha_step = 85}});
  const TriangleSoup other = decode_compressed(coarse, soup);
  const double loss = masked.loss(other).db;
  for (Photograph& photograph : photographs)
    photograph.image = with_upper_half(photograph.image(), {0, 255, 0, 255});
  EXPECT_EQ(CompressJudge(context, scene, photographs).loss(other).db, loss);
}

TEST(Compress, OmitsWhatNoViewSees) {
  Scene scene = part_of_the_example(300);
  auto& soup = only_soup(scene);
  // Three degenerate faces.
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  for (int i = 0; i < 3; ++i) {
    soup.triangles.push_back(glm::uvec3(soup.triangles[0].x));
    texture.patches.push_back(texture.patches[0]);
  }
  const CompressResult some = compress(scene, {.max_loss_db = 1});
  EXPECT_GE(some.unseen, 3u);
  EXPECT_EQ(some.kept.triangles.size() + some.unseen, 303u);
  EXPECT_EQ(some.seeing_views, 8u + 64u);
  const CompressResult all = compress(scene, {.max_loss_db = 1, .keep_unseen = true});
  EXPECT_EQ(all.unseen, 0u);
  EXPECT_EQ(all.kept.triangles, soup.triangles);
  // Without cameras, views of the scene are unknown.
  const auto photographs = own_photographs(scene, 8);
  scene.cameras.clear();
  EXPECT_EQ(compress(scene, {.max_loss_db = 1, .photographs = photographs}).unseen, 0u);
}

TEST(Compress, TexelsThatNoViewShowsTakeLittle) {
  Scene scene = part_of_the_example(300);
  const CompressResult before = compress(scene, {.max_loss_db = 0.1, .keep_unseen = true});
  EXPECT_EQ(before.weighing_views, 8u);
  // Behind the eyes of all cameras: a copy of the same faces.
  auto& soup = only_soup(scene);
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  std::size_t texels = 0;
  auto& bytes = std::get<std::vector<std::uint8_t>>(texture.texels);
  test::Random random(6);
  for (std::size_t t = 0; t < 300; ++t) {
    glm::uvec3 moved;
    for (int k = 0; k < 3; ++k) {
      moved[k] = std::uint32_t(soup.positions.size());
      soup.positions.push_back(soup.positions[soup.triangles[t][k]] + glm::vec3(0, 0, 100));
    }
    soup.triangles.push_back(moved);
    const LatticePatch patch = texture.patches[t];
    texture.patches.push_back(
        {std::uint32_t(bytes.size() / LatticeTexture::channels), patch.level});
    texels += lattice::texel_count(int(patch.level));
    // Noise, so that these texels are no copies; noise is also the most expensive to store.
    for (std::size_t i = 0; i < lattice::texel_count(int(patch.level)); ++i)
      for (int c = 0; c < LatticeTexture::channels; ++c)
        bytes.push_back(std::uint8_t(c == LatticeTexture::features ? 255 : random.below(256)));
  }
  const CompressResult after = compress(scene, {.max_loss_db = 0.1, .keep_unseen = true});
  EXPECT_GE(after.unseen_texels, before.unseen_texels + texels * 9 / 10);
  EXPECT_LE(after.loss.db, 0.1);
  // Noise in seven channels takes 7 bytes per texel if stored exactly.
  const double more = double(after.soup.texels.size()) - double(before.soup.texels.size());
  EXPECT_LT(more, 0.3 * 7 * double(texels));

  // With too few cameras, unseen texels are not assumed to be invisible.
  scene.cameras.resize(7);
  const CompressResult few = compress(scene, {.max_loss_db = 0.1, .keep_unseen = true});
  EXPECT_EQ(few.unseen_texels, 0u);
}

TEST(Compress, TrainingCamerasJoinTheRecordedOnes) {
  Scene scene = part_of_the_example(300);
  CompressRequest request{.max_loss_db = 0.1, .photographs = own_photographs(scene, 8)};
  request.training_cameras = scene.cameras;
  const CompressResult recorded = compress(scene, request);
  EXPECT_EQ(recorded.lent_cameras, 0u);
  EXPECT_GT(recorded.unseen_texels, 0u);
  scene.cameras.clear();
  const CompressResult lent = compress(scene, request);
  EXPECT_EQ(lent.lent_cameras, 8u);
  EXPECT_EQ(lent.soup.texels, recorded.soup.texels);
  EXPECT_EQ(lent.unseen_texels, recorded.unseen_texels);
  EXPECT_EQ(lent.unseen, recorded.unseen);
  EXPECT_EQ(lent.seeing_views, 8u + 64u);

  // Faces seen by the file's own camera must stay. This face is far from all others, and too small
  // for views of the whole scene.
  TriangleSoup& soup = only_soup(scene);
  const auto first = std::uint32_t(soup.positions.size());
  for (const glm::vec3 corner : {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)})
    soup.positions.push_back(0.02f * corner + glm::vec3(0, 0, -500));
  soup.triangles[0] = {first, first + 1, first + 2};
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  for (std::uint32_t i = 0; i < lattice::texel_count(int(texture.patches[0].level)); ++i)
    std::get<std::vector<std::uint8_t>>(
        texture.texels)[(texture.patches[0].first_texel + i) * LatticeTexture::channels +
                        LatticeTexture::features] = 255;
  request.photographs = own_photographs(with_cameras(scene, request.training_cameras), 8);
  const CompressResult without = compress(scene, request);
  const glm::dvec3 eye = origin_of(only_layer(scene)) + glm::dvec3(0, 0, -499.9);
  scene.cameras = {look_at(eye, eye - glm::dvec3(0, 0, 0.1), {0, 1, 0}, 0.7, 64, 48)};
  const CompressResult with = compress(scene, request);
  EXPECT_EQ(with.lent_cameras, 8u);
  EXPECT_EQ(with.seeing_views, 9u + 64u);
  EXPECT_EQ(with.unseen, without.unseen - 1);
}

TEST(ThoroughCompress, TrainingCamerasThatSeeNothingOrTooFewDoNotJoin) {
  const Scene all = part_of_the_example(300);
  const Scene scene = with_cameras(all, {all.cameras[0]});
  CompressRequest request{.max_loss_db = 0.1, .photographs = own_photographs(all, 8)};
  request.training_cameras = all.cameras;
  const Camera blind = look_at({0, 0, 50}, {0, 0, 100}, {0, 1, 0}, 0.7, 64, 48);
  request.training_cameras.push_back(blind);
  EXPECT_EQ(compress(scene, request).lent_cameras, 8u);
  request.training_cameras[0] = blind;
  const CompressResult few = compress(scene, request);
  EXPECT_EQ(few.lent_cameras, 0u);
  EXPECT_EQ(few.unseen_texels, 0u);
  EXPECT_EQ(few.unseen, 0u);
  request.training_cameras.resize(7);
  EXPECT_EQ(compress(scene, request).lent_cameras, 0u);
}

TEST(Compress, PhotographsOfAnotherSceneAreRefused) {
  const Scene scene = part_of_the_example(300);
  const CompressRequest request{.max_loss_db = 0.1, .photographs = own_photographs(scene, 127)};
  EXPECT_THROW(compress(scene, request), UsageError);
}

// A camera that sees nothing of the scene must not make its loss 0.
TEST(ThoroughCompress, OneCameraDoesNotSpeakForAll) {
  Scene scene = part_of_the_example(100, 1);
  scene.cameras[0] = look_at({0, 0, 50}, {0, 0, 100}, {0, 1, 0}, 0.7, 64, 48);
  const CompressResult result = compress(scene, {.max_loss_db = 0.1});
  EXPECT_EQ(result.views, (CompressViews{.cameras = 1, .recorded = 1, .around = 23}));
  EXPECT_EQ(result.unseen, 0u);
  EXPECT_EQ(result.seeing_views, 0u);
  EXPECT_EQ(result.unseen_texels, 0u);
  EXPECT_GT(result.loss.render_psnr_db, 40);
  EXPECT_LT(result.loss.render_psnr_db, 60) << "some view must see the scene";
}

TEST(Compress, FacesOfOneColorHaveOneTexelACorner) {
  Scene scene = part_of_the_example(40);
  auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  constexpr std::size_t channels = LatticeTexture::channels;
  const std::size_t plain = 20;
  std::vector<std::uint32_t> level;
  for (std::size_t t = 0; t < texture.patches.size(); ++t) {
    const LatticePatch& patch = texture.patches[t];
    ASSERT_GT(patch.level, 0u);
    level.push_back(t < plain ? 0 : patch.level);
    const auto first = texels.begin() + std::ptrdiff_t(patch.first_texel * channels);
    for (std::size_t i = 0; t < plain && i < lattice::texel_count(int(patch.level)); ++i)
      std::copy_n(first, channels, first + std::ptrdiff_t(i * channels));
  }
  const CompressResult result = compress(scene, {.max_loss_db = 0.1, .keep_unseen = true});
  const TriangleSoup decoded = decode_compressed(result.soup, result.kept);
  for (std::size_t t = 0; t < level.size(); ++t)
    EXPECT_EQ(std::get<LatticeTexture>(decoded.appearance).patches[t].level, level[t]) << t;
  EXPECT_LE(result.loss.db, 0.1);
}

// As before training: edges lie anywhere, and coarse alphas move them all.
TEST(Compress, AlphasAroundTheThresholdHaveFinerSteps) {
  Scene scene = part_of_the_example(200);
  auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  test::Random random(5);
  for (std::size_t i = LatticeTexture::features; i < texels.size(); i += LatticeTexture::channels)
    texels[i] = std::uint8_t(118 + random.below(20));
  const auto& soup = only_soup(scene);
  const gl::Context context = gl::Context::create({});
  const CompressedSoup coarse =
      encode_compressed(soup, {.position_bits = 20, .texels = {.alpha_step = 85}});
  EXPECT_GT(CompressJudge(context, scene, {}).loss(decode_compressed(coarse, soup)).db, 0.1);
  EXPECT_LE(compress(scene, {.max_loss_db = 0.1}).loss.db, 0.1);
}

TEST(Compress, RefusesWhatItCannotHold) {
  Scene scene = part_of_the_example(2);
  only_soup(scene).appearance = FaceColors{{glm::vec4(1), glm::vec4(1)}};
  EXPECT_THAT(test::error_of<UsageError>([&] { compress(scene, {}); }),
              test::ErrorAt("", appearance_name(FaceColors{})));
}

TEST(Compress, ViewsAreRecordedCamerasOrAround) {
  Scene scene = part_of_the_example(2);
  EXPECT_EQ(compress_views(scene, scene.cameras, 2).size(), 2u);
  EXPECT_EQ(compress_views(scene, scene.cameras, 9).size(), 8u);
  scene.cameras[0] = resized(scene.cameras[0], 4000, 2000);
  EXPECT_EQ(compress_views(scene, scene.cameras, 1)[0].width, 800);
  EXPECT_EQ(compress_views(scene, scene.cameras, 1)[0].height, 400);
  // Too few cameras: views around the scene are added.
  scene.cameras.resize(7);
  EXPECT_EQ(compress_views(scene, scene.cameras, 5).size(), 5u);
  EXPECT_EQ(compress_views(scene, scene.cameras, 9).size(), 9u);
  EXPECT_EQ(compress_views(scene, scene.cameras, 9)[6].name, scene.cameras[6].name);
  EXPECT_EQ(compress_views(scene, scene.cameras, 9)[7].name, "hemisphere 0");
  EXPECT_EQ(compress_views(scene, scene.cameras, 200).size(), 7u + 64u);
  scene.cameras.clear();
  EXPECT_EQ(compress_views(scene, scene.cameras, 9).size(), 9u);
  EXPECT_EQ(compress_views(scene, scene.cameras, 200).size(), 64u);
}

}  // namespace compressed_test
}  // namespace tureen
