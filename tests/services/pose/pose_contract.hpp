// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "services/lab/twin/twin.hpp"
#include "services/pose/pose_source.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/unread_settings.hpp"

/// What every back end of the tracker must do. A test instantiates it with the rows of a table:
///   INSTANTIATE_TEST_SUITE_P(Rows, PoseContract, testing::ValuesIn(table), name_of_row);
namespace handcast::pose {

using namespace std::chrono_literals;

/// A recording of 30 samples of the twin's left hand, 5 ms apart.
inline recording::RecordedHands recording_of(const config::Rig& rig) {
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) throw std::runtime_error(twin.error().what);
  recording::RecordedHands recording;
  for (std::uint64_t k = 0; k < 30; ++k) {
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * to_ns(5ms));
    recording.hands[0].push_back((*twin)->tracker_sample(k).poses.hands[0]);
  }
  return recording;
}

/// The reference rig, with a second camera 0.1 m to the right of the first.
inline calib::Calibration two_cameras() {
  auto calibration = calib::reference_rig();
  glm::dmat4 from_camera(1);
  from_camera[3].x = -0.1;
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, from_camera};
  return calibration;
}

/// Samples a source; one that needs landmarks sees those of the twin at the time of the call.
inline Result<void> sample(PoseSource& source, msg::HandPoses& poses, Deadline deadline,
                           const config::Rig& rig = {}, std::optional<std::int64_t> at_ns = {}) {
  static std::uint64_t runs = 0;
  if (source.needs_landmarks() && deadline.time_ns() > now_ns()) {
    const std::uint64_t run = at_ns ? static_cast<std::uint64_t>(*at_ns) : runs++;
    const std::int64_t origin_ns = at_ns.value_or(now_ns());
    for (int view = 0; view < source.views(); ++view) {
      const auto at = view == 0 ? config::Viewpoint::first : config::Viewpoint::second;
      const auto twin = twin::Twin::create(rig, two_cameras(), at).value();
      auto seen = twin->detect(0, run, 0).landmarks;
      seen.header.origin_ns = origin_ns;
      source.see(seen, view);
    }
  }
  return source.sample(poses, deadline);
}

/// Whether two samples are equal to the last bit.
inline bool is_same(const msg::HandPoses& a, const msg::HandPoses& b) {
  const auto is_same_joint = [](const msg::Joint& p, const msg::Joint& q) {
    return p.position_m == q.position_m && p.orientation_xyzw == q.orientation_xyzw &&
           p.radius_m == q.radius_m;
  };
  const auto is_same_hand = [&](const msg::HandPose& p, const msg::HandPose& q) {
    return p.side == q.side && p.confidence == q.confidence &&
           std::ranges::equal(p.joints, q.joints, is_same_joint);
  };
  return a.header.frame_id == b.header.frame_id && a.header.origin_ns == b.header.origin_ns &&
         a.count == b.count && a.calibration == b.calibration &&
         std::ranges::equal(a.hands, b.hands, is_same_hand);
}

/// Prepares a rig for a back end that needs a device. Set by the test of that back end.
inline void (*prepare_rig)(config::Rig& rig) = nullptr;

class PoseContract : public testing::TestWithParam<PoseBackend> {
 protected:
  PoseContract() {
    rig_.pose.backend = GetParam().name;
    rig_.camera2.backend = "twin";  // for stereo
    rig_.pose.replay.directory = scratch_.path();
    if (GetParam().name == "replay" &&
        !recording::write_recording(scratch_.path(), recording_of(rig_)))
      throw std::runtime_error("the recording cannot be written");
#ifdef HANDCAST_TEST_RUNTIME_MANIFEST
    rig_.pose.openxr.runtime = HANDCAST_TEST_RUNTIME_MANIFEST;
#endif
    if (prepare_rig) prepare_rig(rig_);
    auto opened = open_pose_source(rig_, two_cameras(), epoch_ns_);
    if (!opened) throw std::runtime_error(opened.error().what);
    source_ = std::move(*opened);
  }

  /// The second sample of a source that is opened with `rig`; origin_ns counts from the first one.
  /// A source from which a slow machine could not fetch the first two samples is opened again.
  static std::optional<msg::HandPoses> second_sample(const config::Rig& rig) {
    for (int attempt = 1; attempt <= 10; ++attempt) {
      const auto source =
          GetParam().open(rig, two_cameras(), Surroundings{now_ns() + attempt * to_ns(200ms)});
      if (!source) throw std::runtime_error(source.error().what);
      msg::HandPoses first, second;
      if (!sample(**source, first, Deadline::in(10s), {}, 0)) continue;
      if (!sample(**source, second, Deadline::in(10s), {}, 1) || second.header.frame_id != 1)
        continue;
      second.header.origin_ns -= first.header.origin_ns;
      if (GetParam().name == "leapc") second.header.origin_ns = 0;  // of a clock that runs
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
  source_.reset();  // a process may have one session with a runtime
  const auto sample = second_sample(rig_);
  const auto other = second_sample(test::with_unread_settings_changed(rig_, "pose", GetParam()));
  ASSERT_TRUE(sample && other) << "the machine is too slow";
  EXPECT_TRUE(is_same(*sample, *other)) << "a setting is missing in the row's `reads`";
}

TEST_P(PoseContract, ItSaysWhatItsJointsMean) {
  EXPECT_NE(source_->conventions().place, joints::Place::unknown);
}

inline std::string name_of_row(const testing::TestParamInfo<PoseBackend>& row) {
  return std::string(row.param.name);
}

}  // namespace handcast::pose
