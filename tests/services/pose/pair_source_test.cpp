// SPDX-License-Identifier: Apache-2.0
// Two sources at once, in real time.
#include "services/pose/pair_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

/// A hand at a place, every 5 ms, until it is lost or hangs; it may need landmarks. The thread of a
/// source that has hung uses it after the test.
struct Behaviour {
  std::string name;
  float x_m = 0;
  bool needs_landmarks = false;
  std::atomic<bool> is_lost{false}, is_absent{false}, has_hand{true};
  std::atomic<bool> hangs{false}, hangs_at_open{false};  ///< until it is false again
  std::atomic<int> period_ms{5}, opened{0}, seen{0};
  std::atomic<double> noise_mm{0};  ///< of the settings that it was adjusted to
};

/// A call that does not return for as long as it hangs.
void hang(const std::atomic<bool>& hangs) {
  while (hangs) sleep_until_ns(now_ns() + to_ns(1ms));
}

class StandIn final : public PoseSource {
 public:
  explicit StandIn(std::shared_ptr<Behaviour> behaviour) : behaviour_(std::move(behaviour)) {}

  Result<void> sample(msg::HandPoses& poses, Deadline) override {
    if (behaviour_->is_lost)
      return fail(Errc::disconnected, "pose '" + behaviour_->name + "': it is gone");
    hang(behaviour_->hangs);
    if (!behaviour_->needs_landmarks) sleep_until_ns(now_ns() + ms_to_ns(behaviour_->period_ms));
    poses = {};
    poses.header = {number_++, now_ns(), 0};
    poses.count = behaviour_->has_hand ? 1 : 0;
    poses.hands[0].confidence = 1;
    for (auto& joint : poses.hands[0].joints)
      joint.position_m = {behaviour_->x_m, 1e-6f * static_cast<float>(number_ % 100), 0.3f};
    return {};
  }
  int views() const override { return behaviour_->needs_landmarks ? 1 : 0; }
  void see(const msg::Landmarks& /*landmarks*/, int /*view*/) override { ++behaviour_->seen; }
  void adjust(const config::Rig& rig) override { behaviour_->noise_mm = rig.twin.tracker.noise_mm; }

 private:
  std::shared_ptr<Behaviour> behaviour_;
  std::uint64_t number_ = 0;
};

PairPart part(const std::shared_ptr<Behaviour>& behaviour) {
  const auto title = "pose '" + behaviour->name + "'";
  return {title, [behaviour, title]() -> Result<std::unique_ptr<WatchedSource>> {
            hang(behaviour->hangs_at_open);
            if (behaviour->is_absent) return fail(Errc::unavailable, title + ": it is not there");
            ++behaviour->opened;
            return std::make_unique<WatchedSource>(title, std::make_unique<StandIn>(behaviour));
          }};
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
    first_->name = "first one";
    first_->x_m = 0.1f;
    second_->name = "second one";
    second_->x_m = 0.11f;
  }
  /// Lets threads of sources that have hung end.
  ~Pair() override {
    for (auto& behaviour : {first_, second_}) behaviour->hangs = behaviour->hangs_at_open = false;
  }
  PairParts parts() {
    return {.first = part(first_),
            .second = part(second_),
            .patience = {.call_ns = to_ns(1s), .open_ns = to_ns(1s)},
            .start_ns = to_ns(300ms),
            .restart_ns = to_ns(500ms)};
  }
  std::unique_ptr<PoseSource> open() {
    return open_pair({.return_ms = 100, .blend_ms = 50}, parts()).value();
  }
  /// The first error that is no timeout, within 20 s.
  static Error end_of(PoseSource& source) {
    const auto until = Deadline::in(20s);
    msg::HandPoses poses;
    while (!until.passed())
      if (const auto sampled = source.sample(poses, Deadline::in(50ms));
          !sampled && sampled.error().code != Errc::timeout)
        return sampled.error();
    return {Errc::timeout, "there was no error"};
  }

  std::shared_ptr<Behaviour> first_ = std::make_shared<Behaviour>(),
                             second_ = std::make_shared<Behaviour>();
};

TEST_F(Pair, ASourceThatIsLostIsReplacedAndOpenedAgain) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  first_->is_absent = true;
  first_->is_lost = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  first_->is_lost = false;
  first_->is_absent = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_EQ(first_->opened, 2);
}

TEST_F(Pair, BothAreAdjustedAlsoOneThatIsOpenedAgain) {
  first_->is_absent = true;
  const auto source = open();
  config::Rig rig;
  rig.twin.tracker.noise_mm = 7;
  source->adjust(rig);
  EXPECT_TRUE(reaches(*source, 0.11f));
  EXPECT_EQ(second_->noise_mm, 7);
  first_->is_absent = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_EQ(first_->noise_mm, 7);
}

TEST_F(Pair, ASourceThatIsNotThereAtTheStartIsOpenedLater) {
  first_->is_absent = true;
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.11f));
  first_->is_absent = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
}

