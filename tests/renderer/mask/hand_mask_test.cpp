// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/hand_mask.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kSearched_ns = 200 * kMs;

HandMask::Sought sought_at(const calib::Calibration& rig, glm::vec3 position_m, glm::vec2 off_px) {
  HandMask::Sought hand{.side = Side::left, .then = project(rig, pose_of(Side::left, position_m))};
  hand.offset_px.fill(off_px);
  return hand;
}

/// The mask in the camera.
Image<std::uint8_t> found_in(HandMask& mask, const TimedImage& camera,
                             const HandMask::Sought& hand) {
  mask.find(camera, {&hand, 1});
  const auto view = mask.silhouette(camera).mask;
  Image<std::uint8_t> copy(view.width, view.height);
  for (int y = 0; y < view.height; ++y) std::copy_n(view.row(y), view.width, copy.row(y));
  return copy;
}

class SearchedTwice : public testing::Test {
 protected:
  Image<std::uint8_t> fresh(const TimedImage& camera, const HandMask::Sought& hand) const {
    HandMask mask({}, rig_, true);
    return found_in(mask, camera, hand);
  }
  TimedImage timed(const Image<std::uint8_t>& image, std::uint64_t id = 1) const {
    return {image.view(), kSearched_ns + static_cast<std::int64_t>(id), id};
  }

  calib::Calibration rig_ = rig_above_hand();
  HandMask mask_{{}, rig_, true};
  Image<std::uint8_t> image_ = image_of(rig_, {pose_of(Side::left, glm::vec3(0))});
  HandMask::Sought here_ = sought_at(rig_, {}, {});
};

TEST_F(SearchedTwice, AHandThatHardlyMovedHasTheMaskThatItHas) {
  const auto first = found_in(mask_, timed(image_), here_);
  EXPECT_GT(std::ranges::count(first.pixels(), 255), 1000);
  for (const glm::vec2 off : {glm::vec2(0.1f, 0), glm::vec2(-0.1f, 0.2f), glm::vec2(0)}) {
    const auto moved = sought_at(rig_, {}, off);
    EXPECT_TRUE(std::ranges::equal(found_in(mask_, timed(image_), moved).pixels(),
                                   fresh(timed(image_), moved).pixels()));
  }
}

TEST_F(SearchedTwice, TheImageIsNotReadAgain) {
  found_in(mask_, timed(image_), here_);
  const TimedImage same = timed(image_);
  std::ranges::fill(image_.pixels(), 0);
  EXPECT_GT(std::ranges::count(found_in(mask_, same, here_).pixels(), 255), 1000);
}

TEST_F(SearchedTwice, AHandThatIsSoughtElsewhereIsSearchedAnew) {
  found_in(mask_, timed(image_), sought_at(rig_, {0.4f, 0, 0}, {}));
  EXPECT_TRUE(std::ranges::equal(found_in(mask_, timed(image_), here_).pixels(),
                                 fresh(timed(image_), here_).pixels()));
}

TEST_F(SearchedTwice, ANewImageIsSearchedEvenIfItLiesWhereTheOldOneLay) {
  found_in(mask_, timed(image_, 1), here_);
  const TimedImage second = timed(image_, 2);
  std::ranges::fill(image_.pixels(), 0);
  EXPECT_EQ(std::ranges::count(found_in(mask_, second, here_).pixels(), 255), 0);
}

TEST_F(SearchedTwice, AHandThatCameIsFound) {
  const TimedImage camera = timed(image_);
  const HandMask::Sought nobody{.side = Side::left};
  EXPECT_EQ(std::ranges::count(found_in(mask_, camera, nobody).pixels(), 255), 0);
  EXPECT_GT(std::ranges::count(found_in(mask_, camera, here_).pixels(), 255), 1000);
}

}  // namespace
}  // namespace handcast::renderer
