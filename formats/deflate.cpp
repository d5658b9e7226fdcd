#include "formats/deflate.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tureen {

namespace {

constexpr int max_match = 258;
/// The shortest repeat that is looked for: as many bytes as a hash takes in. DEFLATE knows 3, which
/// hardly ever pays.
constexpr int min_match = 4;
constexpr std::uint32_t window = 32768;
/// A repeat of only min_match bytes from further away costs about as much as its literals.
constexpr std::uint32_t near_enough = 2048;
constexpr int hash_bits = 15;
/// Literals and repeats that share one pair of Huffman codes: enough to pay for the some 80 bytes
/// that the codes take, few enough to follow changes in the data.
constexpr std::size_t block_tokens = 32768;
constexpr std::size_t max_stored = 65535;

constexpr int end_of_block = 256;
constexpr int literal_symbols = 286;
constexpr int distance_symbols = 30;

/// RFC 1951, 3.2.5: what a symbol stands for, and how many bits say the rest.
struct Range {
  std::uint16_t base;
  std::uint8_t extra_bits;
};
constexpr std::array<Range, 29> length_ranges{
    {{3, 0},  {4, 0},  {5, 0},  {6, 0},   {7, 0},   {8, 0},   {9, 0},   {10, 0},  {11, 1}, {13, 1},
     {15, 1}, {17, 1}, {19, 2}, {23, 2},  {27, 2},  {31, 2},  {35, 3},  {43, 3},  {51, 3}, {59, 3},
     {67, 4}, {83, 4}, {99, 4}, {115, 4}, {131, 5}, {163, 5}, {195, 5}, {227, 5}, {258, 0}}};
constexpr std::array<Range, distance_symbols> distance_ranges{
    {{1, 0},     {2, 0},     {3, 0},     {4, 0},      {5, 1},      {7, 1},
     {9, 2},     {13, 2},    {17, 3},    {25, 3},     {33, 4},     {49, 4},
     {65, 5},    {97, 5},    {129, 6},   {193, 6},    {257, 7},    {385, 7},
     {513, 8},   {769, 8},   {1025, 9},  {1537, 9},   {2049, 10},  {3073, 10},
     {4097, 11}, {6145, 11}, {8193, 12}, {12289, 12}, {16385, 13}, {24577, 13}}};

/// The symbol of each length 0..258, less 257.
constexpr std::array<std::uint8_t, max_match + 1> make_length_symbols() {
  std::array<std::uint8_t, max_match + 1> symbols{};
  for (std::size_t s = 0; s < length_ranges.size(); ++s)
    for (int length = length_ranges[s].base; length <= max_match; ++length)
      symbols[std::size_t(length)] = static_cast<std::uint8_t>(s);
  return symbols;
}
constexpr auto length_symbols = make_length_symbols();

int distance_symbol(std::uint32_t distance) {
  // Two symbols for each power of two: its upper bit tells which.
  if (distance <= 4) return int(distance) - 1;
  int bits = 0;
  for (std::uint32_t rest = distance - 1; rest > 3; rest >>= 1) ++bits;
  return 2 * bits + int((distance - 1) >> bits);
}

/// A literal where the distance is 0, otherwise a repeat.
struct Token {
  std::uint16_t value;  // the byte, or the length
  std::uint16_t distance;
};

class BitWriter {
 public:
  void put(std::uint32_t bits, int count) {
    buffer_ |= std::uint64_t(bits) << filled_;
    filled_ += count;
    if (filled_ >= 32) flush(4);
  }
  /// Zeros up to a whole byte; everything put so far lies in `bytes` then.
  void align() {
    filled_ = (filled_ + 7) / 8 * 8;
    flush(filled_ / 8);
  }

  std::vector<std::byte> bytes;

