// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/md5.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace handcast::desk::lamp {
namespace {

using State = std::array<std::uint32_t, 4>;

/// RFC 1321, section 3.4: 2^32 |sin(i + 1)|.
std::array<std::uint32_t, 64> make_constants() {
  std::array<std::uint32_t, 64> constants{};
  for (std::size_t i = 0; i < constants.size(); ++i)
    constants[i] = static_cast<std::uint32_t>(
        std::floor(std::abs(std::sin(static_cast<double>(i) + 1)) * 4294967296.0));
  return constants;
}

std::uint32_t word_at(std::string_view block, std::size_t word) {
  std::uint32_t value = 0;
  for (std::size_t byte = 4; byte-- > 0;)
    value = value << 8 | static_cast<unsigned char>(block[4 * word + byte]);
  return value;
}

/// Adds a block of 64 bytes.
void add_block(State& state, std::string_view block) {
  static const auto constants = make_constants();
  static constexpr int kTurns[4][4] = {
      {7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
  auto [a, b, c, d] = state;
  for (std::size_t i = 0; i < 64; ++i) {
    std::uint32_t mix = 0;
    std::size_t word = 0;
    switch (i / 16) {
      case 0:
        mix = (b & c) | (~b & d);
        word = i;
        break;
      case 1:
        mix = (d & b) | (~d & c);
        word = (5 * i + 1) % 16;
        break;
      case 2:
        mix = b ^ c ^ d;
        word = (3 * i + 5) % 16;
        break;
      default:
        mix = c ^ (b | ~d);
        word = 7 * i % 16;
    }
    const auto sum = a + mix + constants[i] + word_at(block, word);
    a = d;
    d = c;
    c = b;
    b += std::rotl(sum, kTurns[i / 16][i % 4]);
  }
  state = {state[0] + a, state[1] + b, state[2] + c, state[3] + d};
}

}  // namespace

std::string md5(std::string_view text) {
  std::string padded(text);
  padded += '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(text.size());
  for (int byte = 0; byte < 8; ++byte) padded += static_cast<char>(bits >> 8 * byte & 255);
  State state{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
  for (std::size_t at = 0; at < padded.size(); at += 64)
    add_block(state, std::string_view(padded).substr(at, 64));
  std::string digits;
  for (const auto part : state)
    for (int byte = 0; byte < 4; ++byte) digits += fmt::format("{:02x}", part >> 8 * byte & 255);
  return digits;
}

}  // namespace handcast::desk::lamp
