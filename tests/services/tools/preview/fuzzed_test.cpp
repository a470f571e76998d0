// SPDX-License-Identifier: Apache-2.0
// A short run of the fuzz target `preview`, which scripts/fuzz runs for longer: its inputs, and
// copies of them with other bytes. It aborts if a promise is not kept.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace handcast::preview {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kCopies = 150;

/// Some bytes become others; most of these are powers of two and their neighbours.
Bytes spoilt(Bytes bytes, std::mt19937& random) {
  constexpr std::array<std::uint8_t, 6> kSpecial{0, 1, 0x7f, 0x80, 0xff, 0xc0};
  for (auto changes = 1 + random() % 24; changes > 0; --changes)
    bytes[random() % bytes.size()] =
        random() % 3 ? kSpecial[random() % kSpecial.size()] : static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(FuzzedMessages, GiveAPictureWhateverTheySay) {
  int inputs = 0;
  std::mt19937 random(1);
  for (const auto& entry : std::filesystem::directory_iterator("tests/fuzz/corpus/preview")) {
    std::ifstream file(entry.path(), std::ios::binary);
    const Bytes input{std::istreambuf_iterator<char>(file), {}};
    ASSERT_FALSE(input.empty()) << entry.path();
    LLVMFuzzerTestOneInput(input.data(), input.size());
    for (int i = 0; i < kCopies; ++i) {
      const auto copy = spoilt(input, random);
      LLVMFuzzerTestOneInput(copy.data(), copy.size());
    }
    ++inputs;
  }
  EXPECT_GE(inputs, 3);
}

}  // namespace
}  // namespace handcast::preview
