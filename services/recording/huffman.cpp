// SPDX-License-Identifier: Apache-2.0
#include "services/recording/huffman.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace handcast::recording {
namespace {

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

}  // namespace

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

}  // namespace handcast::recording
