// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/hand_pipeline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::renderer {
namespace {

/// A left hand that sways, a tracker that is 9 ms old and off by 5 mm, and a detector that is 16 ms
/// old and right. Tests set the faults.
class Rig {
 public:
  Rig()
      : hand_(*HandPipeline::load(Side::left, on_landmarks(), {.left = "builtin:white"}, {},
                                  calibration_, {})) {}

  std::function<glm::vec3(std::int64_t ms)> way = [](std::int64_t ms) {
    return glm::vec3(0.06f * static_cast<float>(std::sin(2 * std::numbers::pi * 1.2 *
                                                         static_cast<double>(ms) * 1e-3)),
                     0, 0);
  };
  /// The error of the tracker, m; empty if there is no sample.
  std::function<std::optional<glm::vec3>(std::int64_t ms)> tracker = [](std::int64_t) {
    return glm::vec3(0);
  };
  /// The time of the pose that the tracker reports for `ms`.
  std::function<std::int64_t(std::int64_t ms)> sampled = [](std::int64_t ms) { return ms; };
  std::function<bool(std::int64_t ms)> detects = [](std::int64_t) { return true; };

  /// Runs to `until_ms` and calls `each` with the time and the predicted frame, every millisecond.
  template <class Each>
  void run(int until_ms, Each each) {
    for (std::int64_t ms = 0; ms < until_ms; ++ms) {
      const std::int64_t sampled_ms = ms - 9, seen_ms = ms - 16;
      if (ms % 9 == 0 && sampled_ms >= 0)
        if (const auto error = tracker(sampled_ms))
          hand_.push(ms * kMs, sampled_ms * kMs,
                     pose_of(Side::left, way(sampled(sampled_ms)) + *error + kBias));
      if (ms % 16 == 0 && seen_ms >= 0 && detects(seen_ms)) {
        const auto seen =
            landmarks_of(calibration_, seen_ms * kMs, pose_of(Side::left, way(seen_ms)), {0, 0});
        hand_.push(ms * kMs, seen_ms * kMs, seen.hands[0]);
      }
      each(ms, hand_.predict(ms * kMs, (ms + 4) * kMs));
    }
  }

  /// Mean error of the corrected landmarks, px.
  double error_px(std::int64_t ms, const HandFrame& frame) const {
    const auto truth = *project_landmarks(calibration_, pose_of(Side::left, way(ms + 4)));
    double sum = 0;
    for (int i = 0; i < kLandmarks; ++i)
      sum += glm::distance(truth[i], frame.corrected.landmarks[i]);
    return sum / kLandmarks;
  }

  /// The largest error_px() after 300 ms.
  double worst_px(int until_ms) {
    double worst = 0;
    run(until_ms, [&](std::int64_t ms, const auto& tracked) {
      if (ms > 300) worst = std::max(worst, tracked ? error_px(ms, *tracked) : 1e3);
    });
    return worst;
  }

 private:
  /// Without late registration, which needs images.
  static config::Cascade on_landmarks() {
    config::Cascade settings;
    settings.ladder.rung = config::RungChoice::landmarks;
    return settings;
  }

