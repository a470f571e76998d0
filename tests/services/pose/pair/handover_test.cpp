// SPDX-License-Identifier: Apache-2.0
// Two trackers of the twin with different errors, in virtual time.
#include "services/pose/pair/handover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::pose {
namespace {

/// One sample that was published.
struct Published {
  From from;
  msg::HandPoses poses;
};

/// What the first tracker does at a time: returns false if the sample has no usable hand.
using Fault = std::function<bool(double at_s, msg::HandPoses& poses)>;

/// Trackers of one true hand: the second one is placed 15 mm beside it and turned by 2 degrees.
class Handovers : public testing::Test {
 protected:
  Handovers() {
    rig_.twin.motion = "builtin:wave";
    first_ = open(rig_);
    auto other = rig_;
    other.twin.tracker.offset_mm = 15;
    other.twin.tracker.rotation_deg = 2;
    other.twin.tracker.scale = 1;
    other.twin.tracker.rate_hz = 90;
    other.twin.tracker.age_ms = 20;
    second_ = open(other);
  }

  static std::unique_ptr<twin::Twin> open(const config::Rig& rig) {
    auto twin = twin::Twin::create(rig, calib::reference_rig());
    if (!twin) throw std::runtime_error(twin.error().what);
    return std::move(*twin);
  }

  /// The stream of both trackers over some seconds.
  std::vector<Published> run(const config::Handover& settings, double seconds, const Fault& first,
                             const Fault& second = {}) const {
    struct Arrival {
      From from;
      twin::Twin::TrackerSample sample;
    };
    std::vector<Arrival> arrivals;
    const auto add = [&](From from, const twin::Twin& twin) {
      for (std::uint64_t k = 0;; ++k) {
        arrivals.push_back({from, twin.tracker_sample(k)});
        if (ns_to_seconds(arrivals.back().sample.arrival_ns) > seconds) break;
      }
    };
    add(From::first, *first_);
    add(From::second, *second_);
    std::ranges::stable_sort(arrivals, {}, [](const auto& a) { return a.sample.arrival_ns; });
    Handover handover(settings);
    std::vector<Published> published;
    for (auto& [from, sample] : arrivals) {
      const auto& fault = from == From::first ? first : second;
      const double at_s = ns_to_seconds(sample.arrival_ns);
      const bool is_usable = !fault || fault(at_s, sample.poses);
      if (const auto poses = handover.push(from, sample.poses, sample.arrival_ns,
                                           is_usable && sample.poses.count > 0))
        published.push_back({from, *poses});
    }
    return published;
  }

  /// What the first tracker reports at a time, or would if it had no fault.
  msg::HandPose first_at(std::int64_t time_ns) const {
    std::uint64_t k = static_cast<std::uint64_t>(ns_to_seconds(time_ns) * 110.6) + 3;
    while (k > 0 && first_->tracker_sample(k).poses.header.origin_ns > time_ns) --k;
    const auto before = first_->tracker_sample(k).poses,
               after = first_->tracker_sample(k + 1).poses;
    const auto step_ns = after.header.origin_ns - before.header.origin_ns;
    const auto share =
        static_cast<float>(time_ns - before.header.origin_ns) / static_cast<float>(step_ns);
    return JointOffsets::between(before.hands[0], after.hands[0]).applied(before.hands[0], share);
  }

  /// By how much the largest error of a joint against the first tracker changes between two
  /// samples, at handovers or elsewhere. mm.
  float largest_step_mm(const std::vector<Published>& stream, bool at_handovers) const {
    float largest_mm = 0;
    const Published* last = nullptr;
    for (const auto& item : stream) {
      if (item.poses.count == 0) continue;
      if (last && (item.from != last->from) == at_handovers) {
        const auto error = [&](const msg::HandPoses& poses) {
          return JointOffsets::between(first_at(poses.header.origin_ns), poses.hands[0]);
        };
        largest_mm = std::max(largest_mm, 1e3f * error(item.poses).farthest_m(error(last->poses)));
      }
      last = &item;
    }
    return largest_mm;
  }

