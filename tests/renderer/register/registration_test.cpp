// SPDX-License-Identifier: Apache-2.0
#include "renderer/register/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace handcast::renderer {
namespace {

constexpr int kWidth = 400, kHeight = 400;
constexpr float kLimit_px = 24;

/// A flat hand: landmarks in MediaPipe's order, fingers up, thumb to the left.
LandmarkPoints flat_hand() {
  LandmarkPoints hand{};
  hand[0] = {200, 320};
  const std::array<glm::vec2, 5> knuckles{
      {{168, 290}, {170, 220}, {193, 214}, {216, 219}, {238, 230}}};
  const std::array<glm::vec2, 5> bones{{{-16, -22}, {-3, -28}, {0, -32}, {3, -28}, {7, -22}}};
  for (int f = 0; f < 5; ++f)
    for (int j = 0; j < 4; ++j)
      hand[1 + 4 * f + j] = knuckles[f] + static_cast<float>(j) * bones[f];
  return hand;
}

float distance_to_bone(glm::vec2 at, glm::vec2 from, glm::vec2 to) {
  const glm::vec2 axis = to - from;
  const float along = std::clamp(glm::dot(at - from, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
  return glm::distance(at, from + along * axis);
}

/// Depth of a point inside the flesh of the hand, px.
float depth(const LandmarkPoints& hand, glm::vec2 at) {
  float deepest = -1000;
  for (int f = 0; f < 5; ++f) {
    for (int j = 0; j < 3; ++j)
      deepest =
          std::max(deepest, 8.5f - distance_to_bone(at, hand[1 + 4 * f + j], hand[2 + 4 * f + j]));
    deepest = std::max(deepest, 16 - distance_to_bone(at, hand[0], hand[1 + 4 * f]));
  }
  return deepest;
}

/// An image and its mask.
struct Picture {
  Image<std::uint8_t> grey{kWidth, kHeight, 10}, mask{kWidth, kHeight, 0};

  void paint(const LandmarkPoints& hand) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const float inside = std::clamp(depth(hand, {x, y}) + 0.5f, 0.0f, 1.0f);
        grey.at(x, y) = std::max(grey.at(x, y), static_cast<std::uint8_t>(10 + 150 * inside));
        mask.at(x, y) = grey.at(x, y) > 85 ? 255 : 0;
      }
  }
  void darken(const Rect& part) {
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1; ++x) {
        grey.at(x, y) = 10;
        mask.at(x, y) = 0;
      }
  }
  Silhouette silhouette() const {
    return {grey.view(), 0, mask.view(), {0, 0, kWidth, kHeight}, 85};
  }
};

Picture picture_of(const LandmarkPoints& hand) {
  Picture picture;
  picture.paint(hand);
  return picture;
}

LandmarkPoints moved(LandmarkPoints hand, glm::vec2 shift, float turn_rad = 0) {
  const glm::vec2 centre(205, 250);
  for (glm::vec2& point : hand) {
    const glm::vec2 v = point - centre;
    point = centre + shift +
            glm::vec2(std::cos(turn_rad) * v.x - std::sin(turn_rad) * v.y,
                      std::sin(turn_rad) * v.x + std::cos(turn_rad) * v.y);
  }
  return hand;
}

LandmarkPoints bent(LandmarkPoints hand, int finger, float turn_rad) {
  const glm::vec2 knuckle = hand[1 + 4 * finger];
  for (int j = 1; j < 4; ++j) {
    const glm::vec2 v = hand[1 + 4 * finger + j] - knuckle;
    hand[1 + 4 * finger + j] =
        knuckle + glm::vec2(std::cos(turn_rad) * v.x - std::sin(turn_rad) * v.y,
                            std::sin(turn_rad) * v.x + std::cos(turn_rad) * v.y);
  }
  return hand;
}

/// Registers a hand that was at `then`, is at `tracker_now` for the tracker, and is seen in
/// `newest`.
Registered registered(const LandmarkPoints& then, const Picture& newest,
                      const LandmarkPoints& tracker_now) {
  static Contour outline;
  find_contour(picture_of(then).silhouette(), outline);
  Registration registration(kLimit_px);
  const HandMotion motion{then, tracker_now};
  return registration.find(outline, newest.silhouette(), std::span(&motion, 1), 0);
}

Registered registered(const LandmarkPoints& then, const Picture& newest) {
  return registered(then, newest, then);
}

