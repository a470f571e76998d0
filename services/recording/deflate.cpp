// SPDX-License-Identifier: Apache-2.0
#include "services/recording/deflate.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>
#include <utility>

namespace handcast::recording {
namespace {

/// The longest code and the number of symbols (literals, end of block, lengths) of DEFLATE.
/// @{
constexpr int kLongestCode = 15;
constexpr std::size_t kSymbols = 286;
/// @}

using SymbolCounts = std::array<std::uint32_t, kSymbols>;

/// One code: its bits in the order in which they are written, lowest first.
struct Code {
  std::uint32_t bits = 0;
  std::uint8_t length = 0;  ///< number of bits; 0: the symbol does not occur
};

using Lengths = std::array<std::uint32_t, kSymbols + 1>;  ///< number of codes by length

struct Leaf {
  std::uint32_t count = 0;
  std::uint32_t symbol = 0;
};

/// The depths of the leaves of a Huffman tree, the rarest leaf first. Two queues, both in
/// ascending order: the leaves, and the inner nodes as they are made.
std::vector<std::uint32_t> depths_of(const std::vector<Leaf>& leaves) {
  const std::size_t count = leaves.size(), nodes = 2 * count - 1;
  std::vector<std::uint64_t> weight(nodes);
  std::vector<std::size_t> parent(nodes);
  for (std::size_t i = 0; i < count; ++i) weight[i] = leaves[i].count;
  std::size_t leaf = 0, inner = count;
  for (std::size_t made = count; made < nodes; ++made)
    for (int child = 0; child < 2; ++child) {
      const bool take_leaf = leaf < count && (inner == made || weight[leaf] <= weight[inner]);
      const auto taken = take_leaf ? leaf++ : inner++;
      weight[made] += weight[taken];
      parent[taken] = made;
    }
  std::vector<std::uint32_t> depth(nodes);
  for (std::size_t i = nodes - 1; i-- > 0;) depth[i] = depth[parent[i]] + 1;
  depth.resize(count);
  return depth;
}

/// Shortens codes that are too long, and lengthens others until the code is one again (Kraft's sum
/// is 1). Costs little, because only the rarest symbols change.
void limit(Lengths& of_length) {
  for (std::size_t length = kLongestCode + 1; length < of_length.size(); ++length)
    of_length[kLongestCode] += std::exchange(of_length[length], 0u);
  std::uint64_t sum = 0;
  for (int length = 1; length <= kLongestCode; ++length)
    sum += std::uint64_t{of_length[length]} << (kLongestCode - length);
  for (; sum > std::uint64_t{1} << kLongestCode; --sum) {
    --of_length[kLongestCode];
    int shorter = kLongestCode - 1;
    while (of_length[shorter] == 0) --shorter;
    --of_length[shorter];
    of_length[shorter + 1] += 2;
  }
}

std::uint32_t reversed(std::uint32_t bits, int length) {
  std::uint32_t result = 0;
  for (int i = 0; i < length; ++i) result |= (bits >> i & 1) << (length - 1 - i);
  return result;
}

/// Numbers the codes, given their lengths.
void number(std::array<Code, kSymbols>& codes, const Lengths& of_length) {
  std::array<std::uint32_t, kLongestCode + 1> next{};
  for (int length = 1; length < kLongestCode; ++length)
    next[length + 1] = (next[length] + of_length[length]) << 1;
  for (auto& code : codes)
    if (code.length > 0) code.bits = reversed(next[code.length]++, code.length);
}

/// The canonical Huffman code (RFC 1951, 3.2.2) of symbols that occur so often, no longer than
/// kLongestCode. At least two symbols must occur.
std::array<Code, kSymbols> huffman_code(const SymbolCounts& counts) {
  std::vector<Leaf> leaves;
  for (std::uint32_t symbol = 0; symbol < kSymbols; ++symbol)
    if (counts[symbol] > 0) leaves.push_back({counts[symbol], symbol});
  std::ranges::stable_sort(leaves, {}, &Leaf::count);
  Lengths of_length{};
  for (const auto depth : depths_of(leaves)) ++of_length[depth];
  limit(of_length);
  std::array<Code, kSymbols> codes;
  auto leaf = leaves.begin();
  for (int length = kLongestCode; length > 0; --length)
    for (std::uint32_t i = 0; i < of_length[length]; ++i)
      codes[(leaf++)->symbol].length = static_cast<std::uint8_t>(length);
  number(codes, of_length);
  return codes;
}

/// A token is a literal (0 to 255) or kRun + length - 3: the byte before it again, `length` times.
constexpr std::uint16_t kRun = 256;
constexpr std::size_t kTokens = 512, kShortestRun = 4, kLongestRun = 258;
constexpr std::size_t kEnd = 256;  ///< the symbol of the end of the block

/// The length codes of DEFLATE (RFC 1951, 3.2.5), from symbol 257 on.
struct LengthCode {
  std::uint16_t first;  ///< the shortest length
  std::uint8_t extra;   ///< number of bits of `length - first`
};
constexpr std::array<LengthCode, 29> kLengthCodes{
    {{3, 0},  {4, 0},  {5, 0},  {6, 0},   {7, 0},   {8, 0},   {9, 0},   {10, 0},  {11, 1}, {13, 1},
     {15, 1}, {17, 1}, {19, 2}, {23, 2},  {27, 2},  {31, 2},  {35, 3},  {43, 3},  {51, 3}, {59, 3},
     {67, 4}, {83, 4}, {99, 4}, {115, 4}, {131, 5}, {163, 5}, {195, 5}, {227, 5}, {258, 0}}};

std::size_t length_code_of(std::size_t length) {
  std::size_t code = 0;
  while (code + 1 < kLengthCodes.size() && kLengthCodes[code + 1].first <= length) ++code;
  return code;
}

template <class Word>
Word load(const std::uint8_t* from) {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

/// How often the byte before `from` is repeated from there on.
std::size_t run_at(const std::uint8_t* from, const std::uint8_t* end) {
  const auto most = std::min<std::size_t>(kLongestRun, end - from);
  std::size_t length = 0;
  while (length < most && from[length] == from[-1]) ++length;
  return length;
}

/// Returns the number of tokens, which are written to memory for bytes.size() of them.
std::size_t find_tokens(std::span<const std::uint8_t> bytes, std::uint16_t* const tokens) {
  const std::uint8_t *here = bytes.data(), *end = here + bytes.size();
  auto* token = tokens;
  if (here != end) *token++ = *here++;
  while (end - here >= static_cast<std::ptrdiff_t>(kShortestRun)) {
    if (load<std::uint32_t>(here) != load<std::uint32_t>(here - 1)) {
      *token++ = *here++;
      continue;
    }
    const auto length = run_at(here, end);
    *token++ = static_cast<std::uint16_t>(kRun + length - 3);
    here += length;
  }
  while (here != end) *token++ = *here++;
  return static_cast<std::size_t>(token - tokens);
}

/// Counts in four tables, because equal tokens that follow each other would wait for one another.
SymbolCounts count_symbols(std::span<const std::uint16_t> tokens) {
  std::array<std::array<std::uint32_t, kTokens>, 4> of_token{};
  for (std::size_t i = 0; i < tokens.size(); ++i) ++of_token[i % 4][tokens[i]];
  SymbolCounts counts{};
  for (std::size_t token = 0; token < kTokens; ++token) {
    std::uint32_t count = 0;
    for (const auto& table : of_token) count += table[token];
    counts[token < kRun ? token : 257 + length_code_of(token - kRun + 3)] += count;
  }
  counts[kEnd] = 1;
  if (std::ranges::count(counts, 0u) == kSymbols - 1) counts[0] = 1;  // a code has two symbols
  return counts;
}

/// Appends bits, lowest first, to memory that is large enough: 8 bytes more than are written.
class BitWriter {
 public:
  explicit BitWriter(std::byte* to) : to_(to) {}

  /// At most 32 bits; flush() after at most 56.
  void put(Code code) {
    bits_ |= std::uint64_t{code.bits} << count_;
    count_ += code.length;
  }
  void put(std::uint32_t bits, int count) {
    put(Code{bits, static_cast<std::uint8_t>(count)});
    flush();
  }
  void flush() {
    static_assert(std::endian::native == std::endian::little);
    std::memcpy(to_, &bits_, sizeof bits_);
    to_ += count_ / 8;
    bits_ >>= count_ / 8 * 8;
    count_ %= 8;
  }
  /// Fills the last byte. Returns its end.
  std::byte* finish() {
    flush();
    return count_ > 0 ? to_ + 1 : to_;
  }

 private:
  std::byte* to_;
  std::uint64_t bits_ = 0;
  int count_ = 0;
};

/// The header of a block (RFC 1951, 3.2.7). All lengths of codes are written with four bits each:
/// shorter ones would save less than 100 bytes.
void put_header(BitWriter& out, const std::array<Code, kSymbols>& codes) {
  constexpr int kCodeLengths = 19, kUnused = 3;
  out.put(1, 1);               // the last block
  out.put(2, 2);               // with a code of its own
  out.put(kSymbols - 257, 5);  // literals and lengths
  out.put(0, 5);               // one distance
  out.put(kCodeLengths - 4, 4);
  for (int i = 0; i < kCodeLengths; ++i) out.put(i < kUnused ? 0 : 4, 3);
  const auto put_length = [&](std::uint32_t length) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 4; ++bit) reversed |= (length >> bit & 1) << (3 - bit);
    out.put(reversed, 4);
  };
  for (const auto& code : codes) put_length(code.length);
  put_length(1);  // distance 1 is one bit: 0
}

/// The bits of each token: of a run, its length and the distance 1.
std::array<Code, kTokens> token_codes(const std::array<Code, kSymbols>& codes) {
  std::array<Code, kTokens> of_token{};
  std::copy_n(codes.begin(), 256, of_token.begin());
  for (std::size_t length = kShortestRun; length <= kLongestRun; ++length) {
    const auto number = length_code_of(length);
    const auto& symbol = codes[257 + number];
    const auto extra = static_cast<std::uint32_t>(length - kLengthCodes[number].first);
    of_token[kRun + length - 3] = {
        symbol.bits | extra << symbol.length,
        static_cast<std::uint8_t>(symbol.length + kLengthCodes[number].extra + 1)};
  }
  return of_token;
}

std::byte* put_block(std::span<const std::uint16_t> tokens, std::byte* to) {
  const auto codes = huffman_code(count_symbols(tokens));
  BitWriter out(to);
  put_header(out, codes);
  const auto of_token = token_codes(codes);
  std::size_t i = 0;
  for (; i + 2 <= tokens.size(); i += 2) {  // a token has at most 21 bits
    out.put(of_token[tokens[i]]);
    out.put(of_token[tokens[i + 1]]);
    out.flush();
  }
  if (i < tokens.size()) out.put(of_token[tokens[i]]);
  out.flush();
  out.put(codes[kEnd]);
  return out.finish();
}

}  // namespace

