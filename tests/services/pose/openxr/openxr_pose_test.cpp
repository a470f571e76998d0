// SPDX-License-Identifier: Apache-2.0
// The back end `openxr` with the real loader and a runtime of the tests. Its contract is in
// tests/services/pose/pose_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "services/pose/pose_source.hpp"
#include "tests/services/pose/openxr/runtime/motion.hpp"
#include "tests/services/pose/openxr/scripted_runtime.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

Result<std::unique_ptr<PoseSource>> open(const config::Rig& rig) {
  return open_pose_source(rig, calib::reference_rig(), now_ns());
}

/// What a rig with this runtime cannot begin with.
Error refusal(const config::Rig& rig) {
  const auto opened = open(rig);
  return opened ? Error{Errc::timeout, "it was opened"} : opened.error();
}
Error refusal(const std::string& script) {
  const test::ScriptedRuntime runtime(script);
  return refusal(runtime.rig());
}

class OpenXrPose : public testing::Test {
 protected:
  void open_it(const std::string& script, const config::OpenXr& settings = {}) {
    runtime_.play(script);
    auto rig = runtime_.rig();
    const auto manifest = rig.pose.openxr.runtime;
    rig.pose.openxr = settings;
    rig.pose.openxr.runtime = manifest;
    source_.reset();  // a process may have one instance
    auto opened = open(rig);
    ASSERT_TRUE(opened) << opened.error().what;
    source_ = std::move(*opened);
  }
  msg::HandPoses sample() const {
    msg::HandPoses poses;
    const auto sampled = source_->sample(poses, Deadline::in(5s));
    EXPECT_TRUE(sampled) << sampled.error().what;
    return poses;
  }
  /// The first error; those with the code `except` do not count.
  Error error(Errc except = Errc::bad_config, std::chrono::milliseconds within = 5s) const {
    for (const auto end = Deadline::in(within); !end.passed();) {
      msg::HandPoses poses;
      const auto sampled = source_->sample(poses, Deadline::in(50ms));
      if (!sampled && sampled.error().code != except) return sampled.error();
    }
    return {Errc::timeout, "there was no error"};
  }

  test::ScriptedRuntime runtime_;
  std::unique_ptr<PoseSource> source_;
};

TEST(OpenXrRuntime, SaysWhatIsMissing) {
  const auto without_headless = refusal("lacks XR_MND_headless");
  EXPECT_EQ(without_headless.code, Errc::bad_config);
  EXPECT_THAT(without_headless.what,
              AllOf(HasSubstr("'Test Runtime'"), HasSubstr("draws nothing"), HasSubstr("Monado")));
  const auto without_hands = refusal("lacks XR_EXT_hand_tracking");
  EXPECT_EQ(without_hands.code, Errc::bad_config);
  EXPECT_THAT(without_hands.what, HasSubstr("no hand tracking"));
  const auto without_times = refusal("lacks XR_KHR_convert_timespec_time");
  EXPECT_EQ(without_times.code, Errc::bad_config);
  EXPECT_THAT(without_times.what, HasSubstr("times"));
}

TEST(OpenXrRuntime, WhatMayComeLaterIsTriedAgain) {
  for (const auto* script : {"refuses", "no_system", "no_hands", "never_ready"}) {
    const auto why = refusal(std::string(script));
    EXPECT_EQ(why.code, Errc::unavailable) << script << ": " << why.what;
    EXPECT_THAT(why.what, HasSubstr("Test Runtime")) << script;
  }
}

TEST(OpenXrRuntime, ASpaceThatItLacksIsASettingToChange) {
  const test::ScriptedRuntime runtime("no_stage");
  auto rig = runtime.rig();
  rig.pose.openxr.space = config::OpenXrSpace::stage;
  EXPECT_THAT(refusal(rig).what, AllOf(HasSubstr("'stage'"), HasSubstr("pose.openxr.space")));
  EXPECT_EQ(refusal(rig).code, Errc::bad_config);
}

TEST(OpenXrRuntime, AManifestOrALibraryThatIsNoneIsNamed) {
  const test::ScriptedRuntime runtime;
  auto rig = runtime.rig();
  rig.pose.openxr.runtime = "/nowhere/runtime.json";
  EXPECT_EQ(refusal(rig).code, Errc::unavailable);
  EXPECT_THAT(refusal(rig).what, HasSubstr("/nowhere/runtime.json"));
  const auto library = runtime.in_scratch("no_library.so");
  std::ofstream(library) << "text";
  rig.pose.openxr.runtime = runtime.in_scratch("bad.json");
  std::ofstream(rig.pose.openxr.runtime)
      << R"({"file_format_version": "1.0.0", "runtime": {"library_path": ")" << library << "\"}}";
  EXPECT_EQ(refusal(rig).code, Errc::unavailable);
  EXPECT_THAT(refusal(rig).what, AllOf(HasSubstr("no_library.so"), HasSubstr("XR_LOADER_DEBUG")));
}