double furthest_off(const Registered& result, const LandmarkPoints& start,
                    const LandmarkPoints& truth) {
  double furthest = 0;
  for (int i = 0; i < kLandmarks; ++i)
    furthest = std::max<double>(furthest, glm::distance(start[i] + result.moved[i], truth[i]));
  return furthest;
}

TEST(Contour, IsExactToATenthOfAPixelAndEvenlySpread) {
  const LandmarkPoints hand = flat_hand();
  static Contour contour;
  find_contour(picture_of(hand).silhouette(), contour);
  EXPECT_GT(contour.count, 100);
  EXPECT_LT(contour.count, 300);
  double square = 0;
  for (int i = 0; i < contour.count; ++i) {
    const double off = depth(hand, contour.points_px[i]);
    square += off * off / contour.count;
    EXPECT_LT(depth(hand, contour.points_px[i] + 3.0f * contour.normals[i]),
              depth(hand, contour.points_px[i]))
        << i;
  }
  EXPECT_LT(std::sqrt(square), 0.1);
}

TEST(Contour, OfALongEdgeEveryPartIsTaken) {
  Picture picture;
  for (int y = 8; y < kHeight - 8; ++y)
    for (int x = 8; x < kWidth - 8; ++x)
      if (x % 32 < 16) picture.grey.at(x, y) = 160, picture.mask.at(x, y) = 255;
  static Contour contour;
  find_contour(picture.silhouette(), contour);
  EXPECT_GT(contour.count, Contour::kMostPoints / 2 - 1);
  int above = 0;
  for (int i = 0; i < contour.count; ++i) above += contour.points_px[i].y < kHeight / 2;
  EXPECT_NEAR(above, contour.count / 2, 0.05 * contour.count);
}

TEST(Contour, WhereTheMaskWasCutThereIsNoEdge) {
  Picture picture = picture_of(flat_hand());
  for (int y = 290; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      picture.mask.at(x, y) = 0;  // cut at the forearm; the grey values continue
  static Contour contour;
  find_contour(picture.silhouette(), contour);
  for (int i = 0; i < contour.count; ++i) EXPECT_LT(contour.points_px[i].y, 289.5) << i;
  EXPECT_FALSE(edge_along(picture.silhouette(), {200, 280}, {0, 1}, 20));
}

TEST(Registration, AShiftIsFoundExactly) {
  const LandmarkPoints then = flat_hand();
  for (const glm::vec2 shift : {glm::vec2(0.3f, -0.2f), glm::vec2(4, 2.5f), glm::vec2(-7, 6)}) {
    const LandmarkPoints now = moved(then, shift);
    const Registered result = registered(then, picture_of(now));
    ASSERT_TRUE(result.found) << shift.x;
    EXPECT_LT(furthest_off(result, then, now), 0.25) << shift.x;
    EXPECT_LT(result.after_px, 0.2);
  }
}

TEST(Registration, ATurnIsFoundToo) {
  const LandmarkPoints then = flat_hand(), now = moved(then, {2, -1}, 0.05f);
  const Registered result = registered(then, picture_of(now));
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, then, now), 0.7);
  EXPECT_GT(furthest_off({}, then, now), 5);
}

TEST(Registration, OneFingerIsFollowedAloneAndTheOthersStay) {
  const LandmarkPoints then = flat_hand(), now = bent(then, 1, -0.06f);
  const Registered result = registered(then, picture_of(now));
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, then, now), 1);
  EXPECT_GT(furthest_off({}, then, now), 4.5);
  EXPECT_LT(glm::length(result.moved[16]), 0.4);
}

TEST(Registration, ItStartsFromTheTrackersMotion) {
  const LandmarkPoints then = flat_hand(), now = moved(then, {30, -12}, 0.1f),
                       tracker_now = moved(then, {28, -11}, 0.1f);
  const Registered result = registered(then, picture_of(now), tracker_now);
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, tracker_now, now), 0.4);
}

TEST(Registration, AHandHalfOfWhichIsHiddenIsStillFollowed) {
  const LandmarkPoints then = flat_hand(), now = moved(then, {5, -3});
  Picture newest = picture_of(now);
  newest.darken({0, 0, 195, kHeight});
  const Registered result = registered(then, newest);
  ASSERT_TRUE(result.found);
  for (const int i : {0, 9, 13, 17})
    EXPECT_LT(glm::distance(then[i] + result.moved[i], now[i]), 1.5) << i;
  newest = picture_of(now);
  newest.darken({0, 0, kWidth, 190});  // the finger tips
  const Registered without_tips = registered(then, newest);
  ASSERT_TRUE(without_tips.found);
  for (const int i : {0, 5, 9, 13, 17})
    EXPECT_LT(glm::distance(then[i] + without_tips.moved[i], now[i]), 1) << i;
}