void Deflater::append(std::span<const std::uint8_t> bytes, Bytes& out) {
  constexpr std::size_t kFrame = 512;  // header of the block, checksum, what BitWriter needs
  // Grown, never shrunk: resize() would clear the memory.
  if (tokens_.size() < bytes.size()) tokens_.resize(bytes.size());
  if (stream_.size() < 2 * bytes.size() + kFrame)
    stream_.resize(2 * bytes.size() + kFrame);  // a literal has at most 15 bits
  const auto count = find_tokens(bytes, tokens_.data());
  auto* to = stream_.data();
  *to++ = std::byte{0x78};  // deflate with a window of 32 KiB
  *to++ = std::byte{0x01};
  to = put_block(std::span(tokens_).first(count), to);
  const auto sum = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (int shift = 24; shift >= 0; shift -= 8) *to++ = static_cast<std::byte>(sum >> shift);
  out.insert(out.end(), stream_.data(), to);
}

void Inflater::Free::operator()(libdeflate_decompressor* decompressor) const {
  libdeflate_free_decompressor(decompressor);
}

Inflater::Inflater() : decompressor_(libdeflate_alloc_decompressor()) {
  if (!decompressor_) throw std::bad_alloc();
}

bool Inflater::read(std::span<const std::byte> stream, std::span<std::uint8_t> bytes) {
  return libdeflate_zlib_decompress(decompressor_.get(), stream.data(), stream.size(), bytes.data(),
                                    bytes.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace handcast::recording
