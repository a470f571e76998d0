// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/finger_errors.hpp"
#include "tests/services/lab/twin/world.hpp"

/// What a tracker gets wrong about fingers, joints and its own time.
namespace handcast::twin {
namespace {

constexpr std::array<int, kFingers> kTips{5, 10, 15, 20, 25};

const std::array<float, kJoints>& radii_m() {
  static const auto kRadii = renderer::joint_radii_m(renderer::HandShape::mean());
  return kRadii;
}

/// A left hand 0.4 m from a tracker at the origin that looks along +y, rolled about its own length:
/// 0 shows the palm, a quarter of a turn the thumb's edge.
JointFrames hand_before_tracker(double roll_deg, double flexion_rad = 0) {
  JointFrames hand = rest_pose(Side::left, renderer::HandShape::mean());
  Flexion more{};
  for (int f = 1; f < kFingers; ++f) more[f] = {flexion_rad, 1.25 * flexion_rad, 0.7 * flexion_rad};
  hand = bent_by(hand, more);
  const auto there = glm::rotate(glm::translate(glm::mat4(1), {0, 0.4f, 0}),
                                 glm::radians(static_cast<float>(roll_deg)), {0, 0, 1});
  for (auto& frame : hand) frame = there * frame;
  return hand;
}

double length_m(const JointFrames& frames, int joint) {
  return glm::distance(place(frames[joint]),
                       place(frames[static_cast<std::size_t>(renderer::kJointParent[joint])]));
}

/// The joints that sample `k` reports for the left hand.
JointFrames reported(const Twin& twin, std::uint64_t k) {
  return renderer::frames_of(*twin.tracker_sample(k).poses.find(Side::left));
}

JointFrames true_at(const Twin& twin, double seconds) {
  return *twin.joints(Side::left, seconds_to_ns(seconds));
}

TEST(FingerPose, BendingTurnsTheBonesAndKeepsTheirLengths) {
  const JointFrames straight = rest_pose(Side::right, renderer::HandShape::mean());
  Flexion more{};
  more[2] = {0.3, 0.5, 0.2};
  const JointFrames bent = bent_by(straight, more);
  const Flexion before = flexion_of(straight), after = flexion_of(bent);
  for (int f = 0; f < kFingers; ++f)
    for (int i = 0; i < kBends; ++i) EXPECT_NEAR(after[f][i] - before[f][i], more[f][i], 1e-3);
  for (int j = 2; j < kJoints; ++j) EXPECT_NEAR(length_m(bent, j), length_m(straight, j), 1e-6);
  EXPECT_LT(glm::distance(place(bent[10]), place(straight[10])), 1e-6) << "the index finger stays";
  EXPECT_LT(bent[15][3].y, straight[15][3].y - 0.03f) << "towards the palm";
}

TEST(HiddenFingers, AnOpenHandThatFacesTheTrackerHidesNone) {
  for (const double hidden : hidden_fingers(hand_before_tracker(0), radii_m()))
    EXPECT_LT(hidden, 0.05);
}

TEST(HiddenFingers, FromTheEdgeTheIndexFingerHidesThoseBehindIt) {
  const auto hidden = hidden_fingers(hand_before_tracker(-90), radii_m());
  EXPECT_LT(hidden[1], 0.05) << "nothing is before the index finger";
  EXPECT_GT(hidden[2], 0.9);
  EXPECT_GT(hidden[3], 0.9);
}

TEST(HiddenFingers, BehindThePalmAFistIsHidden) {
  const auto hidden = hidden_fingers(hand_before_tracker(180, 1.3), radii_m());
  for (int f = 1; f < kFingers; ++f) EXPECT_GT(hidden[f], 0.9) << f;
}

TEST(HiddenFingers, ChangesNoFasterThanTheHand) {
  auto last = hidden_fingers(hand_before_tracker(-90), radii_m());
  for (double roll_deg = -90; roll_deg <= 90; roll_deg += 0.25) {
    const auto now = hidden_fingers(hand_before_tracker(roll_deg), radii_m());
    for (int f = 0; f < kFingers; ++f) EXPECT_NEAR(now[f], last[f], 0.15) << roll_deg << ' ' << f;
    last = now;
  }
}

TEST(TrackerErrors, AShareOfTheFlexionIsMissing) {
  auto rig = perfect_rig("builtin:open_close");
  rig.twin.tracker.flexion_bias = 0.2;
  const auto twin = twin_of(rig);
  for (const std::uint64_t k : {30u, 110u, 200u}) {
    const auto truth = *twin->joints(Side::left, twin->tracker_time_ns(k));
    const auto seen = reported(*twin, k);
    const Flexion real = flexion_of(truth), shown = flexion_of(seen);
    for (int f = 0; f < kFingers; ++f)
      for (int i = 0; i < bends_of(f); ++i)
        EXPECT_NEAR(shown[f][i], 0.8 * real[f][i], 1e-3) << f << ' ' << i;
    for (int j = 3; j < kJoints; ++j) EXPECT_NEAR(length_m(seen, j), length_m(truth, j), 1e-5);
  }
}

/// A hidden finger of a still fist: its flexion's error in degrees over time, by sample.
std::vector<double> guesses_deg(double hidden_s, double seconds) {
  const config::TwinTracker settings{.hidden_deg = 15, .hidden_s = hidden_s};
  const FingerErrors errors(settings, 3, radii_m());
  const JointFrames truth = hand_before_tracker(180, 1.0);
  const double real = flexion_of(truth)[2][0];
  std::vector<double> guesses;
  for (double t = 0; t < seconds; t += 0.01)
    guesses.push_back(glm::degrees(flexion_of(errors.seen(Side::left, t, truth))[2][0] - real));
  return guesses;
}

TEST(TrackerErrors, AHiddenFingerIsGuessedForAWhileAndThenGuessedAnew) {
  const auto guesses = guesses_deg(1.5, 600);
  double square = 0, mean = 0;
  std::size_t held = 0, moves = 0;
  for (std::size_t i = 1; i < guesses.size(); ++i) {
    mean += guesses[i] / static_cast<double>(guesses.size());
    square += guesses[i] * guesses[i] / static_cast<double>(guesses.size());
    const bool still = std::abs(guesses[i] - guesses[i - 1]) < 1e-3;
    held += still;
    moves += !still && std::abs(guesses[i - 1] - guesses[i >= 2 ? i - 2 : 0]) < 1e-3;
    EXPECT_LT(std::abs(guesses[i] - guesses[i - 1]), 12) << "it moves there, it does not jump";
  }
  EXPECT_NEAR(std::sqrt(square), 15, 2.5);
  EXPECT_NEAR(mean, 0, 3);
  EXPECT_NEAR(static_cast<double>(moves), 600 / 1.5, 20) << "one guess in 1.5 s";
  EXPECT_GT(static_cast<double>(held), 0.9 * static_cast<double>(guesses.size()));
}

TEST(TrackerErrors, AFingerThatTheTrackerSeesIsNotGuessed) {
  const FingerErrors errors({.hidden_deg = 30}, 3, radii_m());
  const JointFrames truth = hand_before_tracker(0);
  for (const double t : {0.0, 0.7, 5.1})
    for (int j = 0; j < kJoints; ++j)
      EXPECT_LT(glm::distance(place(errors.seen(Side::left, t, truth)[j]), place(truth[j])), 2e-3);
}

TEST(TrackerErrors, AFingerThatIsHiddenInPartIsGuessedInPart) {
  const FingerErrors errors({.hidden_deg = 5}, 3, radii_m());
  const auto error_rad = [&](double roll_deg) {
    const JointFrames truth = hand_before_tracker(roll_deg);
    return flexion_of(errors.seen(Side::left, 0.7, truth))[3][0] - flexion_of(truth)[3][0];
  };
  const double guess_rad = error_rad(-90);  // hidden behind the index finger
  ASSERT_GT(std::abs(guess_rad), 0.02);
  int in_part = 0;
  for (double roll_deg = -90; roll_deg < 0; roll_deg += 0.25) {
    const auto hidden = hidden_fingers(hand_before_tracker(roll_deg), radii_m())[3];
    EXPECT_NEAR(error_rad(roll_deg), hidden * guess_rad, 0.1 * std::abs(guess_rad)) << roll_deg;
    in_part += hidden > 0.2 && hidden < 0.8;
  }
  EXPECT_GT(in_part, 2);
}

TEST(TrackerErrors, FingersSnapAsOftenAndAsFarAsAsked) {
  const FingerErrors errors({.snap_hz = 2, .snap_deg = 25}, 5, radii_m());
  const JointFrames truth = hand_before_tracker(0, 0.6);
  const Flexion real = flexion_of(truth);
  int snaps = 0, bent = 0;
  bool before = false;
  for (int i = 0; i < 30000; ++i) {
    const Flexion seen = flexion_of(errors.seen(Side::left, 0.01 * i, truth));
    int now = 0;
    for (int f = 0; f < kFingers; ++f)
      if (const double deg = glm::degrees(seen[f][0] - real[f][0]); std::abs(deg) > 0.1) {
        ++now;
        bent += deg > 0;
        if (f > 0) {
          EXPECT_NEAR(std::abs(deg), 25, 0.1);
        }
      }
    EXPECT_LE(now, 2);
    snaps += now > 0 && !before;
    before = now > 0;
  }
  EXPECT_NEAR(snaps, 600, 150) << "2 in a second for 300 s; some overlap";
  EXPECT_GT(bent, 0);
}

TEST(TrackerErrors, JointsAreNotWhereThePersonsAreAndStayThere) {
  auto rig = perfect_rig("builtin:rotate");
  rig.twin.tracker.joint_offset_mm = 6;
  const auto twin = twin_of(rig);
  const auto offset_m = [&](std::uint64_t k, int j) {
    const auto truth = *twin->joints(Side::left, twin->tracker_time_ns(k));
    return glm::transpose(glm::dmat3(truth[j])) * (place(reported(*twin, k)[j]) - place(truth[j]));
  };
  double square = 0;
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_LT(glm::distance(offset_m(10, j), offset_m(400, j)), 1e-5) << "in the bone's axes";
    square += 1e6 * glm::dot(offset_m(10, j), offset_m(10, j)) / kJoints;
  }
  EXPECT_NEAR(std::sqrt(square), 6, 1.5);
}

TEST(TrackerErrors, TheJointsOfAFingerDriftTogetherAsFarAsAsked) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.tracker.drift_px = 3;
  rig.twin.tracker.finger_correlation = 0.75;
  const auto twin = twin_of(rig);
  double same = 0, other = 0, square = 0;
  for (std::uint64_t k = 0; k < 4400; k += 4) {
    const auto truth = *twin->joints(Side::left, twin->tracker_time_ns(k));
    const auto seen = reported(*twin, k);
    const auto drift = [&](int j) { return place(seen[j]) - place(truth[j]); };
    for (const int f : {1, 2, 3}) {
      const int tip = kTips[static_cast<std::size_t>(f)];
      same += glm::dot(drift(tip), drift(tip - 2));
      other += glm::dot(drift(tip), drift(tip + 5));
      square += glm::dot(drift(tip), drift(tip));
    }
  }
  EXPECT_NEAR(same / square, 0.75, 0.15);
  EXPECT_NEAR(other / square, 0, 0.15);
}