  config::Rig rig_;
  std::unique_ptr<twin::Twin> first_, second_;
};

Fault gone(double from_s, double to_s) {
  return [=](double at_s, msg::HandPoses& poses) {
    if (at_s > from_s && at_s < to_s) poses.count = 0;
    return true;
  };
}

glm::vec3 place(const msg::HandPoses& poses, int joint) {
  const auto& at = poses.hands[0].joints[joint].position_m;
  return {at[0], at[1], at[2]};
}

int changes(const std::vector<Published>& stream) {
  int count = 0;
  for (std::size_t i = 1; i < stream.size(); ++i) count += stream[i].from != stream[i - 1].from;
  return count;
}

TEST_F(Handovers, TheFirstSourceIsUsedAsLongAsItSeesAHand) {
  const auto stream = run({}, 2, {});
  EXPECT_GT(stream.size(), 200u);
  for (const auto& item : stream) ASSERT_EQ(item.from, From::first);
}

TEST_F(Handovers, ASecondSourceWithoutAHandStandsInForASilentFirstOne) {
  Handover handover({.patience_ms = 60});
  const auto push = [&](From from, std::int64_t at_ms) {
    msg::HandPoses none;
    none.header = {static_cast<std::uint64_t>(at_ms), at_ms * 1'000'000, 0};
    return handover.push(from, none, at_ms * 1'000'000, false).has_value();
  };
  EXPECT_TRUE(push(From::first, 100));
  EXPECT_FALSE(push(From::second, 150)) << "the first one speaks for itself";
  EXPECT_TRUE(push(From::second, 170)) << "it is silent";
  EXPECT_EQ(handover.in_use(), From::first);
  EXPECT_TRUE(push(From::first, 180));
  EXPECT_FALSE(push(From::second, 190));
}

TEST_F(Handovers, TimesAndNumbersIncreaseAcrossAllHandovers) {
  const auto stream = run({.return_ms = 100}, 6, [](double at_s, msg::HandPoses& poses) {
    if (at_s - std::floor(at_s) > 0.5) poses.count = 0;
    return true;
  });
  EXPECT_GE(changes(stream), 10);
  for (std::size_t i = 1; i < stream.size(); ++i) {
    ASSERT_GT(stream[i].poses.header.origin_ns, stream[i - 1].poses.header.origin_ns);
    ASSERT_GT(stream[i].poses.header.frame_id, stream[i - 1].poses.header.frame_id);
  }
}

TEST_F(Handovers, TheSecondSourceTakesOverAndGivesBackWithoutAJump) {
  const auto fault = gone(2, 4);
  const auto blended = run({}, 7, fault), hard = run({.blend_ms = 0}, 7, fault);
  EXPECT_EQ(changes(blended), 2);
  EXPECT_EQ(changes(hard), 2);
  const float with_mm = largest_step_mm(blended, true), without_mm = largest_step_mm(hard, true);
  std::printf("largest step at a handover: %.2f mm blended, %.2f mm without; elsewhere %.2f mm\n",
              with_mm, without_mm, largest_step_mm(blended, false));
  EXPECT_GT(without_mm, 10) << "the trackers differ";
  EXPECT_LT(with_mm, 0.3f * without_mm);
}

TEST_F(Handovers, AfterTheBlendTheSecondSourceIsReportedAsItIs) {
  const config::Handover settings{.blend_ms = 200};
  const auto stream = run(settings, 4, gone(2, 9));
  const auto plain = run(settings, 4, gone(0, 9));
  const auto& last = stream.back();
  const auto same = std::ranges::find(plain, last.poses.header.origin_ns,
                                      [](const auto& p) { return p.poses.header.origin_ns; });
  ASSERT_NE(same, plain.end());
  EXPECT_EQ(place(last.poses, 10), place(same->poses, 10));
  std::int64_t begin_ns = 0, end_ns = 0;
  for (const auto& item : stream) {
    const auto twin_of = std::ranges::find(plain, item.poses.header.origin_ns,
                                           [](const auto& p) { return p.poses.header.origin_ns; });
    if (item.from == From::first || twin_of == plain.end()) continue;
    if (!begin_ns) begin_ns = item.poses.header.origin_ns;
    if (place(item.poses, 10) != place(twin_of->poses, 10)) end_ns = item.poses.header.origin_ns;
  }
  std::printf("the blend of 200 ms lasted %.0f ms from the first sample of the second source\n",
              ns_to_ms(end_ns - begin_ns));
  EXPECT_LE(end_ns - begin_ns, 200'000'000);
  EXPECT_GT(end_ns, begin_ns);
}

TEST_F(Handovers, AShortLossIsWaitedFor) {
  const auto stream = run({.patience_ms = 100}, 4, gone(2, 2.07));
  EXPECT_EQ(changes(stream), 0);
}

TEST_F(Handovers, ASourceThatRepeatsAPoseIsLostAndItsPoseIsNotContinued) {
  std::optional<msg::HandPoses> frozen;
  const auto stream = run({}, 5, [&](double at_s, msg::HandPoses& poses) {
    if (at_s < 2) return true;
    if (!frozen) frozen = poses;
    const auto header = poses.header;
    poses = *frozen;
    poses.header = header;
    return false;
  });
  EXPECT_EQ(changes(stream), 1);
  EXPECT_EQ(stream.back().from, From::second);
}

TEST_F(Handovers, ASourceThatGoesAstrayBeforeItIsLostDoesNotTakeTheOtherOneWithIt) {
  const auto astray = [](double at_s, msg::HandPoses& poses) {
    if (at_s > 1.9)
      for (auto& joint : poses.hands[0].joints) joint.position_m[0] += 0.12f;
    if (at_s > 2) poses.count = 0;
    return true;
  };
  const auto stream = run({}, 4, astray);
  const auto plain = run({}, 4, gone(0, 9));
  float farthest_mm = 0;
  for (const auto& item : stream) {
    if (item.from == From::first) continue;
    const auto same = std::ranges::find(plain, item.poses.header.origin_ns,
                                        [](const auto& p) { return p.poses.header.origin_ns; });
    if (same == plain.end()) continue;
    farthest_mm =
        std::max(farthest_mm, 1e3f * glm::distance(place(item.poses, 10), place(same->poses, 10)));
  }
  EXPECT_LT(farthest_mm, 40) << "the mean difference of the trackers, and not 120 mm";
}

TEST_F(Handovers, TheFirstSourceMustBeWellForAWhileBeforeItIsUsedAgain) {
  const auto flickering = [](double at_s, msg::HandPoses& poses) {
    const bool is_gone = at_s > 2 && at_s < 4 && std::fmod(at_s, 0.3) > 0.1;
    if (is_gone) poses.count = 0;
    return true;
  };
  EXPECT_EQ(changes(run({}, 6, flickering)), 2) << "once there, and once back after 4 s";
}

TEST_F(Handovers, IfBothAreLostWhatComesBackFirstIsUsed) {
  const auto stream = run({}, 6, gone(2, 9), gone(2, 4));
  EXPECT_EQ(stream.back().from, From::second);
  const auto other = run({}, 6, gone(2, 4), gone(1, 9));
  EXPECT_EQ(other.back().from, From::first);
}

TEST_F(Handovers, OrientationsAreBlendedToo) {
  const auto fault = gone(2, 9);
  const auto first_of_second = [&](const config::Handover& settings) {
    const auto stream = run(settings, 3, fault);
    return *std::ranges::find(stream, From::second, &Published::from);
  };
  const auto blended = first_of_second({}), hard = first_of_second({.blend_ms = 0});
  ASSERT_EQ(blended.poses.header.origin_ns, hard.poses.header.origin_ns);
  for (int j = 0; j < msg::kJoints; ++j) {
    const auto &p = blended.poses.hands[0].joints[j].orientation_xyzw,
               &q = hard.poses.hands[0].joints[j].orientation_xyzw;
    const double along = std::abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]);
    EXPECT_LT(along, std::cos(glm::radians(0.5))) << j << ": the trackers differ by 2 degrees";
    EXPECT_NEAR(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3], 1, 1e-4);
  }
}

}  // namespace
}  // namespace handcast::pose
