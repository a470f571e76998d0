// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/gate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config/settings/choice.hpp"
#include "renderer/filter/landmark_track.hpp"
#include "renderer/ladder/hand_ladder.hpp"
#include "renderer/ladder/hindsight.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

constexpr double kFrame_ms = 1000.0 / 946;

/// A hand in slow motion whose Q̂ - P only all landmarks can follow.
Evidence in_motion() {
  Evidence evidence;
  evidence.hold_px2 = 9;
  evidence.predict_px2 = 0.25f;
  evidence.register_px2 = 0.25f;
  evidence.left_px2 = {100, 100, 16, 9, 4, 0, 0};
  evidence.landmark_px2 = 0.25f;
  evidence.has_landmarks = true;
  evidence.can_register = true;
  return evidence;
}

/// A hand at rest whose tracker is right: Q̂ - P is only the noise of the landmarks.
Evidence at_rest() {
  Evidence evidence = in_motion();
  evidence.hold_px2 = evidence.predict_px2 = evidence.register_px2 = 0.01f;
  evidence.left_px2 = {0.25f, 0.25f, 0.24f, 0.22f, 0.16f, 0, 0};
  return evidence;
}

Rung settled(const Evidence& evidence) { return Gate(config::Ladder{}).choose(0, evidence); }

TEST(Gate, TheCheapestRungThatIsNearlyTheBestIsTaken) {
  EXPECT_EQ(settled(in_motion()), Rung::landmarks) << "registration gains nothing";
  EXPECT_EQ(settled(at_rest()), Rung::hold);
  Evidence fast = in_motion();
  fast.predict_px2 = 16;
  EXPECT_EQ(settled(fast), Rung::registered);
  Evidence stiff = in_motion();
  stiff.left_px2 = {100, 100, 16, 0.2f, 0.15f, 0, 0};
  EXPECT_EQ(settled(stiff), Rung::similarity);
}

TEST(Gate, NoisyLandmarksAreFollowedWithFewerNumbers) {
  Evidence noisy = in_motion();
  noisy.left_px2 = {41, 41, 16, 15, 11, 0, 0};  // a shift of 5 px under 4 px of noise
  noisy.landmark_px2 = 16;
  EXPECT_EQ(settled(noisy), Rung::shift);
  const auto errors = expected_errors_px(noisy);
  EXPECT_LT(errors[2], 0.5f * errors[5]);
}

TEST(Gate, LandmarksThatDoNotMoveWithTheTrackerAreNotChargedWithItsPrediction) {
  Evidence fast = in_motion();
  fast.hold_px2 = fast.predict_px2 = 100;
  fast.can_register = false;
  fast.left_px2 = {9, 9, 8, 7, 6, 0, 0};
  EXPECT_LT(settled(fast), Rung::landmarks)
      << "the error of the prediction is the same on all rungs";
  fast.lag_px2 = 0;
  EXPECT_EQ(settled(fast), Rung::landmarks);
  fast.lag_px2 = 900;
  EXPECT_EQ(settled(fast), Rung::hold) << "landmarks of this age are worse than the tracker alone";
}

TEST(Gate, WithoutLandmarksOnlyTheTrackersOwnRungsAreThereAndWithoutAnImageNoRegistration) {
  Evidence evidence = in_motion();
  evidence.predict_px2 = 16;
  evidence.can_register = false;
  EXPECT_EQ(settled(evidence), Rung::landmarks);
  evidence.has_landmarks = false;
  evidence.can_register = true;
  // Of two rungs with large errors, the one with the smaller error is taken.
  EXPECT_EQ(settled(evidence), Rung::hold);
  evidence.hold_px2 = 400;
  EXPECT_EQ(settled(evidence), Rung::predict);
}

TEST(Gate, ADearerRungIsTakenAtOnceACheaperOneOnlyAfterItHasProvenEnough) {
  Gate gate{config::Ladder{}};
  EXPECT_EQ(gate.choose(0, at_rest()), Rung::hold);
  EXPECT_EQ(gate.choose(1 * kMs, in_motion()), Rung::landmarks);
  for (int ms = 2; ms < 52; ++ms)
    ASSERT_EQ(gate.choose(ms * kMs, at_rest()), Rung::landmarks) << ms << " ms";
  EXPECT_EQ(gate.choose(52 * kMs, at_rest()), Rung::hold);
}

TEST(Gate, AHandThatMovesNowAndThenKeepsTheDearerRung) {
  Gate gate{config::Ladder{}};
  gate.choose(0, in_motion());
  for (int ms = 1; ms < 1000; ++ms)
    ASSERT_EQ(gate.choose(ms * kMs, ms % 40 == 0 ? in_motion() : at_rest()), Rung::landmarks);
}