TEST_F(Pair, TheSecondMayBeMadeFromLandmarks) {
  second_->needs_landmarks = true;
  const auto source = open();
  EXPECT_FALSE(source->needs_landmarks());
  EXPECT_GT(source->views(), 0);
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_FALSE(source->depends_on_calibration());
  first_->is_absent = true;
  first_->is_lost = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  EXPECT_TRUE(source->depends_on_calibration());
  EXPECT_GT(second_->seen, 0);
}

TEST_F(Pair, IfBothAreAwayTheStartFailsAndTheTimeoutNamesBoth) {
  first_->is_absent = second_->is_absent = true;
  const auto opened = open_pair({}, parts());
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::unavailable);
  EXPECT_THAT(opened.error().what, HasSubstr("first one"));
  first_->is_absent = second_->is_absent = false;
  const auto source = open();
  first_->is_absent = second_->is_absent = true;
  first_->is_lost = second_->is_lost = true;
  msg::HandPoses poses;
  const std::string both = "pose 'first one': it is not there; pose 'second one': it is not there";
  std::string said;
  const auto until = Deadline::in(10s);
  while (said != both && !until.passed())
    if (const auto sampled = source->sample(poses, Deadline::in(50ms)); !sampled) {
      EXPECT_EQ(sampled.error().code, Errc::timeout);
      said = sampled.error().what;
    }
  EXPECT_EQ(said, both);
}

TEST_F(Pair, ASourceThatHangsIsReplacedAndUsedAgainWhenItsCallReturns) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  testing::internal::CaptureStderr();
  first_->hangs = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  auto said = testing::internal::GetCapturedStderr();
  const std::string hangs = "pose 'first one': its software hangs";
  msg::HandPoses poses;
  for (const auto until = Deadline::in(20s);
       said.find(hangs) == std::string::npos && !until.passed();) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(source->sample(poses, Deadline::in(5s)));
    said += testing::internal::GetCapturedStderr();
  }
  EXPECT_THAT(said, HasSubstr(hangs));
  first_->hangs = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
  EXPECT_EQ(first_->opened, 1);
}

TEST_F(Pair, AfterAPauseOfTheCallerTheSamplesThatWaitAreUsedAlthoughOneSourceHangs) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  first_->hangs = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  second_->period_ms = 60;  // those that are kept reach back to the begin of the pause
  sleep_until_ns(now_ns() + to_ns(2600ms));
  msg::HandPoses poses;
  for (int i = 0; i < 5; ++i) {
    const auto sampled = source->sample(poses, Deadline::in(5s));
    ASSERT_TRUE(sampled) << sampled.error().what;
    EXPECT_NEAR(poses.hands[0].joints[1].position_m[0], 0.11f, 1e-3f);
  }
}

TEST_F(Pair, ASourceThatHangsWhileItIsOpenedIsUsedLater) {
  first_->hangs_at_open = true;
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.11f));
  first_->hangs_at_open = false;
  EXPECT_TRUE(reaches(*source, 0.1f));
}

TEST_F(Pair, WhereTheFirstHangsAtTheStartTheSecondIsPublishedWithoutAHand) {
  first_->hangs_at_open = true;
  second_->has_hand = false;
  const auto source = open();
  msg::HandPoses poses;
  EXPECT_TRUE(source->sample(poses, Deadline::in(10s))) << "readers see that a tracker works";
  EXPECT_EQ(poses.count, 0u);
}

TEST_F(Pair, AHangAndASilentOtherSourceEndTheService) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  second_->is_absent = second_->is_lost = true;
  first_->hangs = true;
  const auto end = end_of(*source);
  EXPECT_EQ(end.code, Errc::unavailable);
  EXPECT_THAT(end.what, AllOf(HasSubstr("'first one'"), HasSubstr("hangs")));
}

TEST_F(Pair, AHangThatLastsEndsTheServiceWhileNoHandIsInSight) {
  const auto source = open();
  EXPECT_TRUE(reaches(*source, 0.1f));
  first_->hangs = true;
  EXPECT_TRUE(reaches(*source, 0.11f));
  const auto until = Deadline::in(3s);
  msg::HandPoses poses;
  while (!until.passed())
    ASSERT_TRUE(source->sample(poses, Deadline::in(5s))) << "a hand is in sight";
  second_->has_hand = false;
  EXPECT_EQ(end_of(*source).code, Errc::unavailable);
}

TEST_F(Pair, AWrongSettingIsSaidAlthoughTheOtherSourceHangs) {
  first_->hangs_at_open = true;
  auto both = parts();
  both.second.open = [] { return fail(Errc::bad_config, "pose 'second one': a wrong setting"); };
  const auto opened = open_pair({}, both);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().what, "pose 'second one': a wrong setting");
}

}  // namespace
}  // namespace handcast::pose
