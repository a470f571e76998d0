// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"

namespace handcast::storm {

/// A message of varying length. All its words follow from its number, so a reader can check that it
/// is not torn.
struct Scroll {
  static constexpr std::string_view layout = "Scroll/1";
  static constexpr std::size_t kMostWords = 2048;

  msg::Header header;
  std::uint64_t word_count = 0;

  static constexpr std::size_t most_bytes() {
    return sizeof(Scroll) + kMostWords * sizeof(std::uint64_t);
  }
  std::size_t used_bytes() const {
    return word_count > kMostWords ? ~std::size_t{0}
                                   : sizeof(Scroll) + word_count * sizeof(std::uint64_t);
  }

  void fill(std::uint64_t number) {
    header.frame_id = number;
    word_count = words_of(number);
    for (std::size_t i = 0; i < word_count; ++i) words()[i] = word_of(number, i);
  }
  bool whole() const {
    if (word_count != words_of(header.frame_id)) return false;
    for (std::size_t i = 0; i < word_count; ++i)
      if (words()[i] != word_of(header.frame_id, i)) return false;
    return true;
  }

 private:
  static std::size_t words_of(std::uint64_t number) { return 1 + number * 977 % kMostWords; }
  static std::uint64_t word_of(std::uint64_t number, std::size_t i) {
    return number * 0x9e3779b97f4a7c15 + i;
  }
  std::uint64_t* words() { return reinterpret_cast<std::uint64_t*>(this + 1); }
  const std::uint64_t* words() const { return reinterpret_cast<const std::uint64_t*>(this + 1); }
};

}  // namespace handcast::storm
