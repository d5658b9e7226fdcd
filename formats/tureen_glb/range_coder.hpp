// A binary range coder with adaptive probabilities: each yes or no takes as much of the file as it
// is surprising (G. N. N. Martin, Range encoding, 1979; the carry is handled as 7-Zip's LZMA does).
//
// Encoder and decoder have the same `bit`: the encoder is told the bit, the decoder ignores what it
// is told; both return it. So one walk over the data serves for both directions and cannot
// disagree with itself. The decoder takes any bytes: past their end it reads zeros, and exhausted()
// says so.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tureen {

/// How likely the next bit is 0: the mean of a quick and a slow estimate, 16 bits each. The quick
/// one follows what changes, the slow one is right in the long run. Both begin as the mean of the
/// bits so far and of half a bit that is either, so that a model that is seldom asked learns, too.
class BitModel {
 public:
  // No constant expression: compilers would work out arrays of thousands of them one by one.
  BitModel() : quick_(32768), slow_(32768) {}

  /// In 1..4095 of 4096: no bit is ever impossible.
  std::uint32_t probability_of_zero() const {
    const std::uint32_t mean = (std::uint32_t(quick_) + slow_) >> 5;
    return mean < 1 ? 1 : mean > 4095 ? 4095 : mean;
  }
  void update(int bit) {
    quick_ = moved(quick_, bit, 16);
    slow_ = moved(slow_, bit, slow_pace);
    if (bits_ < slow_pace) ++bits_;
  }

 private:
  static constexpr int slow_pace = 128;

  /// The estimate after a bit that counts one in `pace`, or in the bits so far and one and a half,
  /// if those are fewer. Quotients are cut off towards zero: decoders everywhere must agree.
  std::uint16_t moved(int estimate, int bit, int pace) const {
    const int by = (bit ? 0 : 65535) - estimate, halves = 2 * bits_ + 3;
    return static_cast<std::uint16_t>(estimate + (halves < 2 * pace ? 2 * by / halves : by / pace));
  }

  std::uint16_t quick_, slow_;
  std::uint8_t bits_ = 0;
};

class RangeEncoder {
 public:
  int bit(BitModel& model, int bit) {
    const std::uint32_t bound = (range_ >> 12) * model.probability_of_zero();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift();
    }
    return bit;
  }

  /// The bytes; the encoder is spent afterwards.
  std::vector<std::byte> finish() {
    for (int i = 0; i < 5; ++i) shift();
    return std::move(bytes_);
  }

 private:
  void shift() {
    if (low_ < 0xff000000u || low_ > 0xffffffffu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      for (; pending_ > 0; --pending_) {
        bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(cache_ + carry)));
        cache_ = 0xff;
      }
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++pending_;
    low_ = (low_ & 0x00ffffffu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint8_t cache_ = 0;
  std::uint64_t pending_ = 1;
  std::vector<std::byte> bytes_;
};

/// What bits would take, for an encoder that has a choice: it codes nothing, and models learn
/// nothing.
class BitPrice {
 public:
  int bit(const BitModel& model, int bit) {
    const std::uint32_t zero = model.probability_of_zero();
    bits_ += of(bit ? 4096 - zero : zero);
    return bit;
  }
  double bits() const { return bits_; }

 private:
  /// Of something with a probability of `of_4096`, 1..4095.
  static double of(std::uint32_t of_4096) {
    static const auto table = [] {
      std::array<double, 4096> result{};
      for (std::size_t i = 1; i < result.size(); ++i) result[i] = 12 - std::log2(double(i));
      return result;
    }();
    return table[of_4096];
  }

  double bits_ = 0;
};

class RangeDecoder {
 public:
  /// The bytes must outlive the decoder.
  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = code_ << 8 | next();
  }

  int bit(BitModel& model, int = 0) {
    const std::uint32_t bound = (range_ >> 12) * model.probability_of_zero();
    const int bit = code_ >= bound ? 1 : 0;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }

  /// More was read than there is: the bytes are cut short or damaged.
  bool exhausted() const { return past_end_ > 0; }

 private:
  std::uint32_t next() {
    if (position_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[position_++]);
    ++past_end_;
    return 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  std::size_t past_end_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint32_t code_ = 0;
};

/// Whole numbers by their length in bits, then the bits below the leading one. Lengths and the two
/// leading bits adapt; what is below them is noise and is taken as it comes.
template <int max_length>
class NumberModel {
 public:
  /// `value` in 0..2^max_length - 2; so is what comes back, whatever a decoder's bytes are.
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    const std::uint32_t wanted = value + 1;
    int length = 1;
    while (length < max_length) {
      if (!coder.bit(longer_[length], (wanted >> length) != 0)) break;
      ++length;
    }
    std::uint32_t result = 1;
    for (int i = length - 2; i >= 0; --i) {
      const int bit = int(wanted >> i & 1u);
      const int below = length - 2 - i;  // 0 for the bit below the leading one
      BitModel& model = below == 0   ? second_[length]
                        : below == 1 ? third_[length][result & 1u]
                                     : rest_[length];
      result = result << 1 | std::uint32_t(coder.bit(model, bit));
    }
    return result - 1;
  }

 private:
  BitModel longer_[max_length + 1];
  BitModel second_[max_length + 1];
  BitModel third_[max_length + 1][2];
  BitModel rest_[max_length + 1];
};

/// The same with a sign, which adapts, too.
template <int max_length>
class SignedModel {
 public:
  template <class Coder>
  int code(Coder& coder, int value) {
    const std::uint32_t size = magnitude_.code(coder, std::uint32_t(value < 0 ? -value : value));
    if (size == 0) return 0;
    return coder.bit(negative_, value < 0) ? -int(size) : int(size);
  }

 private:
  NumberModel<max_length> magnitude_;
  BitModel negative_;
};

}  // namespace tureen
