// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/pairing.hpp"

#include <gtest/gtest.h>

#include "ipc/base/clock.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::pose::stereo {
namespace {

msg::Landmarks of(std::int64_t origin_ms) {
  msg::Landmarks landmarks;
  landmarks.header.origin_ns = origin_ms * kMs;
  return landmarks;
}

/// The origins in ms, -1 for a view without landmarks.
std::array<std::int64_t, kViews> origins(const std::optional<Pair>& pair) {
  if (!pair) return {-2, -2};
  std::array<std::int64_t, kViews> ms{-1, -1};
  for (std::size_t v = 0; v < ms.size(); ++v)
    if ((*pair)[v]) ms[v] = (*pair)[v]->header.origin_ns / kMs;
  return ms;
}
using Origins = std::array<std::int64_t, kViews>;

class PairingTest : public testing::Test {
 protected:
  void push(int view, std::int64_t origin_ms, std::int64_t at_ms) {
    pairing_.push(view, of(origin_ms), at_ms * kMs);
  }
  Origins take(std::int64_t at_ms) { return origins(pairing_.take(at_ms * kMs)); }
  static constexpr Origins kNone{-2, -2};

  Pairing pairing_{config::PoseStereo{.pair_ms = 8, .wait_ms = 6}};
};

TEST_F(PairingTest, LandmarksOfImagesOfOneTimeAreOneSampleAtOnce) {
  push(0, 100, 105);
  EXPECT_EQ(take(105), kNone) << "those of the other camera may come";
  push(1, 103, 106);
  EXPECT_EQ(take(106), (Origins{100, 103}));
  EXPECT_EQ(take(200), kNone) << "each is given once";
}

TEST_F(PairingTest, LandmarksDoNotWaitLongerThanWaitMs) {
  push(1, 100, 105);
  EXPECT_EQ(pairing_.due_ns(), 111 * kMs);
  EXPECT_EQ(take(110), kNone);
  EXPECT_EQ(take(111), (Origins{-1, 100}));
  EXPECT_FALSE(pairing_.due_ns());
}

TEST_F(PairingTest, ImagesThatAreFarApartAreTwoSamples) {
  push(0, 100, 105);
  push(1, 109, 110);
  EXPECT_EQ(take(110), (Origins{100, -1}));
  EXPECT_EQ(take(116), (Origins{-1, 109}));
}

TEST_F(PairingTest, TheTimesOfSamplesIncreaseWhateverIsLate) {
  push(0, 100, 105);
  EXPECT_EQ(take(111), (Origins{100, -1}));
  push(1, 95, 112);
  EXPECT_EQ(take(130), kNone) << "too late to be a sample of its own";
  push(0, 102, 131);
  EXPECT_EQ(take(131), (Origins{102, 95})) << "but it is part of the next";
  push(0, 102, 132);
  push(0, 90, 133);
  EXPECT_EQ(take(200), kNone) << "the same image, and an older one";
}

TEST_F(PairingTest, TheViewThatIsMissingIsAwaited) {
  EXPECT_EQ(pairing_.awaited_view(), 0);
  push(0, 100, 105);
  EXPECT_EQ(pairing_.awaited_view(), 1);
}

}  // namespace
}  // namespace handcast::pose::stereo