 private:
  void flush(int count) {
    std::array<std::byte, 4> word;
    for (int i = 0; i < count; ++i, buffer_ >>= 8)
      word[std::size_t(i)] = static_cast<std::byte>(buffer_);
    bytes.insert(bytes.end(), word.begin(), word.begin() + count);
    filled_ -= 8 * count;
  }

  std::uint64_t buffer_ = 0;
  int filled_ = 0;  // below 32 between calls
};

/// A canonical Huffman code over N symbols.
template <std::size_t N>
struct HuffmanCode {
  std::array<std::uint8_t, N> lengths{};
  std::array<std::uint16_t, N> bits{};  // the first bit lowest, as it is written

  HuffmanCode(std::array<std::uint32_t, N> counts, int max_length) {
    // A code of a single word is one that some readers refuse.
    for (std::size_t s = 0, used = N - std::size_t(std::count(counts.begin(), counts.end(), 0u));
         used < 2; ++s)
      if (counts[s] == 0) counts[s] = 1, ++used;
    // Flatter counts give a flatter tree; all equal ones are as flat as it gets.
    while (!fit(counts, max_length))
      for (std::uint32_t& count : counts) count = (count + 1) / 2;
    number(max_length);
  }

  void put(BitWriter& out, std::size_t symbol) const { out.put(bits[symbol], lengths[symbol]); }

 private:
  /// Huffman's lengths, by two queues; false where one is beyond max_length.
  bool fit(const std::array<std::uint32_t, N>& counts, int max_length) {
    std::vector<std::pair<std::uint32_t, std::size_t>> leaves;  // count, symbol
    for (std::size_t s = 0; s < N; ++s)
      if (counts[s] > 0) leaves.push_back({counts[s], s});
    std::sort(leaves.begin(), leaves.end());

    const std::size_t count = leaves.size();
    std::vector<std::uint64_t> weight;
    for (const auto& leaf : leaves) weight.push_back(leaf.first);
    std::vector<std::size_t> parent(2 * count - 1, 0);
    std::size_t leaf = 0, inner = count;
    const auto lightest = [&] {
      const bool take_leaf =
          leaf < count && (inner >= weight.size() || weight[leaf] <= weight[inner]);
      return take_leaf ? leaf++ : inner++;
    };
    while (weight.size() < 2 * count - 1) {
      const std::size_t a = lightest(), b = lightest();
      parent[a] = parent[b] = weight.size();
      weight.push_back(weight[a] + weight[b]);
    }

    std::vector<int> depth(2 * count - 1, 0);
    lengths.fill(0);
    for (std::size_t node = 2 * count - 2; node-- > 0;) {
      depth[node] = depth[parent[node]] + 1;
      if (node >= count) continue;
      if (depth[node] > max_length) return false;
      lengths[leaves[node].second] = static_cast<std::uint8_t>(depth[node]);
    }
    return true;
  }

  /// RFC 1951, 3.2.2.
  void number(int max_length) {
    std::uint32_t code = 0;
    for (int length = 1; length <= max_length; ++length, code <<= 1)
      for (std::size_t s = 0; s < N; ++s) {
        if (lengths[s] != length) continue;
        std::uint32_t mirrored = 0;
        for (int k = 0; k < length; ++k) mirrored |= (code >> k & 1) << (length - 1 - k);
        bits[s] = static_cast<std::uint16_t>(mirrored);
        ++code;
      }
  }
};

/// The lengths of both codes as runs (RFC 1951, 3.2.7): symbol, extra bits and how many of them.
struct LengthRun {
  std::uint8_t symbol, extra, extra_bits;
};

std::vector<LengthRun> length_runs(std::span<const std::uint8_t> lengths) {
  std::vector<LengthRun> runs;
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t end = i + 1;
    while (end < lengths.size() && lengths[end] == lengths[i]) ++end;
    std::size_t left = end - i;
    if (lengths[i] == 0) {
      for (; left >= 11; left -= std::min<std::size_t>(left, 138))
        runs.push_back({18, std::uint8_t(std::min<std::size_t>(left, 138) - 11), 7});
      if (left >= 3) runs.push_back({17, std::uint8_t(left - 3), 3}), left = 0;
    } else {
      runs.push_back({lengths[i], 0, 0});
      --left;
      for (; left >= 3; left -= std::min<std::size_t>(left, 6))
        runs.push_back({16, std::uint8_t(std::min<std::size_t>(left, 6) - 3), 2});
    }
    for (; left > 0; --left) runs.push_back({lengths[i], 0, 0});
    i = end;
  }
  return runs;
}

