// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace handcast::msg {

/// A text in a message: at most N - 1 bytes and a zero.
template <std::size_t N>
struct MessageText {
  std::array<char, N> bytes{};

  /// Copies a text, cut off where it is too long. Returns whether it fits.
  bool set(std::string_view text) {
    const std::size_t count = std::min(text.size(), N - 1);
    std::copy_n(text.data(), count, bytes.data());
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(count), bytes.end(), '\0');
    return count == text.size();
  }
  /// The text up to the first zero, also of torn or hostile bytes.
  std::string_view view() const {
    return {bytes.data(),
            static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), '\0') - bytes.begin())};
  }
};

}  // namespace handcast::msg
