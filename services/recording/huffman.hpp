// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace handcast::recording {

/// The longest code and the number of symbols (literals, end of block, lengths) of DEFLATE.
/// @{
inline constexpr int kLongestCode = 15;
inline constexpr std::size_t kSymbols = 286;
/// @}

using SymbolCounts = std::array<std::uint32_t, kSymbols>;

/// One code: its bits in the order in which they are written, lowest first.
struct Code {
  std::uint32_t bits = 0;
  std::uint8_t length = 0;  ///< number of bits; 0: the symbol does not occur
};

/// The canonical Huffman code (RFC 1951, 3.2.2) of symbols that occur so often, no longer than
/// kLongestCode. At least two symbols must occur.
std::array<Code, kSymbols> huffman_code(const SymbolCounts& counts);

}  // namespace handcast::recording