void put_stored(BitWriter& out, std::span<const std::byte> bytes, bool last) {
  do {
    const auto part = bytes.first(std::min(bytes.size(), max_stored));
    bytes = bytes.subspan(part.size());
    out.put(last && bytes.empty(), 3);
    out.align();
    out.put(std::uint32_t(part.size()), 16);
    out.put(~std::uint32_t(part.size()) & 0xffff, 16);
    out.bytes.insert(out.bytes.end(), part.begin(), part.end());
  } while (!bytes.empty());
}

/// `bytes` are what the tokens stand for.
void put_block(BitWriter& out, std::span<const Token> tokens, std::span<const std::byte> bytes,
               bool last) {
  std::array<std::uint32_t, literal_symbols> literal_counts{};
  std::array<std::uint32_t, distance_symbols> distance_counts{};
  for (const Token& token : tokens) {
    if (token.distance == 0) {
      ++literal_counts[token.value];
    } else {
      ++literal_counts[257u + length_symbols[token.value]];
      ++distance_counts[std::size_t(distance_symbol(token.distance))];
    }
  }
  literal_counts[end_of_block] = 1;
  const HuffmanCode literals(literal_counts, 15);
  const HuffmanCode distances(distance_counts, 15);

  std::vector<std::uint8_t> lengths(literals.lengths.begin(), literals.lengths.end());
  lengths.insert(lengths.end(), distances.lengths.begin(), distances.lengths.end());
  const std::vector<LengthRun> runs = length_runs(lengths);
  std::array<std::uint32_t, 19> run_counts{};
  for (const LengthRun& run : runs) ++run_counts[run.symbol];
  const HuffmanCode run_code(run_counts, 7);

  std::uint64_t size = 3 + 14 + 19 * 3;
  for (const LengthRun& run : runs) size += run_code.lengths[run.symbol] + run.extra_bits;
  for (std::size_t s = 0; s < literal_symbols; ++s)
    size += std::uint64_t(literal_counts[s]) *
            (literals.lengths[s] + (s > 256 ? length_ranges[s - 257].extra_bits : 0u));
  for (std::size_t s = 0; s < distance_symbols; ++s)
    size += std::uint64_t(distance_counts[s]) *
            (distances.lengths[s] + std::uint64_t(distance_ranges[s].extra_bits));
  if (size / 8 > bytes.size()) return put_stored(out, bytes, last);

  out.put(last, 1);
  out.put(2, 2);
  out.put(literal_symbols - 257, 5);
  out.put(distance_symbols - 1, 5);
  out.put(19 - 4, 4);
  for (const int s : {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15})
    out.put(run_code.lengths[std::size_t(s)], 3);
  for (const LengthRun& run : runs) {
    run_code.put(out, run.symbol);
    out.put(run.extra, run.extra_bits);
  }
  for (const Token& token : tokens) {
    if (token.distance == 0) {
      literals.put(out, token.value);
      continue;
    }
    const std::size_t length = length_symbols[token.value];
    literals.put(out, 257 + length);
    out.put(std::uint32_t(token.value - length_ranges[length].base),
            length_ranges[length].extra_bits);
    const auto distance = std::size_t(distance_symbol(token.distance));
    distances.put(out, distance);
    out.put(std::uint32_t(token.distance - distance_ranges[distance].base),
            distance_ranges[distance].extra_bits);
  }
  literals.put(out, end_of_block);
}