TEST(RungBlend, ASwitchIsLetInLittleByLittleAndThenWhole) {
  RungBlend blend;
  blend.turn_to(Rung::shift, 0, 6);
  ASSERT_TRUE(blend.is_pure(Rung::shift)) << "there is no earlier frame";
  const double most = 1 - std::exp(-kFrame_ms / 6) + 0.02;
  float before = 0;
  int frames = 0;
  for (; !blend.is_pure(Rung::landmarks); ++frames) {
    ASSERT_LT(frames, 40);
    blend.turn_to(Rung::landmarks, static_cast<std::int64_t>((frames + 1) * kFrame_ms * 1e6), 6);
    EXPECT_LE(blend.share(Rung::landmarks) - before, most);
    EXPECT_NEAR(blend.share(Rung::shift) + blend.share(Rung::landmarks), 1, 1e-5);
    before = blend.share(Rung::landmarks);
  }
  EXPECT_GT(frames, 6);
}

msg::HandPose moving(std::int64_t time_ns, float speed_m_s) {
  return pose_of(Side::left, {speed_m_s * static_cast<float>(time_ns) * 1e-9f, 0, 0});
}

TEST(Hindsight, TellsWhatTheLightWasOffBy) {
  const auto calibration = rig_above_hand();
  HandTrack track({}, calibration);
  Hindsight hindsight;
  constexpr float kSpeed_m_s = 0.3f;
  const auto seen_at = [&](std::int64_t time_ns) {
    return *project_landmarks(calibration, moving(time_ns, kSpeed_m_s));
  };
  for (std::int64_t now_ns = 0; now_ns < 300 * kMs; now_ns += kMs) {
    if (now_ns % (9 * kMs) == 0) track.push(now_ns, now_ns, moving(now_ns, kSpeed_m_s));
    hindsight.look_back(track);
    const std::int64_t target_ns = now_ns + 5 * kMs;
    if (!hindsight.wants(target_ns)) continue;
    hindsight.remember({target_ns, now_ns - 2 * kMs, track.newest_ns(), seen_at(track.newest_ns()),
                        seen_at(now_ns - 2 * kMs), seen_at(target_ns)});
  }
  const float px_a_ms = glm::distance(seen_at(0)[9], seen_at(100 * kMs)[9]) / 100;
  EXPECT_NEAR(hindsight.motion().hold_px, 9 * px_a_ms, 4 * px_a_ms)
      << "the newest sample is 5 to 14 ms older than the light";
  EXPECT_LT(hindsight.motion().predict_px, 0.05f) << "the prediction was right";
  EXPECT_LT(hindsight.motion().register_px, 1);
}

TEST(Hindsight, AFewMomentsThatNothingFollowsDoNotHideWhatRegistrationGainsInTheOthers) {
  const auto calibration = rig_above_hand();
  HandTrack track({}, calibration);
  Hindsight hindsight;
  const LandmarkPoints there = *project_landmarks(calibration, pose_of(Side::left));
  const auto off_by = [&](float px) {
    LandmarkPoints points = there;
    for (glm::vec2& point : points) point.x += px;
    return points;
  };
  int frames = 0;
  for (std::int64_t now_ns = 0; now_ns < 1500 * kMs; now_ns += kMs) {
    if (now_ns % (9 * kMs) == 0) track.push(now_ns, now_ns, pose_of(Side::left));
    hindsight.look_back(track);
    const std::int64_t target_ns = now_ns + 5 * kMs;
    if (!hindsight.wants(target_ns)) continue;
    const bool lost = ++frames % 10 == 0;
    hindsight.remember(
        {target_ns, now_ns - 2 * kMs, track.newest_ns(), there, there, off_by(lost ? 20 : 3)});
    LandmarkPoints moved_px{};
    if (!lost) moved_px.fill({-2, 0});
    hindsight.registered(target_ns, moved_px);
  }
  EXPECT_GT(hindsight.motion().predict_px, 1.15f * hindsight.motion().register_px);
}

