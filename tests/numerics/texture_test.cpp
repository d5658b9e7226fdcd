// Texture, opacity and 8-bit values: cases T1 to T9.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "image/png.hpp"
#include "image/quantise.hpp"
#include "image/srgb.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/renderer.hpp"
#include "scene/lattice.hpp"
#include "tests/numerics/half_network.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/shader_probe.hpp"
#include "trainer/common/kernels/scalar.hpp"

namespace tureen::test {

namespace texture_test {

/// A number that is rounded to a half after every operation.
struct Half {
  float value;
  Half(float v) : value(rounded_to_half(v)) {}
  friend Half operator+(Half a, Half b) { return a.value + b.value; }
  friend Half operator/(Half a, Half b) { return a.value / b.value; }
  friend Half operator-(Half a) { return -a.value; }
};

Half exponential(Half x) { return std::exp(x.value); }

constexpr double infinity = std::numeric_limits<double>::infinity();

gl::Api api() { return shared_context().capabilities().api; }

// -- T1, T2 -------------------------------------------------------------------------------------

/// Distance of a sample outside the range of its texels: from negative weights and from their sum.
double excess(double a, double b, double c) {
  if (std::isnan(a + b + c)) return infinity;
  return std::max({0.0, -a, -b, -c}) + std::max(0.0, a + b + c - 1);
}

TEST(Numerics, T1_SamplesAtTheEdgeOfAFaceStayWithinItsTexels) {
  Recorder recorder({.stressed =
                         "barycentrics on a face's edge, or beyond by rounding (lattice.hpp) "
                         "and by 0.3 (lattice.glsl)",
                     .parameter = "texels along a side",
                     .unit = "distance of a sample outside its texels' range / range",
                     .naive = "sampling at the interpolated point, without clamping"});
  Random random(1);
  std::vector<glm::vec2> edge = {{1, 0}, {0, 1}, {0, 0}};
  for (int i = 0; i < 400; ++i) {
    const auto t = float(random.uniform());
    const auto along = float(random.uniform());
    edge.insert(edge.end(), {{t, 1 - t}, {along, 0}, {0, along}});
  }
  std::vector<glm::vec4> beyond;
  for (const glm::vec2& b : edge) {
    const float step = std::nextafter(1.0f, 2.0f);
    for (const glm::vec2 moved : {b, b * step, b - 1e-7f, b + 1e-7f, b - 0.3f, b + 0.3f})
      beyond.emplace_back(moved, 0, 0);
  }
  for (int level = 0; level <= lattice::max_level; ++level) {
    const auto count = lattice::texel_count(level);
    double ours = 0, naive = 0;
    for (const glm::vec2& b : edge) {
      const auto at = lattice::footprint(level, b.x, b.y);
      for (const std::uint32_t texel : at.texels) ASSERT_LT(texel, count);
      ours = worse(ours, excess(at.weights[0], at.weights[1], at.weights[2]));
    }
    const std::string head =
        "#include \"lattice.glsl\"\n#include \"simplex.glsl\"\n"
        "vec4 probe(vec4 x) { LatticeFootprint at = lattice_footprint(" +
        std::to_string(level) + ", clamped_to_simplex(x.xy)); ";
    const auto texels = Probe(api(), head + "return vec4(vec3(at.texels), 0.0); }", {}).run(beyond);
    const auto weights = Probe(api(), head + "return vec4(at.weights, 0.0); }", {}).run(beyond);
    for (std::size_t i = 0; i < beyond.size(); ++i) {
      for (int k = 0; k < 3; ++k) ASSERT_LT(texels[i][k], float(count));
      ours = worse(ours, excess(weights[i].x, weights[i].y, weights[i].z));
      const auto at = lattice::footprint(level, beyond[i].x, beyond[i].y);
      naive = worse(naive, excess(at.weights[0], at.weights[1], at.weights[2]));
    }
    // Both coordinates, of up to n texels, are rounded. Before, the clamp rounds their sum, its
    // inverse and a product. The catalogue measured 2 n epsilon without the clamp.
    const double n = lattice::resolution(level);
    recorder.add({.at = n, .naive = naive, .ours = ours, .tolerance = (2 + 3) * n * epsilon});
  }
}

TEST(Numerics, T2_NoCoordinateLeavesTheLattice) {
  Recorder recorder({.stressed =
                         "barycentrics that are huge, negative or not a number: lattice.hpp and "
                         "lattice.glsl",
                     .parameter = "size of the barycentrics",
                     .unit = "texels outside of the lattice, of 1000 points",
                     .naive = "coordinates rounded down to unsigned integers"});
  Random random(2);
  constexpr int level = 5;
  const auto count = lattice::texel_count(level);
  for (const double size : {1.0, 1e3, 1e9, 1e30, infinity}) {
    std::vector<glm::vec4> points;
    for (int i = 0; i < 1000; ++i)
      points.emplace_back(size * random.uniform(-1, 1), size * random.uniform(-1, 1), 0, 0);
    if (size == infinity) points[0].x = std::numeric_limits<float>::quiet_NaN();
    const auto on_device =
        Probe(api(),
              "#include \"lattice.glsl\"\n"
              "vec4 probe(vec4 x) { return vec4(vec3(lattice_footprint(5, x.xy).texels), 0.0); }",
              {})
            .run(points);
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto at = lattice::footprint(level, points[i].x, points[i].y);
      const auto cell = [&](float b) {
        // The result of casting a negative float on most machines; it is undefined.
        const double value = std::floor(double(b) * 32);
        return std::abs(value) < 9e18 ? std::uint32_t(std::int64_t(value)) : 0x80000000u;
      };
      const std::uint64_t x = cell(points[i].x), y = cell(points[i].y);
      bool outside = false, outside_on_device = false;
      for (int k = 0; k < 3; ++k) {
        outside = outside || at.texels[std::size_t(k)] >= count;
        outside_on_device =
            outside_on_device || !(on_device[i][k] >= 0 && on_device[i][k] < float(count));
      }
      ours += outside + outside_on_device;
      naive += x + y >= 32;
    }
    recorder.add({.at = std::min(size, 3.4e38), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

// -- T3 -----------------------------------------------------------------------------------------

TEST(Numerics, T3_BytesKeepTheSideOfTheThreshold) {
  Recorder recorder({.stressed =
                         "alpha stored in 8 bits: (1) sigmoids of logits in -8 .. 8, (2) of "
                         "logits about -6 and 6, (3) exactly one half",
                     .parameter = "distribution",
                     .unit = "fraction of texels that change sides",
                     .naive = "truncation",
                     .naive_fails_from = 1});
  Recorder bias({.stressed = "the same: distance of the stored value from the exact one",
                 .parameter = "distribution",
                 .unit = "steps of 8 bits",
                 .naive = "truncation"});
  Random random(3);
  constexpr int texels = 1'000'000;
  for (const int distribution : {1, 2, 3}) {
    double ours = 0, naive = 0, ours_off = 0, naive_off = 0, ours_mean = 0, naive_mean = 0;
    for (int i = 0; i < texels; ++i) {
      const double logit = distribution == 1   ? random.uniform(-8, 8)
                           : distribution == 2 ? (random.chance(0.5) ? -6 : 6) + 2 * random.normal()
                                               : 0;
      const float alpha = trainer::kernels::sigmoid(float(logit));
      const std::uint8_t rounded = quantised_alpha(alpha), truncated = std::uint8_t(alpha * 255);
      ours += (rounded / 255.0 >= 0.5) != (alpha >= 0.5f);
      naive += (truncated / 255.0 >= 0.5) != (alpha >= 0.5f);
      ours_off = worse(ours_off, std::abs(rounded - 255 * double(alpha)));
      naive_off = worse(naive_off, std::abs(truncated - 255 * double(alpha)));
      ours_mean += (rounded - 255 * double(alpha)) / texels;
      naive_mean += (truncated - 255 * double(alpha)) / texels;
    }
    // A distribution symmetric about one half is rounded up as often as down. Truncation removes
    // half a step on average. The bound is four standard errors of at most half a step each. One
    // half itself is rounded up.
    const double four_errors = 4 * 0.5 / std::sqrt(double(texels));
    EXPECT_NEAR(ours_mean, distribution == 3 ? 0.5 : 0, four_errors) << distribution;
    EXPECT_NEAR(naive_mean, -0.5, four_errors) << distribution;
    recorder.add({.at = double(distribution),
                  .naive = naive / texels,
                  .ours = ours / texels,
                  .tolerance = 0});
    // The nearest byte is at most half a step away, and products with 255 are exact in double.
    // Keeping the side of one half, 127.5 steps, never requires another byte than the nearest.
    bias.add({.at = double(distribution), .naive = naive_off, .ours = ours_off, .tolerance = 0.5});
  }
}

// -- T4, T5 -------------------------------------------------------------------------------------

TEST(Numerics, T4_ThePrecisionOfTheColourChain) {
  Recorder recorder({.stressed =
                         "colours against the oracle where both show one face: float texels, "
                         "features fetched once",
                     .parameter = "gain of the network's weights",
                     .unit = "root mean square of a channel",
                     .naive = "the baseline: bytes by truncation, features in 8 bits",
                     .naive_fails_from = 1});
  Random random(4);
  const Camera camera = random_camera(random, 320, 240);
  struct Row {
    double gain, forward_db;  // from an emulation: rounded texels, shaded in floats
  };
  for (const auto& [gain, forward_db] : {Row{1, 66.1}, Row{2, 63.6}, Row{4, 59.4}}) {
    TriangleSoup soup = random_soup(
        40, {.kind = Kind::lattice_mlp, .faces = 300, .level = 4, .float_texels = true});
    for (DenseLayer& layer : std::get<LatticeTexture>(soup.appearance).mlp->layers)
      for (float& weight : layer.weights) weight *= float(gain);
    const OracleImage expected = snapped_oracle(soup, glm::dvec3(0), camera);
    const Drawn ours = draw(shared_context(), soup, glm::dvec3(0), camera);
    Drawn baseline = draw_baseline(shared_context(), soup, glm::dvec3(0), camera);
    baseline.faces = ours.faces;
    const auto error = [&](const Drawn& drawn) {
      return std::pow(10.0, -agreement(expected, drawn).psnr / 20);
    };
    // Float texels have a smaller error, and the image's 8 bits add 1/255 sqrt(1/12).
    const double tolerance =
        std::hypot(std::pow(10.0, -forward_db / 20), std::sqrt(1.0 / 12) / 255);
    recorder.add(
        {.at = gain, .naive = error(baseline), .ours = error(ours), .tolerance = tolerance});
  }
}

TEST(Numerics, T5_TheSigmoidSaturates) {
  // From here on exp(x) is infinite, and infinity / infinity is not a number.
  const double overflows = std::log(double(std::numeric_limits<float>::max()));
  Recorder recorder(
      {.stressed = "the sigmoid of large sums: the network's shader, and the trainer's",
       .parameter = "size of the sum",
       .unit = "absolute error",
       .naive = "exp(x) / (1 + exp(x)) in floats",
       .naive_fails_from = overflows,
       .naive_holds_below = overflows});
  ColorMlp network;
  network.encoding = DirectionEncoding::none;
  network.layers = {{.inputs = 1, .outputs = 3, .weights = {1, 1, 1}, .biases = {0, 0, 0}}};
  const ColorMlpSource source = color_mlp_source(network, MlpWeights::all_constants);
  const Probe probe(api(),
                    source.text +
                        "vec4 probe(vec4 x) "
                        "{ return vec4(color_mlp(vec4(x.x, 0.0, 0.0, 0.0), vec4(0.0), "
                        "vec3(0.0, 0.0, 1.0)), 0.0); }",
                    {});
  for (const float size : {1.0f, 5.0f, 11.0f, 20.0f, 50.0f, 88.0f, 100.0f, 1e4f, 3e38f}) {
    double ours = 0, naive = 0, tolerance = 0;
    for (const float x : {-size, size}) {
      const double truth = 1 / (1 + std::exp(-double(x)));
      for (const float shown :
           {probe.run({glm::vec4(x, 0, 0, 0)})[0].x, trainer::kernels::sigmoid(x)})
        ours = worse(ours, std::abs(double(shown) - truth));
      const float e = std::exp(x);
      naive = worse(naive, std::abs(double(e / (1 + e)) - truth));
      // GLSL allows exp(x) an error of 3 + 2 |x| units in the last place. The sigmoid's slope
      // converts it to an error of the value; sum and quotient are rounded. The trainer clamps x at
      // |x| = 87, which leaves e^-87 instead of 0, accurate to two units.
      const double by_exponential = std::min(3 + 2 * std::abs(double(x)), 1e6) * 2 * epsilon;
      tolerance =
          std::max(tolerance, by_exponential * truth * (1 - truth) + 2 * epsilon * truth +
                                  (std::abs(x) > 87 ? std::exp(-87.0) * (1 + 4 * epsilon) : 0));
    }
    recorder.add({.at = size, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

TEST(Numerics, T5b_TheSigmoidSaturatesInHalves) {
  const double overflows = std::log(65504.0);  // the largest half
  Recorder recorder({.stressed = "the sigmoid of large sums in half precision, rounded after every "
                                 "operation: scalar.hpp",
                     .parameter = "size of the sum",
                     .unit = "absolute error",
                     .naive = "exp(x) / (1 + exp(x)) in halves",
                     .naive_fails_from = overflows,
                     .naive_holds_below = overflows});
  for (const float size : {1.0f, 5.0f, 8.0f, 11.0f, 12.0f, 50.0f, 1000.0f}) {
    double ours = 0, naive = 0;
    for (const float x : {-size, size}) {
      const double truth = 1 / (1 + std::exp(-double(x)));
      const Half e = exponential(Half(x));
      ours = worse(ours, std::abs(double(trainer::kernels::sigmoid(Half(x)).value) - truth));
      naive = worse(naive, std::abs(double((e / (Half(1) + e)).value) - truth));
    }
    // Half a unit of 2^-10 each for the exponential (times a slope of at most 1/4), the sum and the
    // quotient (relative errors of a value of at most 1).
    recorder.add({.at = size, .naive = naive, .ours = ours, .tolerance = 0x1p-11 * (0.25 + 1 + 1)});
  }
}

// -- T6, T9: what bytes go through ----------------------------------------------------------------

TEST(Numerics, T6_TransparentTexelsKeepTheirFeatures) {
  Recorder recorder({.stressed = "features beside an alpha in a PNG, written and read",
                     .parameter = "alpha byte",
                     .unit = "of 4096 texels changed",
                     .naive = "colours premultiplied, then divided again"});
  Random random(6);
  for (const int alpha : {0, 1, 16, 127, 128, 255}) {
    Image8 image(64, 64);
    for (glm::u8vec4& pixel : image.pixels)
      pixel = glm::u8vec4(random.below(256), random.below(256), random.below(256), alpha);
    const Image8 back = decode_image(encode_png(image), "texels");
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      ours += back.pixels[i] != image.pixels[i];
      bool lost = false;
      for (int c = 0; c < 3; ++c) {
        const int multiplied = int(std::lround(image.pixels[i][c] * alpha / 255.0));
        lost = lost || alpha == 0 || std::lround(multiplied * 255.0 / alpha) != image.pixels[i][c];
      }
      naive += lost;
    }
    recorder.add({.at = double(alpha), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

using Bytes = std::vector<std::byte>;

void append_big_endian(Bytes& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(std::byte(value >> shift & 255));
}

/// The PNG with a chunk added behind the header, where colour chunks belong.
Bytes with_chunk(const Bytes& png, const std::string& type, const Bytes& content) {
  constexpr std::size_t header_end = 8 + 12 + 13;
  Bytes chunk;
  append_big_endian(chunk, std::uint32_t(content.size()));
  for (const char c : type) chunk.push_back(std::byte(c));
  chunk.insert(chunk.end(), content.begin(), content.end());
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(&chunk[4]), uInt(chunk.size() - 4));
  append_big_endian(chunk, std::uint32_t(sum));
  Bytes result = png;
  result.insert(result.begin() + header_end, chunk.begin(), chunk.end());
  return result;
}

Bytes gamma_content(double gamma) {
  Bytes content;
  append_big_endian(content, std::uint32_t(std::lround(gamma * 100'000)));
  return content;
}

/// The profile's name, and a profile with a header and an empty table of tags.
Bytes profile_content() {
  Bytes profile(132);
  profile[3] = std::byte(132);  // its size
  const auto sign = [&](std::size_t at, const char* four) {
    for (std::size_t i = 0; i < 4; ++i) profile[at + i] = std::byte(four[i]);
  };
  sign(12, "mntr"), sign(16, "RGB "), sign(20, "XYZ "), sign(36, "acsp");
  uLongf size = compressBound(uLong(profile.size()));
  Bytes packed(size);
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(profile.data()), uLong(profile.size())),
            Z_OK);
  Bytes content;
  for (const char c : std::string("linear")) content.push_back(std::byte(c));
  content.resize(content.size() + 2);  // the end of the name, and the only compression method
  content.insert(content.end(), packed.begin(), packed.begin() + std::ptrdiff_t(size));
  return content;
}

TEST(Numerics, T6b_TexelsAreNotManagedAsColours) {
  Recorder recorder({.stressed = "features in a PNG with a colour space: (1) sRGB, (2) a "
                                 "gamma of 1, (3) of 1/2.2, (4) a profile of linear light",
                     .parameter = "colour space",
                     .unit = "of 4096 texels changed",
                     .naive = "colours converted for a screen"});
  Random random(16);
  Image8 image(64, 64);
  for (glm::u8vec4& pixel : image.pixels)
    pixel = glm::u8vec4(random.below(256), random.below(256), random.below(256), random.below(256));
  const Bytes plain = encode_png(image);
  struct Said {
    Bytes png;
    double gamma;  // of the file: colour = light ^ gamma
  };
  const Said said[] = {{with_chunk(plain, "sRGB", Bytes(1)), 1 / 2.2},
                       {with_chunk(plain, "gAMA", gamma_content(1)), 1},
                       {with_chunk(plain, "gAMA", gamma_content(1 / 2.2)), 1 / 2.2},
                       {with_chunk(plain, "iCCP", profile_content()), 1}};
  for (std::size_t i = 0; i < std::size(said); ++i) {
    const Image8 back = decode_image(said[i].png, "texels");
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    double ours = 0, naive = 0;
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
      ours += back.pixels[p] != image.pixels[p];
      bool changed = false;
      for (int c = 0; c < 3; ++c) {
        const double light = std::pow(image.pixels[p][c] / 255.0, 1 / said[i].gamma);
        const double on_screen = std::pow(light, 1 / 2.2);
        changed = changed || std::lround(255 * on_screen) != image.pixels[p][c];
      }
      naive += changed;
    }
    recorder.add({.at = double(i + 1), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

// -- T7, T8: large indices -----------------------------------------------------------------------

TEST(Numerics, T7_TexelsBeyondTwoToThe31AreFound) {
  constexpr std::uint32_t per_face = lattice::texel_count(5);
  constexpr double overflows = 0x1p31 / per_face;  // faces
  Recorder recorder({.stressed = "the first texel of a face at level 5 and its position: "
                                 "appearance_lattice.glsl, texel_store.glsl",
                     .parameter = "faces",
                     .unit = "of 1000 faces at a wrong position",
                     .naive = "signed 32-bit integers",
                     .naive_fails_from = overflows,
                     .naive_holds_below = overflows});
  Random random(7);
  const std::map<std::string, std::string> constants = {
      {"LATTICE_LEVEL", "5"},     {"LATENT_FEATURES", "0"}, {"ALPHA_BY_CELL", "0"},
      {"LATTICE_HARMONICS", "0"}, {"COLOR_MLP", "0"},       {"ALPHA_THRESHOLD", "0.5"},
      {"TEXEL_ROW_BITS", "12"},   {"TEXEL_LAYER_BITS", "9"}};
  // Numbers above 2^24 are passed as two halves of 16 bits.
  const std::string head =
      "#include \"appearance_lattice.glsl\"\n"
      "vec4 probe(vec4 x) { uint face = uint(x.x) * 65536u + uint(x.y); "
      "uint texel = patch_of(face).first_texel; ";
  const Probe index(api(), head + "return vec4(texel >> 16u, texel & 65535u, 0.0, 0.0); }",
                    constants);
  const Probe place(api(), head + "return vec4(vec3(texel_position(texel)), 0.0); }", constants);
  for (const std::uint32_t faces : {100'000u, 3'000'000u, 3'900'000u, 7'600'000u}) {
    std::vector<glm::vec4> inputs;
    std::vector<std::uint64_t> expected;
    for (int i = 0; i < 1000; ++i) {
      const std::uint32_t face = i == 0 ? faces - 1 : random.below(faces);
      inputs.emplace_back(float(face >> 16), float(face & 65535u), 0, 0);
      expected.push_back(std::uint64_t(face) * per_face);
    }
    const auto indices = index.run(inputs), places = place.run(inputs);
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto found = std::uint64_t(indices[i].x) * 65536 + std::uint64_t(indices[i].y);
      const auto at = std::uint64_t(places[i].x) + (std::uint64_t(places[i].y) << 12) +
                      (std::uint64_t(places[i].z) << 21);
      ours += found != expected[i] || at != expected[i];
      naive += std::int64_t(std::int32_t(std::uint32_t(expected[i]))) != std::int64_t(expected[i]);
    }
    recorder.add({.at = double(faces), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

TEST(Numerics, T8_IndicesBecomeCoordinatesAgain) {
  // According to the catalogue, a square root in floats gives the correct diagonal up to this
  // index.
  constexpr double last_exact = 10'619'134;
  Recorder recorder({.stressed =
                         "the coordinates of a texel from its index, near the ends of diagonals: "
                         "lattice.hpp",
                     .parameter = "index",
                     .unit = "of 1000 diagonals with a wrong texel",
                     .naive = "the square root in floats",
                     .naive_fails_from = last_exact + 1,
                     .naive_holds_below = last_exact + 1});
  // Includes the last index that floats get right, and the first of the diagonal above it.
  for (const double index : {8e3, 1e5, 1e6, 1e7, last_exact, last_exact + 2, 1e8, 1e9}) {
    const int last = int((std::sqrt(8 * index + 1) - 1) / 2);
    double ours = 0, naive = 0;
    for (int diagonal = std::max(1, last - 999); diagonal <= last; ++diagonal) {
      const auto first = std::uint32_t(diagonal) * (std::uint32_t(diagonal) + 1) / 2;
      bool wrong = false, naive_wrong = false;
      for (const std::uint32_t i : {first - 1, first, first + 1}) {
        const lattice::Coordinates at = lattice::texel_coordinates(i);
        wrong = wrong || at.x < 0 || at.y < 0 || lattice::texel_index(at.x, at.y) != i;
        const int in_floats = int((std::sqrt(8.0f * float(i) + 1.0f) - 1.0f) / 2.0f);
        naive_wrong = naive_wrong || in_floats != (i < first ? diagonal - 1 : diagonal);
      }
      ours += wrong;
      naive += naive_wrong;
    }
    recorder.add({.at = index, .naive = naive, .ours = ours, .tolerance = 0});
  }
}

// -- T9 -----------------------------------------------------------------------------------------

/// 256 squares in 16 columns; the pair of faces g has the grey value g.
TriangleSoup grey_ramp(Kind kind) {
  std::vector<glm::vec3> corners;
  for (int g = 0; g < 256; ++g) {
    const int row = g / 16;
    const auto at = [&](int x, int y) {
      return glm::vec3((g % 16 + x) / 16.0 - 0.5, 0.5 - (row + y) / 16.0, -1);
    };
    corners.insert(corners.end(), {at(0, 0), at(0, 1), at(1, 1), at(0, 0), at(1, 1), at(1, 0)});
  }
  TriangleSoup soup = soup_of(corners);
  const auto grey = [](std::size_t face) {
    const std::size_t pair = face / 2;
    return float(pair) / 255;
  };
  if (kind == Kind::face_colors) {
    for (std::size_t t = 0; t < 512; ++t)
      std::get<FaceColors>(soup.appearance).rgba[t] = glm::vec4(glm::vec3(grey(t)), 1);
  } else if (kind == Kind::vertex_colors) {
    VertexColors colors;
    for (std::size_t v = 0; v < corners.size(); ++v)
      colors.rgba.emplace_back(glm::vec3(grey(v / 3)), 1);
    soup.appearance = colors;
  } else {
    LatticeTexture texture;
    std::vector<std::uint8_t> bytes;
    for (std::uint32_t t = 0; t < 512; ++t) {
      texture.patches.push_back({3 * t, 0});
      for (int texel = 0; texel < 3; ++texel)
        for (int c = 0; c < LatticeTexture::channels; ++c)
          bytes.push_back(c == LatticeTexture::features ? 255 : std::uint8_t(t / 2));
    }
    texture.texels = bytes;
    soup.appearance = texture;
  }
  return soup;
}

TEST(Numerics, T9_AGreyRampArrivesBitByBit) {
  Recorder recorder({.stressed = "grey values of faces, vertices and lattices in the "
                                 "image: device",
                     .parameter = "grey byte",
                     .unit = "steps of 8 bits",
                     .naive = "encoded as if it were linear light"});
  const Camera camera = straight_camera(64, 64, 64);
  std::vector<double> ours(256);
  for (const Kind kind : {Kind::face_colors, Kind::vertex_colors, Kind::lattice})
    for (const bool specialise : {true, false}) {
      const Image8 image =
          draw(shared_context(), grey_ramp(kind), glm::dvec3(0), camera, {.specialise = specialise})
              .color;
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const int g = y / 4 * 16 + x / 4;
          for (int c = 0; c < 3; ++c)
            ours[std::size_t(g)] =
                std::max(ours[std::size_t(g)], std::abs(double(image.at(x, y)[c]) - g));
        }
    }
  const auto encoded = [](int g) { return std::round(255 * srgb_from_linear(g / 255.0)); };
  // The values in the catalogue for the naive method.
  EXPECT_EQ(encoded(8), 50);
  EXPECT_EQ(encoded(64), 137);
  EXPECT_EQ(encoded(128), 188);
  EXPECT_EQ(encoded(200), 229);
  for (int g = 0; g < 256; ++g)
    recorder.add({.at = double(g),
                  .naive = std::abs(encoded(g) - g),
                  .ours = ours[std::size_t(g)],
                  .tolerance = 0});
}

}  // namespace texture_test
}  // namespace tureen::test
