// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/presence.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

TEST(Presence, AHandThatIsTrackedIsAllThere) {
  Presence presence;
  for (int ms = 0; ms < 500; ms += 1)
    EXPECT_EQ(presence.at(ms * kMs, (ms - ms % 9 - 14) * kMs, std::nullopt), 1) << ms;
}

TEST(Presence, ASlowSensorDoesNotMakeTheLightFlicker) {
  for (const int interval_ms : {50, 66, 100}) {  // a webcam, whose landmarks are 60 ms old
    Presence presence;
    for (int ms = 1000; ms < 3000; ++ms) {
      const auto seen_ns = (ms - ms % interval_ms - 60) * kMs;
      const float share = presence.at(ms * kMs, seen_ns, seen_ns);
      ASSERT_TRUE(share == 1 || ms < 2000) << share << ' ' << interval_ms << " at " << ms;
    }
    EXPECT_EQ(presence.at(3700 * kMs, 2940 * kMs, 2940 * kMs), 0) << "then it is gone";
  }
}

/// The share of light in every millisecond after a last tracker sample at 0 ms.
std::vector<float> silent_for(int last_ms, std::optional<std::int64_t> seen_every_ms) {
  Presence presence;
  std::vector<float> levels;
  for (int ms = 0; ms < last_ms; ++ms)
    levels.push_back(presence.at(
        ms * kMs, 0,
        seen_every_ms ? std::optional((ms - ms % *seen_every_ms - 16) * kMs) : std::nullopt));
  return levels;
}

TEST(Presence, WithoutTrackerOrLandmarksTheLightFadesOutAndDoesNotStep) {
  const auto levels = silent_for(300, std::nullopt);
  EXPECT_EQ(levels[90], 1);
  EXPECT_GT(levels[150], 0.3f);
  EXPECT_LT(levels[150], 0.7f);
  EXPECT_EQ(levels[201], 0);
  for (std::size_t ms = 1; ms < levels.size(); ++ms) {
    EXPECT_LE(levels[ms], levels[ms - 1]);
    EXPECT_GT(levels[ms], levels[ms - 1] - 0.02f);
  }
}

TEST(Presence, LandmarksCarryTheLightOnButNotForEver) {
  const auto levels = silent_for(1000, 16);
  EXPECT_EQ(levels[700], 1);
  EXPECT_EQ(levels[901], 0);
}

TEST(Presence, WhenTheLandmarksGoTooTheLightFades) {
  Presence presence;
  EXPECT_EQ(presence.at(300 * kMs, 0, 280 * kMs), 1);
  EXPECT_LT(presence.at(400 * kMs, 0, 280 * kMs), 1);
  EXPECT_EQ(presence.at(480 * kMs, 0, 280 * kMs), 0);
}

TEST(Presence, AHandComesBackWithoutAFlash) {
  Presence presence;
  presence.no_hand(1000 * kMs);
  float before = 0;
  for (int ms = 1001; ms < 1040; ++ms) {
    const float now = presence.at(ms * kMs, (ms - 10) * kMs, std::nullopt);
    EXPECT_LE(now, before + 0.04f);
    before = now;
  }
  EXPECT_EQ(before, 1);
}

TEST(Sight, AHandThatIsNotSeenForAMomentHardlyDims) {
  Sight sight;
  EXPECT_EQ(sight.at(0, true), 1);
  EXPECT_GT(sight.at(4 * kMs, false), 0.99f);
  EXPECT_EQ(sight.at(8 * kMs, true), 1);
}

TEST(Sight, AHandThatIsSeenNoMoreFadesInATenthOfASecondAndComesBackWithoutAFlash) {
  Sight sight;
  float before = sight.at(0, true);
  for (int ms = 1; ms <= 400; ++ms) {
    const bool seen = ms > 300;
    const float now = sight.at(ms * kMs, seen);
    EXPECT_GT(now, before - 0.02f) << ms;
    EXPECT_LE(now, before + (seen ? 0.04f : 0.0f)) << ms;
    if (ms == 50) {
      EXPECT_NEAR(now, 0.5f, 0.01f);
    }
    if (ms >= 100 && !seen) {
      EXPECT_EQ(now, 0) << ms;
    }
    before = now;
  }
  EXPECT_EQ(before, 1);
}

TEST(Sight, AHandThatWasNeverSeenIsDark) {
  Sight sight;
  EXPECT_EQ(sight.at(0, false), 0);
  EXPECT_EQ(sight.at(20 * kMs, false), 0);
}

/// The mean red of the lit pixels, and their number.
std::pair<double, int> brightness(const Frame& frame) {
  double sum = 0;
  int count = 0;
  for (int y = frame.region.y0; y < frame.region.y1; ++y)
    for (int x = frame.region.x0; x < frame.region.x1; ++x)
      if (frame.colour.at(x, y) >> 24) sum += frame.colour.at(x, y) & 255, ++count;
  return {count ? sum / count : 0, count};
}