  static constexpr glm::vec3 kBias{0.005f, 0, 0};
  calib::Calibration calibration_ = rig_above_hand();
  HandPipeline hand_;
};

TEST(HandPipeline, AHandThatIsTrackedAndSeenIsExact) { EXPECT_LT(Rig().worst_px(600), 3); }

TEST(HandPipeline, ATrackerThatReplacesItsHandDoesNotMoveTheLight) {
  Rig rig;
  rig.tracker = [](std::int64_t ms) {
    return glm::vec3(ms < 400 ? 0 : 0.05f, 0, ms < 400 ? 0 : -0.03f);
  };
  EXPECT_LT(rig.worst_px(700), 6);
}

TEST(HandPipeline, AWildSampleOfTheTrackerDoesNotMoveTheLight) {
  for (const float far_m : {0.03f, 0.05f, 0.2f}) {
    Rig rig;
    rig.tracker = [far_m](std::int64_t ms) {
      return glm::vec3(ms >= 400 && ms < 409 ? far_m : 0, 0, 0);
    };
    EXPECT_LT(rig.worst_px(700), 6) << far_m;
  }
}

TEST(HandPipeline, AFrozenTrackerIsNotFollowed) {
  Rig rig;
  rig.sampled = [](std::int64_t ms) { return ms >= 405 && ms < 700 ? 396 : ms; };
  EXPECT_LT(rig.worst_px(1000), 8);
}

TEST(HandPipeline, ATrackerThatStandsStillBesideAMovingHandIsNotBelieved) {
  Rig rig;
  rig.sampled = [](std::int64_t ms) { return ms >= 405 && ms < 700 ? 396 : ms; };
  // No two samples are the same.
  rig.tracker = [](std::int64_t ms) { return glm::vec3(0, 1e-5f * static_cast<float>(ms % 7), 0); };
  EXPECT_LT(rig.worst_px(1000), 60);
}

TEST(HandPipeline, WhileTheTrackerIsSilentTheLandmarksGoOnAlone) {
  Rig rig;
  rig.tracker = [](std::int64_t ms) {
    return ms >= 400 && ms < 700 ? std::nullopt : std::optional(glm::vec3(0));
  };
  bool was_alone = false;
  rig.run(1000, [&](std::int64_t ms, const auto& tracked) {
    if (ms < 300) return;
    ASSERT_TRUE(tracked) << ms;
    EXPECT_LT(rig.error_px(ms, *tracked), 8) << ms;
    EXPECT_EQ(tracked->presence, 1) << ms;
    was_alone = was_alone || tracked->corrected.is_alone;
    if (ms > 760) {
      EXPECT_FALSE(tracked->corrected.is_alone) << ms;
    }
  });
  EXPECT_TRUE(was_alone);
}

TEST(HandPipeline, WhenTrackerAndDetectorAreLostTheLightStaysAndFades) {
  Rig rig;
  rig.way = [](std::int64_t) { return glm::vec3(0); };
  rig.tracker = [](std::int64_t ms) {
    return ms >= 400 ? std::nullopt : std::optional(glm::vec3(0));
  };
  rig.detects = [](std::int64_t ms) { return ms < 400; };
  float before = 1;
  rig.run(800, [&](std::int64_t ms, const auto& tracked) {
    if (ms < 300) return;
    const float level = tracked ? tracked->presence : 0;
    EXPECT_LE(level, before);
    EXPECT_GT(level, before - 0.03f) << ms;
    if (tracked) {
      EXPECT_LT(rig.error_px(ms, *tracked), 2) << ms;
    }
    before = level;
  });
  EXPECT_EQ(before, 0);
}

TEST(HandPipeline, FastMotionAndReversalsAreNotTakenForJumps) {
  for (const bool zigzag : {false, true}) {
    Rig rig;
    // From 0 to 2 m/s in 100 ms; or to and fro at 2 m/s, with reversals within 20 ms.
    rig.way = [zigzag](std::int64_t ms) {
      const double s = static_cast<double>(ms) * 1e-3, sharp = 0.97;
      const double x = zigzag ? 0.1 * std::asin(sharp * std::sin(2 * std::numbers::pi * 5 * s)) /
                                    (std::numbers::pi / 2)
                              : (s < 0.35 ? 0
                                          : 10 * std::pow(std::min(s - 0.35, 0.1), 2) +
                                                2 * std::max(0.0, s - 0.45));
      return glm::vec3(static_cast<float>(x), 0, 0);
    };
    rig.run(550, [&](std::int64_t ms, const auto& tracked) {
      if (ms > 300 && tracked) {
        EXPECT_FALSE(tracked->corrected.is_alone) << ms << zigzag;
      }
    });
  }
}

/// What is skinned of a hand at rest.
struct Drawn {
  LandmarkPoints joints_px;
  std::vector<glm::vec2> skin_px;
};

/// A hand with fingers bent by these angles at two joints, deg, whose landmarks are seen, while the
/// tracker reports them bent by others.
Drawn drawn(float true_deg, float reported_deg, config::FilterMethod method) {
  const auto calibration = rig_above_hand();
  const auto pose_with = [](float bent_deg) {
    const std::array<float, 4> finger{0, bent_deg, bent_deg - 5, 20};
    const samples::Pose bent{"", {}, {finger, finger, finger, finger}};
    return pose_of(Side::left, samples::posed(*load_hand_or_default({}, Side::left), bent));
  };
  config::Cascade settings;
  settings.ladder.rung = config::RungChoice::landmarks;
  settings.filter.method = method;
  auto hand =
      *HandPipeline::load(Side::left, settings, {.left = "builtin:white"}, {}, calibration, {});
  const auto seen = landmarks_of(calibration, 0, pose_with(true_deg), {}).hands[0];
  for (std::int64_t ms = 0; ms < 400; ++ms) {
    if (ms % 9 == 0) hand.push(ms * kMs, ms * kMs, pose_with(reported_deg));
    if (ms % 16 == 0) hand.push(ms * kMs, ms * kMs, seen);
  }
  auto frame = *hand.predict(400 * kMs, 404 * kMs);
  hand.skin(frame, 0);
  const auto& skin_px = frame.skinned->seen_px;
  return {frame.drawn.landmarks, {skin_px.begin(), skin_px.end()}};
}

/// The mean distance of the joints of finger tips, px.
float tips_off_px(const Drawn& a, const Drawn& b) {
  float sum_px = 0;
  for (const int tip : {8, 12, 16, 20}) sum_px += glm::distance(a.joints_px[tip], b.joints_px[tip]);
  return sum_px / 4;
}

float skin_off_px(const Drawn& a, const Drawn& b) {
  float sum_px = 0;
  for (std::size_t i = 0; i < a.skin_px.size(); ++i)
    sum_px += glm::distance(a.skin_px[i], b.skin_px[i]);
  return sum_px / static_cast<float>(a.skin_px.size());
}

TEST(HandPipeline, FingersAreDrawnAsBentAsTheLandmarksShow) {
  using config::FilterMethod;
  const auto truth = drawn(50, 50, FilterMethod::paper),
             straight = drawn(50, 38, FilterMethod::paper),
             bent = drawn(50, 38, FilterMethod::articulated);
  EXPECT_GT(tips_off_px(straight, truth), 10);
  EXPECT_LT(tips_off_px(bent, truth), 0.4f * tips_off_px(straight, truth));
  EXPECT_LT(skin_off_px(bent, truth), 0.5f * skin_off_px(straight, truth));
}

TEST(HandPipeline, AStillHandOfAFlawlessTrackerIsNotTakenForFrozen) {
  Rig rig;
  rig.way = [](std::int64_t) { return glm::vec3(0); };
  rig.run(600, [&](std::int64_t ms, const auto& tracked) {
    if (ms > 50) {
      EXPECT_TRUE(tracked && !tracked->corrected.is_alone && tracked->presence == 1) << ms;
    }
  });
}

}  // namespace
}  // namespace handcast::renderer
