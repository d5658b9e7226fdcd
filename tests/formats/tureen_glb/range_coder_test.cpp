// The range coder restores its input, and its size is close to the entropy.
#include "formats/tureen_glb/range_coder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tureen {
namespace range_coder_test {

TEST(RangeCoder, BitsOfAnyProbabilityComeBack) {
  const unsigned seed = 21;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (const unsigned ones_of_1000 : {0u, 1u, 30u, 500u, 999u, 1000u}) {
    std::vector<int> bits(20000);
    for (int& bit : bits) bit = random() % 1000 < ones_of_1000;
    RangeEncoder encoder;
    BitModel model;
    for (const int bit : bits) encoder.bit(model, bit);
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    BitModel again;
    for (std::size_t i = 0; i < bits.size(); ++i)
      ASSERT_EQ(decoder.bit(again), bits[i]) << ones_of_1000 << " of 1000, bit " << i;
    EXPECT_FALSE(decoder.exhausted());

    // Shannon's bound. Adaptive estimates cost a few percent of a bit for each bit: 0.03 is about
    // 2.5 times the measured cost for even odds. The end takes five bytes.
    const double p = ones_of_1000 / 1000.0;
    const double entropy = p <= 0 || p >= 1 ? 0 : -p * std::log2(p) - (1 - p) * std::log2(1 - p);
    EXPECT_LT(double(bytes.size()), (entropy + 0.03) * double(bits.size()) / 8 + 5) << ones_of_1000;
    EXPECT_GT(double(bytes.size()) + 40, 0.95 * entropy * double(bits.size()) / 8) << ones_of_1000;
  }
}

TEST(RangeCoder, NumbersComeBack) {
  const unsigned seed = 22;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::vector<int> values{0, 1, -1, 2, 65534, -65534, 65535, -65535, (1 << 17) - 2};
  for (int i = 0; i < 5000; ++i) {
    const int size = int(random() >> (15 + random() % 17));
    values.push_back(random() % 2 ? size : -size);
  }
  RangeEncoder encoder;
  SignedModel<17> model;
  for (const int value : values) EXPECT_EQ(model.code(encoder, value), value);
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  SignedModel<17> again;
  for (const int value : values) ASSERT_EQ(again.code(decoder, 0), value);
  EXPECT_FALSE(decoder.exhausted());
}

TEST(RangeCoder, APriceIsWhatTheBitsTake) {
  const unsigned seed = 25;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  RangeEncoder encoder;
  SignedModel<17> model;
  BitPrice price;
  for (int i = 0; i < 5000; ++i) {
    const int size = int(random() >> (20 + random() % 12));
    const int value = random() % 2 ? size : -size;
    model.code(price, value);
    model.code(encoder, value);
  }
  // The coder rounds its range to integers, and ends with five bytes.
  const double bits = double(encoder.finish().size()) * 8;
  EXPECT_NEAR(price.bits() / bits, 1, 0.002);
}

TEST(RangeCoder, ModelsThatAreSeldomAskedLearnToo) {
  RangeEncoder encoder;
  std::vector<BitModel> models(1000);
  for (int i = 0; i < 8; ++i)
    for (BitModel& model : models) encoder.bit(model, 1);
  // An estimate from the mean of the ones so far takes 1.8 bits for the eight. An estimate that
  // moves by a sixteenth each time would take 6.
  EXPECT_LT(double(encoder.finish().size()), 2.5 * 1000 / 8);
}

TEST(RangeCoder, CarriesPropagate) {
  // A series of unlikely bits moves the low end up until carries run through many bytes.
  const unsigned seed = 23;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (int run = 0; run < 200; ++run) {
    std::vector<int> bits(300);
    const unsigned period = 1 + random() % 40;
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = i % period == 0 || random() % 7 == 0;
    RangeEncoder encoder;
    std::vector<BitModel> models(3);
    for (std::size_t i = 0; i < bits.size(); ++i) encoder.bit(models[i % 3], bits[i]);
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    std::vector<BitModel> again(3);
    for (std::size_t i = 0; i < bits.size(); ++i) ASSERT_EQ(decoder.bit(again[i % 3]), bits[i]);
  }
}

TEST(RangeCoder, EveryMissingByteIsNoticed) {
  std::mt19937 random(24);
  std::vector<int> bits(500);
  for (int& bit : bits) bit = int(random() % 2);
  RangeEncoder encoder;
  BitModel model;
  for (const int bit : bits) encoder.bit(model, bit);
  const auto bytes = encoder.finish();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + std::ptrdiff_t(length));
    RangeDecoder decoder(cut);
    BitModel again;
    for (std::size_t i = 0; i < bits.size(); ++i) decoder.bit(again);
    EXPECT_TRUE(decoder.exhausted()) << length;
  }
}

}  // namespace range_coder_test
}  // namespace tureen