TEST(FadingLight, AHandTheTrackerLostFadesOutAndWhatWasFilledWithIt) {
  const auto calibration = rig_above_hand();
  config::Content white;
  white.left = "builtin:white";
  for (const float shading : {0.0f, 0.5f}) {
    white.shading = shading;
    const auto pipeline = *Pipeline::create({}, white, {}, calibration);
    const auto hand = pose_of(Side::left);
    const auto image =
        image_of(calibration, {hand}, {6, 0});  // the fill has to light a strip of the hand
    for (std::int64_t t = 0; t <= 99 * kMs; t += 9 * kMs)
      pipeline->push(t + 9 * kMs, poses_of(t, {hand}));
    const auto [full, full_px] =
        brightness(pipeline->render(150 * kMs, 154 * kMs, {image.view(), 148 * kMs}));
    const Frame faded = pipeline->render(245 * kMs, 249 * kMs, {image.view(), 243 * kMs});
    const auto [half, half_px] = brightness(faded);
    EXPECT_NEAR(half / full, 0.5, 0.05) << shading;
    EXPECT_NEAR(half_px, full_px, 0.01 * full_px);
    EXPECT_GT(faded.fill.filled, 500);
    std::uint32_t brightest = 0;
    for (int y = faded.region.y0; y < faded.region.y1; ++y)
      for (int x = faded.region.x0; x < faded.region.x1; ++x)
        brightest = std::max(brightest, faded.colour.at(x, y) & 255);
    EXPECT_LT(brightest, 0.6 * 255);
  }
}

/// A still hand; the camera is covered for a while. Frames every 2 ms.
TEST(FadingLight, ACoveredCameraDimsTheLightWhereItIsUntilItIsOut) {
  const auto calibration = rig_above_hand();
  config::Content white;
  white.left = "builtin:white";
  const auto pipeline = *Pipeline::create({}, white, {}, calibration);
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand});
  const Image<std::uint8_t> dark(image.width(), image.height(), 3);
  double full = 0;
  int full_px = 0;
  for (std::int64_t ms = 100; ms < 500; ms += 2) {
    if (ms % 8 == 0) pipeline->push(ms * kMs, poses_of((ms - 9) * kMs, {hand}));
    const bool covered = ms >= 200 && ms < 400;
    const auto [level, count] = brightness(pipeline->render(
        ms * kMs, (ms + 4) * kMs, {(covered ? dark : image).view(), (ms - 2) * kMs}));
    if (ms == 198) full = level, full_px = count;
    if (ms == 210) {
      EXPECT_GT(level, 0.95 * full);
    }
    if (ms >= 200 && ms < 290) {
      EXPECT_NEAR(count, full_px, 0.01 * full_px) << ms;
    }
    if (ms >= 302 && ms < 400) {
      EXPECT_EQ(count, 0) << ms;
    }
    if (ms == 404) {
      EXPECT_LT(level, 0.3 * full);
    }
    if (ms == 440) {
      EXPECT_NEAR(level, full, 0.01 * full);
    }
  }
  EXPECT_GT(full, 200);
}

/// One of two hands is covered; the other keeps its light.
TEST(FadingLight, AHandThatIsCoveredFadesAloneAndMovesOnWithItsHand) {
  const auto calibration = rig_above_hand();
  config::Content white;
  white.left = white.right = "builtin:white";
  const auto pipeline = *Pipeline::create({}, white, {}, calibration);
  const auto still = pose_of(Side::left, {-0.11f, 0, 0});
  const auto moving = [](std::int64_t ms) {
    return pose_of(Side::right, {0.1f + 3e-4f * static_cast<float>(ms - 200), 0, 0});
  };
  double full[2] = {}, last_x = 0;
  for (std::int64_t ms = 100; ms < 340; ms += 10) {
    pipeline->push(ms * kMs, poses_of((ms - 9) * kMs, {still, moving(ms - 9)}));
    const auto image =
        ms < 200 ? image_of(calibration, {still, moving(ms - 2)}) : image_of(calibration, {still});
    const Frame frame = pipeline->render(ms * kMs, (ms + 4) * kMs, {image.view(), (ms - 2) * kMs});
    double sum[2] = {}, across = 0;
    const auto middle = static_cast<int>(
        calibration.projector
            .pixel_of(calibration.camera.project(in_camera(calibration, {0, 0, 0})))
            .x);
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) {
        if (!(frame.colour.at(x, y) >> 24)) continue;
        sum[x > middle] += frame.colour.at(x, y) & 255;
        if (x > middle) across += static_cast<double>(frame.colour.at(x, y) & 255) * x;
      }
    if (ms == 190) full[0] = sum[0], full[1] = sum[1];
    if (ms < 190) continue;
    EXPECT_NEAR(sum[0] / full[0], 1, 0.02) << ms;
    if (ms > 190 && ms <= 250) {
      EXPECT_GT(across / sum[1], last_x + 2) << ms;
    }
    last_x = sum[1] > 0 ? across / sum[1] : 0;
    if (ms == 250) {
      EXPECT_NEAR(sum[1] / full[1], 0.4, 0.1);
    }
    if (ms >= 310) {
      EXPECT_EQ(sum[1], 0) << ms;
    }
  }
}

}  // namespace
}  // namespace handcast::renderer