TEST_F(OpenXrPose, TimesAreThoseOfThisComputer) {
  const std::int64_t begun_ns = now_ns() - to_ns(1s);
  open_it("times knows\nepoch_ns " + std::to_string(begun_ns));
  const auto poses = sample();
  EXPECT_GE(now_ns() - poses.header.origin_ns, to_ns(10ms)) << "pose.openxr.age_ms before the poll";
  ASSERT_EQ(poses.count, 1u);
  const double second = ns_to_seconds(poses.header.origin_ns - begun_ns);
  EXPECT_NEAR(poses.hands[0].joints[1].position_m[0], 0.05 * std::sin(second / 1.5 * 6.2831853),
              1e-3);
}

TEST_F(OpenXrPose, BothHandsComeWithAllTheirJoints) {
  open_it("motion " + [this] {
    auto motion = test_runtime::Motion{100, {}};
    msg::HandPoses poses;
    poses.count = 2;
    poses.hands[1].side = msg::Side::right;
    for (int j = 0; j < msg::kJoints; ++j)
      for (auto& hand : poses.hands)
        hand.joints[j] = {.position_m = {0.01f * j, hand.side == msg::Side::right ? 1.f : 0.f, 0},
                          .orientation_xyzw = {0, 0.6f, 0, 0.8f},
                          .radius_m = 0.001f * (1 + j)};
    motion.frames.assign(3, poses);
    test_runtime::write_motion(runtime_.in_scratch("motion"), motion);
    return runtime_.in_scratch("motion");
  }());
  const auto poses = sample();
  ASSERT_EQ(poses.count, 2u);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < msg::kJoints; ++j) {
      const auto& joint = poses.hands[i].joints[j];
      EXPECT_NEAR(joint.position_m[0], 0.01 * j, 1e-3);
      EXPECT_NEAR(joint.position_m[1], i, 1e-3);
      EXPECT_NEAR(joint.orientation_xyzw[1], 0.6, 1e-5);
      EXPECT_FLOAT_EQ(joint.radius_m, 0.001f * static_cast<float>(1 + j));
    }
  EXPECT_EQ(poses.hands[0].side, msg::Side::left);
  EXPECT_EQ(poses.hands[1].side, msg::Side::right);
  EXPECT_EQ(poses.hands[1].confidence, 1);
}

TEST_F(OpenXrPose, NoSampleComesTwiceFromARuntimeThatHoldsIts) {
  // 20 samples a second of a runtime that is asked 120 times.
  open_it("times holds\nrate_hz 20");
  auto last = sample();
  const auto begin_ns = last.header.origin_ns;
  for (int i = 0; i < 10; ++i) {
    const auto next = sample();
    EXPECT_NE(next.hands[0].joints[0].position_m, last.hands[0].joints[0].position_m);
    last = next;
  }
  EXPECT_GE(last.header.origin_ns - begin_ns, to_ns(400ms)) << "10 samples of 20 Hz";
}

TEST_F(OpenXrPose, ASampleOfAHoldingRuntimeIsStampedByItsArrival) {
  // The runtime has sample k, of time k / 20 Hz, 3 ms later.
  const std::int64_t epoch_ns = now_ns() - to_ns(1s);
  open_it("times holds\nrate_hz 20\nage_ms 3\nnoise_mm 0\nepoch_ns " + std::to_string(epoch_ns),
          {.rate_hz = 25, .age_ms = 7});
  sample();
  std::vector<double> late_ms;
  int of_this_time = 0;
  for (int i = 0; i < 9; ++i) {
    const auto poses = sample();
    EXPECT_GE(now_ns() - poses.header.origin_ns, to_ns(7ms));
    const double after_ms = ns_to_ms(poses.header.origin_ns - epoch_ns) + 7 - 3;
    const double k = std::round(after_ms / 50);
    const double there_m = 0.05 * std::sin(k / 20 / 1.5 * 6.2831853);
    of_this_time += std::abs(poses.hands[0].joints[1].position_m[0] - there_m) < 1e-3;
    late_ms.push_back(after_ms - 50 * k);
  }
  // A machine that wakes late stamps some of them otherwise.
  EXPECT_GE(of_this_time, 5);
  std::ranges::sort(late_ms);
  EXPECT_GE(late_ms[0], -0.05) << "it was not there before";
  EXPECT_LE(late_ms[4], 5) << "the runtime was asked every 40 ms, and more often once one was due";
}