TEST(TrackerErrors, ItReportsThePastAndStampsItAsThePresent) {
  auto rig = perfect_rig("builtin:shake");
  rig.twin.tracker.lag_ms = 12;
  const auto twin = twin_of(rig);
  for (const std::uint64_t k : {40u, 90u, 150u}) {
    const auto sample = twin->tracker_sample(k);
    const double seconds = ns_to_seconds(twin->tracker_time_ns(k));
    EXPECT_EQ(sample.poses.header.origin_ns, twin->tracker_time_ns(k));
    const auto seen = reported(*twin, k);
    const auto wrist = true_at(*twin, seconds - 0.004), fingers = true_at(*twin, seconds - 0.012);
    EXPECT_LT(glm::distance(place(seen[1]), place(wrist[1])), 1e-6);
    const Flexion real = flexion_of(fingers), shown = flexion_of(seen);
    for (int f = 1; f < kFingers; ++f) EXPECT_NEAR(shown[f][0], real[f][0], 1e-4);
  }
}

TEST(TrackerErrors, AHandThatHasJustComeHasNoPast) {
  auto rig = perfect_rig("builtin:enter_leave");
  const auto punctual = twin_of(rig);
  rig.twin.tracker.lag_ms = 60;
  const auto late = twin_of(rig);
  for (std::uint64_t k = 0; k < 500; ++k)
    EXPECT_EQ(punctual->tracker_sample(k).poses.count, late->tracker_sample(k).poses.count) << k;
}

}  // namespace
}  // namespace handcast::twin