TEST(Registration, HolesInTheMaskDoNoHarm) {
  const LandmarkPoints then = flat_hand(), now = moved(then, {-4, 3});
  Picture newest = picture_of(now);
  std::mt19937 random(3);
  for (int i = 0; i < 14; ++i) {
    const int x = 150 + static_cast<int>(random() % 100),
              y = 130 + static_cast<int>(random() % 190);
    newest.darken({x, y, x + 7, y + 7});
  }
  const Registered result = registered(then, newest);
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, then, now), 1.2);
}

TEST(Registration, GarbageInPlaceOfAMaskMovesNothing) {
  const LandmarkPoints then = flat_hand();
  std::mt19937 random(5);
  Picture noise, blob, dark;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto put = [&](Picture& picture, bool lit) {
        picture.grey.at(x, y) = lit ? 160 : 10;
        picture.mask.at(x, y) = lit ? 255 : 0;
      };
      put(noise, random() % 2 == 0);
      put(blob, glm::distance(glm::vec2(x, y), glm::vec2(205, 240)) < 95);
    }
  for (const Picture* garbage : {&noise, &blob, &dark}) {
    const Registered result = registered(then, *garbage);
    EXPECT_FALSE(result.found);
    for (const glm::vec2& each : result.moved) EXPECT_EQ(each, glm::vec2(0));
  }
}

TEST(Registration, AJumpBeyondTheLimitIsNotBelieved) {
  const LandmarkPoints then = flat_hand();
  for (const float jump_px : {0.6f * kLimit_px, 0.8f * kLimit_px}) {
    const LandmarkPoints now = moved(then, {0, -jump_px});
    const Registered result = registered(then, picture_of(now));
    ASSERT_TRUE(result.found) << jump_px;
    EXPECT_LT(furthest_off(result, then, now), 3) << jump_px;
  }
  // Just beyond the limit, fingers are taken for their neighbours, which moves the hand part of the
  // way.
  const LandmarkPoints beyond = moved(then, {0, -1.4f * kLimit_px});
  EXPECT_LT(furthest_off(registered(then, picture_of(beyond)), then, beyond), 1.4f * kLimit_px);
  for (const float jump_px : {2 * kLimit_px, 4 * kLimit_px}) {
    const Registered result = registered(then, picture_of(moved(then, {0, -jump_px})));
    EXPECT_FALSE(result.found) << jump_px;
    for (const glm::vec2& each : result.moved) EXPECT_EQ(each, glm::vec2(0)) << jump_px;
  }
}

TEST(Registration, AnotherHandThatCrossesDoesNotPullItAlong) {
  const LandmarkPoints then = flat_hand(), now = moved(then, {3, -2});
  const LandmarkPoints other_then = moved(then, {-60, 40}, 1.2f),
                       other_now = moved(then, {-72, 49}, 1.2f);
  Picture before = picture_of(then), newest = picture_of(now);
  before.paint(other_then);
  newest.paint(other_now);
  static Contour outline;
  find_contour(before.silhouette(), outline);
  Registration registration(kLimit_px);
  const std::array<HandMotion, 2> hands{{{then, then}, {other_then, other_then}}};
  const Registered result = registration.find(outline, newest.silhouette(), hands, 0);
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, then, now), 1.5);
}

TEST(Registration, AStillHandStaysWhereItIsInSpiteOfNoise) {
  const LandmarkPoints then = flat_hand();
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 2);
  Picture newest = picture_of(then);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      newest.grey.at(x, y) = static_cast<std::uint8_t>(
          std::clamp(static_cast<float>(newest.grey.at(x, y)) + noise(random), 0.0f, 255.0f));
      newest.mask.at(x, y) = newest.grey.at(x, y) > 85 ? 255 : 0;
    }
  const Registered result = registered(then, newest);
  ASSERT_TRUE(result.found);
  EXPECT_LT(furthest_off(result, then, then), 0.15);
}

}  // namespace
}  // namespace handcast::renderer
