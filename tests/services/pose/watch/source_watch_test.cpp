// SPDX-License-Identifier: Apache-2.0
// What a watch says of the twin's tracker with planted faults, and without any; and of recordings.
#include "services/pose/watch/source_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/twin/motion.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::pose {
namespace {

using msg::TrackerFault;
using msg::TrackerFaults;

constexpr double kRate_hz = 110.6;

/// What happens to a sample on its way to the watch. `at_s`: its time.
using Meddle = std::function<void(double at_s, msg::HandPoses& poses, std::int64_t& arrival_ns)>;

struct Seen {
  TrackerFaults faults;
  int unusable = 0;            ///< samples
  float least_confidence = 1;  ///< of any hand
};

/// The faults of the twin's tracker over some seconds.
Seen watch(const config::Rig& rig, double seconds, const Meddle& meddle = {}) {
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) throw std::runtime_error(twin.error().what);
  SourceWatch watch;
  Seen seen;
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(seconds * kRate_hz); ++k) {
    auto sample = (*twin)->tracker_sample(k);
    if (meddle) meddle(static_cast<double>(k) / kRate_hz, sample.poses, sample.arrival_ns);
    seen.faults += watch.look(sample.poses, sample.arrival_ns);
    seen.unusable += !watch.is_usable();
    for (std::uint32_t i = 0; i < sample.poses.count; ++i)
      seen.least_confidence = std::min(seen.least_confidence, sample.poses.hands[i].confidence);
  }
  return seen;
}

config::Rig rig_with(const std::string& motion, double speed = 1) {
  config::Rig rig;
  rig.twin.motion = motion;
  rig.twin.speed = speed;
  return rig;
}

TrackerFaults only(TrackerFault fault, std::uint32_t count) {
  TrackerFaults faults;
  faults.of(fault) = count;
  return faults;
}

void expect_equal(const TrackerFaults& is, const TrackerFaults& should) {
  for (std::size_t i = 0; i < msg::kTrackerFaults; ++i)
    EXPECT_EQ(is.count[i], should.count[i]) << msg::kTrackerFaultNames[i];
}

TEST(SourceWatch, AFreezeOfAMovingHandIsSeenOnceAndTheHandIsNotBelieved) {
  auto rig = rig_with("builtin:wave");
  rig.twin.tracker.frozen = {1, 0.5};
  const auto seen = watch(rig, 3);
  EXPECT_EQ(seen.faults.of(TrackerFault::frozen), 1u);
  EXPECT_EQ(seen.faults.of(TrackerFault::jumped), 0u) << "its end is no jump";
  EXPECT_NEAR(seen.unusable, 0.5 * kRate_hz, 3);
  EXPECT_EQ(seen.least_confidence, SourceWatch::kFrozen);
}

TEST(SourceWatch, APoseThatIsRepeatedForASecondIsSeenButMayBeAHandAtRest) {
  auto rig = rig_with("builtin:still");
  const auto twin = twin::Twin::create(rig, calib::reference_rig()).value();
  const auto still = twin->tracker_sample(0).poses;
  const auto seen = watch(rig, 4, [&](double at_s, msg::HandPoses& poses, std::int64_t&) {
    const auto header = poses.header;
    poses = still;
    poses.header = header;
    if (at_s < 1) poses.hands[0].joints[3].position_m[0] += 2e-5f * (header.frame_id % 2);
  });
  EXPECT_EQ(seen.faults.of(TrackerFault::frozen), 1u);
  EXPECT_EQ(seen.least_confidence, SourceWatch::kAtRest);
}

TEST(SourceWatch, AHandThatIsSomewhereElseForAMomentJumpsTwice) {
  const auto seen =
      watch(rig_with("builtin:wave"), 3, [](double at_s, msg::HandPoses& poses, std::int64_t&) {
        if (at_s < 1 || at_s > 1.05) return;
        for (auto& joint : poses.hands[0].joints) joint.position_m[0] += 0.06f;
      });
  expect_equal(seen.faults, only(TrackerFault::jumped, 2));
}

TEST(SourceWatch, AHandThatIsGoneForMomentsFlickers) {
  const auto seen =
      watch(rig_with("builtin:wave"), 3, [](double at_s, msg::HandPoses& poses, std::int64_t&) {
        const double phase_s = at_s - std::floor(at_s * 2) / 2;
        if (phase_s > 0.2 && phase_s < 0.23) poses.count = 0;
      });
  expect_equal(seen.faults, only(TrackerFault::flickered, 6));
}