TEST(Hindsight, TheErrorOfRegistrationFallsAlsoIfAllPredictionsWereExact) {
  const auto calibration = rig_above_hand();
  HandTrack track({}, calibration);
  constexpr int kFrames = 100, kRegistered = 5;
  constexpr std::int64_t kStart_ns = 3'600'000 * kMs;
  const LandmarkPoints there = *project_landmarks(calibration, pose_of(Side::left));
  Hindsight hindsight;
  for (int i = 0; i < kFrames; ++i) {
    const std::int64_t now_ns = kStart_ns + i * 9 * kMs, target_ns = now_ns + 5 * kMs;
    track.push(now_ns, now_ns, pose_of(Side::left));
    hindsight.look_back(track);
    hindsight.remember({target_ns, now_ns, now_ns, there, there, there});
    LandmarkPoints moved_px{};
    moved_px.fill({2, 0});
    if (i < kRegistered) hindsight.registered(target_ns, moved_px);
  }
  EXPECT_LT(hindsight.motion().register_px, 0.5f) << "no estimate divided by 0";
}

/// The landmarks of each frame while Q̂ - P changes from 0 to 6 px at once.
std::vector<LandmarkPoints> lit_over_a_climb(std::vector<Rung>& rungs) {
  const auto calibration = rig_above_hand();
  config::Cascade settings;
  HandTrack track(settings.predict, calibration);
  LandmarkTrack landmarks(settings.filter);
  HandLadder ladder(settings);
  std::vector<LandmarkPoints> lit;
  for (int i = 0; i < 400; ++i) {
    const auto now_ns = static_cast<std::int64_t>(i * kFrame_ms * 1e6),
               target_ns = now_ns + 4 * kMs;
    if (i % 9 == 0) track.push(now_ns, now_ns, pose_of(Side::left));
    const auto predicted = *track.predict(now_ns, target_ns);
    auto filtered = landmarks.filter(now_ns, target_ns, predicted);
    filtered.has_landmarks = true;
    if (i > 200)
      for (glm::vec2& point : filtered.landmarks) point.x += 6;
    const auto corrected = ladder.take(track, target_ns, std::nullopt, predicted, filtered);
    rungs.push_back(corrected.rung);
    lit.push_back(corrected.landmarks);
  }
  return lit;
}

TEST(Ladder, ASwitchOfRungDoesNotMakeTheLightJump) {
  std::vector<Rung> rungs;
  const auto lit = lit_over_a_climb(rungs);
  EXPECT_LT(rungs[200], Rung::shift);
  EXPECT_EQ(rungs[201], Rung::shift);
  EXPECT_NEAR(lit.back()[9].x - lit[200][9].x, 6, 0.1f);
  for (std::size_t i = 1; i < lit.size(); ++i)
    for (int k = 0; k < kLandmarks; ++k)
      ASSERT_LT(glm::distance(lit[i][k], lit[i - 1][k]), 0.25f * 6) << "frame " << i;
}

/// The largest error of the light, and the share of frames on `rung` or below, for a hand that
/// moves to and fro at up to 0.7 m/s. The tracker is 9 ms old, the detector 16 ms; they differ by
/// `off_px`.
struct Ride {
  float worst_px = 0;
  double share = 0;
  bool registered = false;
};

Ride ride(config::FilterMethod filter, Rung rung, glm::vec2 off_px) {
  const auto calibration = rig_above_hand();
  config::Cascade settings;
  settings.filter.method = filter;
  const auto hand_at = [](std::int64_t time_ns) {
    return pose_of(
        Side::left,
        {0.04f * static_cast<float>(std::sin(18e-9 * static_cast<double>(time_ns))), 0, 0});
  };
  const auto truth = [&](Side, std::int64_t time_ns) {
    LandmarkPoints points = *project_landmarks(calibration, hand_at(time_ns));
    for (glm::vec2& point : points) point += off_px;
    return std::optional(points);
  };
  const auto pipeline = *Pipeline::create(settings, {}, {}, calibration, truth);
  const Image<std::uint8_t> image = image_of(calibration, {pose_of(Side::left)});
  Ride ride;
  int frames = 0;
  for (std::int64_t ms = 0; ms < 900; ++ms) {
    if (ms % 9 == 0 && ms > 9)
      pipeline->push(ms * kMs, poses_of((ms - 9) * kMs, {hand_at((ms - 9) * kMs)}));
    if (ms % 16 == 0 && ms > 16)
      pipeline->push(ms * kMs,
                     landmarks_of(calibration, (ms - 16) * kMs, hand_at((ms - 16) * kMs), off_px));
    if (ms % 100 == 50) pipeline->render(ms * kMs, (ms + 4) * kMs, {image.view(), (ms - 3) * kMs});
    const auto hands = pipeline->track(ms * kMs, (ms + 4) * kMs);
    if (ms < 300 || hands.empty()) continue;
    ++frames;
    ride.share += hands[0].rung <= rung;
    ride.registered = ride.registered || hands[0].rung == Rung::registered;
    const LandmarkPoints there = *truth(Side::left, (ms + 4) * kMs);
    for (int i = 0; i < kLandmarks; ++i)
      ride.worst_px = std::max(ride.worst_px, glm::distance(hands[0].corrected[i], there[i]));
  }
  ride.share /= frames;
  return ride;
}

