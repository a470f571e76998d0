// SPDX-License-Identifier: Apache-2.0
// The contract of all pose back ends, and tests of single ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "services/evaluation/twin/recording.hpp"
#include "services/evaluation/twin/twin.hpp"
#include "services/pose/pose_source.hpp"
#include "tests/scratch.hpp"
#include "tests/services/unread_settings.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;

/// A recording of 30 samples of the twin's left hand, 5 ms apart.
twin::Recording recording_of(const config::Rig& rig) {
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) throw std::runtime_error(twin.error().what);
  twin::Recording recording;
  for (std::uint64_t k = 0; k < 30; ++k) {
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * to_ns(5ms));
    recording.hands[0].push_back((*twin)->tracker_sample(k).poses.hands[0]);
  }
  return recording;
}

/// Samples a source; one that needs landmarks sees those of the twin at the time of the call.
Result<void> sample(PoseSource& source, msg::HandPoses& poses, Deadline deadline,
                    const config::Rig& rig = {}, std::optional<std::int64_t> at_ns = {}) {
  static std::uint64_t runs = 0;
  if (source.needs_landmarks() && deadline.time_ns() > now_ns()) {
    const auto twin = twin::Twin::create(rig, calib::reference_rig()).value();
    auto seen = twin->detect(0, at_ns ? static_cast<std::uint64_t>(*at_ns) : runs++, 0).landmarks;
    seen.header.origin_ns = at_ns.value_or(now_ns());
    source.see(seen);
  }
  return source.sample(poses, deadline);
}

class PoseContract : public testing::TestWithParam<std::string_view> {
 protected:
  PoseContract() {
    rig_.pose.backend = GetParam();
    rig_.pose.replay.directory = scratch_.path();
    if (GetParam() == "replay" && !twin::write_recording(scratch_.path(), recording_of(rig_)))
      throw std::runtime_error("the recording cannot be written");
    auto opened = open_pose_source(rig_, calib::reference_rig(), epoch_ns_);
    if (!opened) throw std::runtime_error(opened.error().what);
    source_ = std::move(*opened);
  }

  static const PoseBackend& row() {
    return *std::ranges::find(pose_backends(), GetParam(), &PoseBackend::name);
  }
  /// The second sample of a source that is opened with `rig`; origin_ns counts from the first one.
  /// A source from which a slow machine could not fetch the first two samples is opened again.
  static std::optional<msg::HandPoses> second_sample(const config::Rig& rig) {
    for (int attempt = 1; attempt <= 10; ++attempt) {
      const auto source =
          row().open(rig, calib::reference_rig(), now_ns() + attempt * to_ns(200ms));
      if (!source) throw std::runtime_error(source.error().what);
      msg::HandPoses first, second;
      if (!sample(**source, first, Deadline::in(10s), {}, 0)) continue;
      if (!sample(**source, second, Deadline::in(10s), {}, 1) || second.header.frame_id != 1)
        continue;
      second.header.origin_ns -= first.header.origin_ns;
      return second;
    }
    return std::nullopt;
  }

  test::Scratch scratch_;
  config::Rig rig_;
  std::int64_t epoch_ns_ = now_ns();
  std::unique_ptr<PoseSource> source_;
};

TEST_P(PoseContract, IdsAndOriginsIncreaseFromSampleToSample) {
  msg::Header last{};
  for (int i = 0; i < 12; ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE(sample(*source_, poses, Deadline::in(5s)));
    if (i > 0) {
      EXPECT_GT(poses.header.frame_id, last.frame_id);
      EXPECT_GT(poses.header.origin_ns, last.origin_ns);
    }
    last = poses.header;
  }
}

TEST_P(PoseContract, ASampleIsOfThePastAndHoldsAHand) {
  msg::HandPoses poses;
  ASSERT_TRUE(sample(*source_, poses, Deadline::in(5s)));
  EXPECT_LE(poses.header.origin_ns, now_ns());
  EXPECT_GT(poses.header.origin_ns, epoch_ns_ - to_ns(1s));
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.hands[0].side, msg::Side::left);
}

TEST_P(PoseContract, ADeadlineInThePastIsATimeoutNotAHang) {
  msg::HandPoses poses;
  ASSERT_TRUE(sample(*source_, poses, Deadline::in(5s)));
  const auto late = sample(*source_, poses, Deadline::now());
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Errc::timeout);
  EXPECT_TRUE(sample(*source_, poses, Deadline::in(5s))) << "a timeout must not end the stream";
}

TEST_P(PoseContract, AfterAPauseItGoesOnWithThePresent) {
  msg::HandPoses poses;
  ASSERT_TRUE(sample(*source_, poses, Deadline::in(5s)));
  const std::int64_t away_until_ns = now_ns() + to_ns(300ms);
  sleep_until_ns(away_until_ns);
  ASSERT_TRUE(sample(*source_, poses, Deadline::in(5s)));
  EXPECT_GE(poses.header.origin_ns, away_until_ns - to_ns(100ms));
}

TEST_P(PoseContract, ASampleDependsOnlyOnTheSettingsThatItsRowNames) {
  rig_.twin.motion = "builtin:two_hands";
  const auto sample = second_sample(rig_);
  const auto other = second_sample(test::with_unread_settings_changed(rig_, "pose", row()));
  ASSERT_TRUE(sample && other) << "the machine is too slow";
  EXPECT_EQ(std::memcmp(&*sample, &*other, sizeof *sample), 0)
      << "a setting is missing in the row's `reads`";
}

std::vector<std::string_view> all() { return service::names_of(pose_backends()); }
INSTANTIATE_TEST_SUITE_P(Backends, PoseContract, testing::ValuesIn(all()),
                         [](const auto& named) { return std::string(named.param); });

TEST(TwinPose, AnArrivingSampleIsAsOldAsTheRigSays) {
  config::Rig rig;
  rig.twin.tracker.age_ms = 30;
  rig.twin.tracker.age_sd_ms = 0;
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  for (int i = 0; i < 5; ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
    EXPECT_GE(now_ns() - poses.header.origin_ns, to_ns(30ms) - to_ns(1us));
  }
}

TEST(TwinPose, ALostSampleIsDeliveredWithoutAHand) {
  config::Rig rig;
  rig.twin.tracker.dropout = 1;
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  msg::HandPoses poses;
  ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
  EXPECT_EQ(poses.count, 0u);
}

TEST(ReplayPose, PlaysWhatWasRecorded) {
  test::Scratch scratch;
  config::Rig rig;
  const auto recording = recording_of(rig);
  ASSERT_TRUE(twin::write_recording(scratch.path(), recording));
  rig.pose.backend = "replay";
  rig.pose.replay.directory = scratch.path();
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  for (int i = 0; i < 5; ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
    const auto& expected = recording.hands[0][poses.header.frame_id % 30];
    for (const int tip : {5, 10, 15, 20, 25})
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(poses.hands[0].joints[tip].position_m[axis],
                    expected.joints[tip].position_m[axis], 1e-5);
  }
}

TEST(ReplayPose, SaysWhatItMisses) {
  config::Rig rig;
  rig.pose.backend = "replay";
  EXPECT_THAT(open_pose_source(rig, calib::reference_rig(), 0).error().what,
              testing::HasSubstr("pose.replay.directory"));
  rig.pose.replay.directory = "/nowhere";
  const auto opened = open_pose_source(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, testing::HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace handcast::pose