TEST(SourceWatch, AHandThatLeavesAndReturnsDoesNotFlicker) {
  const auto seen =
      watch(rig_with("builtin:wave"), 3, [](double at_s, msg::HandPoses& poses, std::int64_t&) {
        if (at_s > 1 && at_s < 1.5) poses.count = 0;
      });
  expect_equal(seen.faults, {});
}

TEST(SourceWatch, ExchangedHandsAreSeenOnce) {
  auto rig = rig_with("builtin:two_hands");
  rig.twin.tracker.swapped = {1, 0.2};
  expect_equal(watch(rig, 3).faults, only(TrackerFault::exchanged, 1));
}

TEST(SourceWatch, SamplesThatComeLateAreCounted) {
  const auto seen = watch(rig_with("builtin:wave"), 3,
                          [](double at_s, msg::HandPoses&, std::int64_t& arrival_ns) {
                            if (at_s > 1 && at_s < 1.1) arrival_ns += 40'000'000;
                          });
  EXPECT_NEAR(seen.faults.of(TrackerFault::late), 11, 1);
}

TEST(SourceWatch, AStampOfTheFutureIsCounted) {
  const auto seen =
      watch(rig_with("builtin:wave"), 1, [](double, msg::HandPoses& poses, std::int64_t&) {
        poses.header.origin_ns += 1'000'000'000;
      });
  EXPECT_NEAR(seen.faults.of(TrackerFault::late), kRate_hz, 1);
}

TEST(SourceWatch, ASampleFromTheFutureBecomesOneWithoutHandsAtItsArrival) {
  SourceWatch watch;
  msg::HandPoses poses;
  poses.count = 1;
  poses.header.origin_ns = 61'000'000'000;
  watch.look(poses, 1'000'000'000);
  EXPECT_EQ(poses.count, 0u);
  EXPECT_EQ(poses.header.origin_ns, 1'000'000'000);
}

TEST(SourceWatch, SamplesAfterOneFromTheFutureAreFaultless) {
  const auto seen =
      watch(rig_with("builtin:wave"), 3, [](double at_s, msg::HandPoses& poses, std::int64_t&) {
        if (at_s > 1 && at_s < 1.005) poses.header.origin_ns += 60'000'000'000;
      });
  EXPECT_EQ(seen.unusable, 1);
  expect_equal(seen.faults, only(TrackerFault::late, 1));
}

TEST(SourceWatch, APoseThatNoHandHasIsCountedAndLeftOut) {
  const auto seen =
      watch(rig_with("builtin:wave"), 3, [](double at_s, msg::HandPoses& poses, std::int64_t&) {
        if (at_s > 1 && at_s < 1.02)
          poses.hands[0].joints[9].position_m[1] = std::numeric_limits<float>::quiet_NaN();
      });
  EXPECT_GE(seen.faults.of(TrackerFault::impossible), 2u);
  EXPECT_EQ(seen.faults.of(TrackerFault::jumped), 0u);
  EXPECT_EQ(static_cast<std::uint32_t>(seen.unusable), seen.faults.of(TrackerFault::impossible));
}

TEST(SourceWatch, ATrackerThatDoesNothingWrongIsLeftInPeace) {
  std::istringstream names(twin::builtin_motion_names());
  int motions = 0;
  for (std::string name; std::getline(names >> std::ws, name, ','); ++motions) {
    SCOPED_TRACE(name);
    expect_equal(watch(rig_with("builtin:" + name), 20).faults, {});
  }
  EXPECT_GE(motions, 10) << twin::builtin_motion_names();
}

TEST(SourceWatch, AFastHandIsNoFault) {
  for (const char* motion : {"builtin:wave", "builtin:shake"}) {
    SCOPED_TRACE(motion);
    expect_equal(watch(rig_with(motion, 3), 20).faults, {});
  }
}

TEST(SourceWatch, ARecordingIsNoFault) {
  const char* set = std::getenv("HANDCAST_DATA");
  const auto folder = std::filesystem::path(set ? set : "../shared/data") / "lmc";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const char* name : {"all_5s", "deformation", "rotation", "translation"}) {
    SCOPED_TRACE(name);
    const auto recording = recording::read_recording(folder / name).value();
    SourceWatch watch;
    TrackerFaults faults;
    for (std::size_t i = 0; i < recording.time_ns.size(); ++i) {
      msg::HandPoses poses;
      poses.header.origin_ns = recording.time_ns[i];
      poses.hands[poses.count++] = recording.hands[0][i];
      faults += watch.look(poses, recording.time_ns[i] + 9'000'000);
    }
    expect_equal(faults, {});
  }
}

}  // namespace
}  // namespace handcast::pose
