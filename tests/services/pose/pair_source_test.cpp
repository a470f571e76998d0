// SPDX-License-Identifier: Apache-2.0
// Two sources at once, in real time.
#include "services/pose/pair_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A hand at a place, every 5 ms, until it is lost; it may need landmarks.
struct Behaviour {
  float x_m = 0;
  bool needs_landmarks = false;
  std::atomic<bool> is_lost{false}, is_absent{false};
  std::atomic<int> opened{0}, seen{0};
};

class StandIn final : public PoseSource {
 public:
  explicit StandIn(Behaviour& behaviour) : behaviour_(behaviour) {}

  Result<void> sample(msg::HandPoses& poses, Deadline) override {
    if (behaviour_.is_lost) return fail(Errc::disconnected, "pose 'stand-in': it is gone");
    if (!behaviour_.needs_landmarks) sleep_until_ns(now_ns() + to_ns(5ms));
    poses = {};
    poses.header = {number_++, now_ns(), 0};
    poses.count = 1;
    poses.hands[0].confidence = 1;
    for (auto& joint : poses.hands[0].joints)
      joint.position_m = {behaviour_.x_m, 1e-6f * static_cast<float>(number_ % 100), 0.3f};
    return {};
  }
  int views() const override { return behaviour_.needs_landmarks ? 1 : 0; }
  void see(const msg::Landmarks& /*landmarks*/, int /*view*/) override { ++behaviour_.seen; }

 private:
  Behaviour& behaviour_;
  std::uint64_t number_ = 0;
};

SourceRunner::Open opener(Behaviour& behaviour) {
  return [&behaviour]() -> Result<std::unique_ptr<WatchedSource>> {
    if (behaviour.is_absent) return fail(Errc::unavailable, "pose 'stand-in': it is not there");
    ++behaviour.opened;
    return std::make_unique<WatchedSource>("pose 'stand-in'", std::make_unique<StandIn>(behaviour));
  };
}

/// Samples, with landmarks, until a hand is within 1 mm of x; false after 10 s.
bool reaches(PoseSource& source, float x_m) {
  const auto until = Deadline::in(10s);
  msg::HandPoses poses;
  while (!until.passed()) {
    source.see({}, 0);
    if (source.sample(poses, Deadline::in(5ms)) &&
        std::abs(poses.hands[0].joints[1].position_m[0] - x_m) < 1e-3f)
      return true;
  }
  return false;
}

class Pair : public testing::Test {
 protected:
  Pair() {
    first_.x_m = 0.1f;
    second_.x_m = 0.11f;
  }
  std::unique_ptr<PoseSource> open() {
    return open_pair({.return_ms = 100, .blend_ms = 50}, {opener(first_), opener(second_)}).value();
  }

  Behaviour first_, second_;
};

TEST_F(Pair, ASourceThatIsLostIsReplacedAndOpenedAgain) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  first_.is_absent = true;
  first_.is_lost = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  first_.is_lost = false;
  first_.is_absent = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_EQ(first_.opened, 2);
}

TEST_F(Pair, ASourceThatIsNotThereAtTheStartIsOpenedLater) {
  first_.is_absent = true;
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.11f));
  first_.is_absent = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
}

TEST_F(Pair, TheSecondMayBeMadeFromLandmarks) {
  second_.needs_landmarks = true;
  const auto source = open();
  EXPECT_FALSE(source->needs_landmarks());
  EXPECT_GT(source->views(), 0);
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_FALSE(source->depends_on_calibration());
  first_.is_absent = true;
  first_.is_lost = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  EXPECT_TRUE(source->depends_on_calibration());
  EXPECT_GT(second_.seen, 0);
}

TEST_F(Pair, IfBothAreAwayTheStartFailsAndTheTimeoutNamesBoth) {
  first_.is_absent = second_.is_absent = true;
  const auto opened = open_pair({}, {opener(first_), opener(second_)});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::unavailable);
  first_.is_absent = second_.is_absent = false;
  const auto source = open();
  first_.is_absent = second_.is_absent = true;
  first_.is_lost = second_.is_lost = true;
  msg::HandPoses poses;
  std::string said;
  const auto until = Deadline::in(10s);
  while (said.find("; pose 'stand-in'") == std::string::npos && !until.passed())
    if (const auto sampled = source->sample(poses, Deadline::in(50ms)); !sampled) {
      EXPECT_EQ(sampled.error().code, Errc::timeout);
      said = sampled.error().what;
    }
  EXPECT_THAT(said, HasSubstr("stand-in'"));
}

TEST(PairOfARig, ASecondSourceMustBeAnotherOne) {
  config::Rig rig;
  rig.pose.second = "twin";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::bad_config);
  EXPECT_THAT(source.error().what, HasSubstr("pose.second"));
  EXPECT_FALSE(check_pose_sources(rig, calib::reference_rig()));
}

TEST(PairOfARig, AnUnknownSecondSourceIsAnErrorWithTheKnownOnes) {
  config::Rig rig;
  rig.pose.second = "telepathy";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_FALSE(source);
  EXPECT_THAT(source.error().what, HasSubstr("telepathy"));
}

TEST(PairOfARig, TheTwinsTrackerComesBeforeTheLandmarks) {
  config::Rig rig;
  rig.pose.second = "none";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns()).value();
  EXPECT_GT(source->views(), 0);
  msg::HandPoses poses;
  ASSERT_TRUE(source->sample(poses, Deadline::in(5s)));
  EXPECT_EQ(poses.count, 1u);
  EXPECT_FALSE(source->depends_on_calibration());
}

}  // namespace
}  // namespace handcast::pose