TEST(Ladder, WhatAnOracleSaysIsTakenAsItIs) {
  const Ride ideal = ride(config::FilterMethod::ideal, Rung::predict, {0, 0});
  EXPECT_LT(ideal.share, 0.3);
  EXPECT_LT(ideal.worst_px, 1.5) << "a prediction that is as good is used";
  EXPECT_FALSE(ideal.registered);
}

TEST(Ladder, LandmarksThatComeLateAreNotPreferredToATrackerThatIsRight) {
  const Ride naive = ride(config::FilterMethod::naive, Rung::predict, {8, 0});
  EXPECT_GT(naive.share, 0.9);
  EXPECT_FALSE(naive.registered);
}

TEST(Ladder, OnTheLowestRungsTheTrackersJumpsAreBlendedInToo) {
  const auto calibration = rig_above_hand();
  config::Cascade settings;
  settings.filter.method = config::FilterMethod::offset_kalman;
  const auto pipeline = *Pipeline::create(settings, {}, {}, calibration);
  const Image<std::uint8_t> image = image_of(calibration, {pose_of(Side::left)});
  constexpr float kShake_m = 1e-4f;
  const auto shaken_at = [&](float x_m) {
    return (*project_landmarks(calibration, pose_of(Side::left, {x_m, 0, 0})))[9];
  };
  float worst_px = 0;
  int low = 0;
  std::optional<FrameHand> before;
  for (std::int64_t ms = 0; ms < 900; ++ms) {
    const auto shaken = pose_of(Side::left, {ms / 9 % 2 == 0 ? kShake_m : -kShake_m, 0, 0});
    if (ms % 9 == 0 && ms > 9) pipeline->push(ms * kMs, poses_of((ms - 9) * kMs, {shaken}));
    if (ms % 16 == 0 && ms > 16)
      pipeline->push(ms * kMs,
                     landmarks_of(calibration, (ms - 16) * kMs, pose_of(Side::left), {0, 0}));
    if (ms % 100 == 50) pipeline->render(ms * kMs, (ms + 4) * kMs, {image.view(), (ms - 3) * kMs});
    const auto hands = pipeline->track(ms * kMs, (ms + 4) * kMs);
    if (ms < 500 || hands.empty()) continue;
    low += hands[0].rung <= Rung::predict;
    if (before)
      worst_px = std::max(worst_px, glm::distance(hands[0].corrected[9], before->corrected[9]));
    before = hands[0];
  }
  EXPECT_GT(low, 300);
  EXPECT_LT(worst_px, 0.4f * glm::distance(shaken_at(kShake_m), shaken_at(-kShake_m)));
}

TEST(Ladder, ALowerRungThatIsSetIsKept) {
  const auto calibration = rig_above_hand();
  using enum config::RungChoice;
  for (const config::RungChoice rung : {hold, similarity, landmarks}) {
    config::Cascade settings;
    settings.ladder.rung = rung;
    const auto pipeline = *Pipeline::create(settings, {}, {}, calibration);
    for (std::int64_t t = 0; t <= 100 * kMs; t += kMs) {
      if (t % (9 * kMs) == 0) pipeline->push(t, poses_of(t, {pose_of(Side::left)}));
      if (t % (16 * kMs) == 0)
        pipeline->push(t, landmarks_of(calibration, t, pose_of(Side::left), {6, 0}));
      pipeline->track(t, t + 4 * kMs);
    }
    const Frame frame = pipeline->render(101 * kMs, 105 * kMs, {});
    ASSERT_EQ(frame.hands.size(), 1u);
    const auto& hand = frame.hands[0];
    EXPECT_EQ(hand.rung, held_rung(rung));
    EXPECT_NEAR(hand.corrected[9].x - hand.tracker[9].x, hand.rung < Rung::shift ? 0 : 6, 0.1f)
        << config::word_of(rung);
    const auto mark = std::ranges::find(frame.stages, msg::Stage::correct, &msg::StageMark::stage);
    ASSERT_NE(mark, frame.stages.end());
    EXPECT_EQ(msg::rung_in(mark->detail, Side::left), hand.rung);
  }
}

}  // namespace
}  // namespace handcast::renderer