/// Finds for each place the latest ones, at most two, that began with the same four bytes.
class RepeatFinder {
 public:
  explicit RepeatFinder(std::span<const std::byte> bytes)
      // Places that no distance reaches.
      : bytes_(bytes), latest_(std::size_t(1) << hash_bits, {0u - window - 1, 0u - window - 1}) {}

  /// The better repeat, which need not be one worth telling; remembers the place. At least
  /// min_match bytes must follow.
  Token find(std::uint32_t place) {
    auto& places = latest_[hash(place)];
    Token best{0, 0};
    for (const std::uint32_t earlier : places) {
      const std::uint32_t distance = place - earlier;
      if (distance > window) continue;
      const int length = common_length(earlier, place);
      if (length > best.value) best = {std::uint16_t(length), std::uint16_t(distance)};
    }
    places = {place, places[0]};
    return best;
  }
  void remember(std::uint32_t place) {
    auto& places = latest_[hash(place)];
    places = {place, places[0]};
  }

 private:
  std::uint32_t hash(std::uint32_t place) const {
    std::uint32_t word;
    std::memcpy(&word, &bytes_[place], sizeof word);
    // Knuth's multiplier, 2^32 over the golden ratio.
    return word * 2654435761u >> (32 - hash_bits);
  }
  int common_length(std::uint32_t a, std::uint32_t b) const {
    const auto most = std::min<std::size_t>(max_match, bytes_.size() - b);
    std::size_t length = 0;
    for (; length + 8 <= most; length += 8)
      if (std::memcmp(&bytes_[a + length], &bytes_[b + length], 8) != 0) break;
    while (length < most && bytes_[a + length] == bytes_[b + length]) ++length;
    return int(length);
  }

  std::span<const std::byte> bytes_;
  std::vector<std::array<std::uint32_t, 2>> latest_;
};

std::uint32_t adler32(std::span<const std::byte> bytes) {
  std::uint32_t a = 1, b = 0;
  while (!bytes.empty()) {
    // As many bytes as the sums hold before they must be reduced (RFC 1950).
    const auto part = bytes.first(std::min<std::size_t>(bytes.size(), 5552));
    for (const std::byte byte : part) {
      a += std::to_integer<std::uint32_t>(byte);
      b += a;
    }
    a %= 65521;
    b %= 65521;
    bytes = bytes.subspan(part.size());
  }
  return b << 16 | a;
}

}  // namespace

std::vector<std::byte> zlib_compress(std::span<const std::byte> bytes) {
  assert(bytes.size() <= std::size_t(1) << 31);
  BitWriter out;
  out.bytes.reserve(bytes.size() / 2);
  out.put(0x78, 8);  // DEFLATE with a window of 32 KiB
  out.put(0x01, 8);  // the fastest level; makes the two a multiple of 31

  RepeatFinder finder(bytes);
  std::vector<Token> tokens;
  tokens.reserve(block_tokens);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::uint32_t begin = 0, place = 0;  // of the block, and what comes next
  do {
    tokens.clear();
    begin = place;
    while (place < size && tokens.size() < block_tokens) {
      Token token{0, 0};
      if (size - place >= min_match) token = finder.find(place);
      if (token.value < min_match || (token.value == min_match && token.distance > near_enough)) {
        tokens.push_back({std::to_integer<std::uint16_t>(bytes[place++]), 0});
        continue;
      }
      tokens.push_back(token);
      const std::uint32_t end = place + token.value;
      for (++place; place < end; ++place)
        if (size - place >= min_match) finder.remember(place);
    }
    put_block(out, tokens, bytes.subspan(begin, place - begin), place == size);
  } while (place < size);

  out.align();
  const std::uint32_t sum = adler32(bytes);
  for (int shift = 24; shift >= 0; shift -= 8)
    out.bytes.push_back(static_cast<std::byte>(sum >> shift));
  return std::move(out.bytes);
}

}  // namespace tureen