/// A runtime that samples faster than it is asked would be off by half its period on average.
TEST_F(OpenXrPose, ASampleIsTakenOnlyIfItsArrivalWasSeen) {
  for (const auto* times : {"holds", "interpolates"}) {
    open_it("rate_hz 100\nage_ms 5\nnoise_mm 0\ntimes " + std::string(times),
            {.rate_hz = 50, .age_ms = 5});
    std::vector<double> ahead_ms;
    std::optional<std::int64_t> first_ns;
    for (int i = 0; i < 10; ++i) {
      const auto poses = sample();
      // The place in the sway tells when it was measured.
      const double second =
          std::asin(poses.hands[0].joints[1].position_m[0] / 0.05) * 1.5 / 6.2831853;
      if (!first_ns) first_ns = poses.header.origin_ns;
      ahead_ms.push_back(ns_to_ms(poses.header.origin_ns - *first_ns) - 1e3 * second);
    }
    // Beside the middle one: a machine that wakes late stamps some of them, or the first,
    // otherwise.
    std::ranges::sort(ahead_ms);
    EXPECT_LT(ahead_ms[7] - ahead_ms[4], 1.5) << times;
    EXPECT_LT(ahead_ms[4] - ahead_ms[2], 1.5) << times;
  }
}

TEST_F(OpenXrPose, AHandThatIsNotTrackedIsNoHand) {
  open_it("inactive left");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(sample().count, 0u);
  runtime_.play("");
  EXPECT_EQ((sample(), sample()).count, 1u);
}

TEST_F(OpenXrPose, AHandWithAnUnknownJointIsNoHand) {
  open_it("unknown_joint");
  EXPECT_EQ(sample().count, 0u);
}

TEST_F(OpenXrPose, JointsWithoutNumbersAreBadDataAndPass) {
  open_it("no_number");
  EXPECT_EQ(error().code, Errc::bad_data);
  runtime_.play("");
  EXPECT_EQ(error(Errc::bad_data, 300ms).what, "there was no error");
}

TEST_F(OpenXrPose, ATimeThatTheRuntimeRefusesIsALostSample) {
  open_it("");
  runtime_.play("refuses_times");
  const auto why = error();
  EXPECT_EQ(why.code, Errc::bad_data);
  EXPECT_THAT(why.what, HasSubstr("XR_ERROR_TIME_INVALID"));
}

TEST_F(OpenXrPose, LossOfSessionOrInstanceIsADisconnectionAndItCanBeOpenedAgain) {
  for (const auto* loss : {"loses_session", "loses_instance", "ends"}) {
    open_it("");
    sample();
    runtime_.play(loss);
    const auto why = error();
    EXPECT_EQ(why.code, Errc::disconnected) << loss << ": " << why.what;
    EXPECT_THAT(why.what, HasSubstr("Test Runtime 0.1.2, 'Test Tracker'")) << loss;
  }
  open_it("");
  EXPECT_EQ(sample().count, 1u);
}

TEST_F(OpenXrPose, ASessionThatIsStoppedGoesOnWhenTheRuntimeBeginsItAgain) {
  open_it("");
  sample();
  runtime_.play("stops");
  const auto why = error();
  EXPECT_EQ(why.code, Errc::timeout);
  EXPECT_THAT(why.what, HasSubstr("stopped the session"));
  runtime_.play("");
  EXPECT_EQ(error(Errc::timeout, 300ms).what, "there was no error");
  EXPECT_EQ(sample().count, 1u);
}

TEST_F(OpenXrPose, WhenTheOriginMovesTheLogSaysThatTheCalibrationIsWrong) {
  testing::internal::CaptureStderr();
  open_it("moves_space");
  sample();
  source_.reset();
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("moves the origin"));
}

TEST_F(OpenXrPose, APredictingRuntimeIsAskedForThePoseAtTheLight) {
  open_it("times predicts", {.predict_ms = 30});
  const auto poses = sample();
  EXPECT_GT(poses.header.origin_ns, now_ns() + to_ns(5ms));
}

TEST_F(OpenXrPose, ARuntimeThatDoesNotPredictIsNotBelieved) {
  for (const auto* times : {"holds", "interpolates"}) {
    open_it("rate_hz 40\ntimes " + std::string(times), {.predict_ms = 30});
    for (int i = 0; i < 4; ++i) {
      const auto origin_ns = sample().header.origin_ns;
      EXPECT_LE(origin_ns, now_ns() - to_ns(10ms)) << times;
    }
  }
}

}  // namespace
}  // namespace handcast::pose
