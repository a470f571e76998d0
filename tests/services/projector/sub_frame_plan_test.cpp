// SPDX-License-Identifier: Apache-2.0
#include "services/projector/sub_frame_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "tests/milliseconds.hpp"

namespace handcast::projector {
namespace {

constexpr std::int64_t kPlanStart_ns = 1'000 * kMs;

/// 8 sub-frames at 800 Hz: an output frame takes 10 ms.
config::Projector settings(double software_ms) {
  config::Projector projector;
  projector.packing = config::Packing::planes_8x3;
  projector.rate_hz = 800;
  projector.latency_ms = 2;
  projector.software_ms = software_ms;
  return projector;
}

/// A machine that takes a stated time for each drawing, and a projector without a rhythm of its
/// own.
class Machine {
 public:
  explicit Machine(std::int64_t drawing_ns, double settings_ms = 0.5)
      : drawing_ns_(drawing_ns), plan_(settings(settings_ms)) {}

  /// Draws an output frame; the drawings whose numbers are in `other_ns` take other times. Returns
  /// the drawings, each with the time at which it began.
  std::vector<SubFramePlan::Drawing> output_frame(
      const std::map<std::size_t, std::int64_t>& other_ns = {}) {
    std::vector<SubFramePlan::Drawing> drawings;
    plan_.start(now_ns_);
    while (auto next = plan_.next(now_ns_)) {
      next->begin_ns = now_ns_ = std::max(now_ns_, next->begin_ns);
      const auto other = other_ns.find(drawings.size());
      const std::int64_t took_ns = other != other_ns.end() ? other->second : drawing_ns_;
      now_ns_ += took_ns;
      plan_.drawn(*next, took_ns);
      drawings.push_back(*next);
    }
    left_ = plan_.left_to_draw();
    handed_ns_ = now_ns_ = std::max(now_ns_, plan_.hand_over_ns());
    plan_.presented({handed_ns_, handed_ns_ + 2 * kMs + 5 * kMs});
    return drawings;
  }
  std::int64_t handed_ns() const { return handed_ns_; }
  /// The sub-frames without a drawing of their own at the end of the output frame.
  int left() const { return left_; }

 private:
  std::int64_t drawing_ns_;
  SubFramePlan plan_;
  std::int64_t now_ns_ = kPlanStart_ns, handed_ns_ = 0;
  int left_ = 0;
};

TEST(SubFramePlan, AFastMachineDrawsEachSubFrameForItsOwnLight) {
  Machine machine(kMs / 5);
  machine.output_frame();
  const auto drawings = machine.output_frame();
  ASSERT_EQ(drawings.size(), 8u);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(drawings[static_cast<std::size_t>(k)].first, k);
    EXPECT_EQ(drawings[static_cast<std::size_t>(k)].count, 1);
    EXPECT_EQ(drawings[static_cast<std::size_t>(k)].target_ns - machine.handed_ns(),
              2 * kMs + k * kMs * 5 / 4 + kMs * 5 / 8)
        << "the latency and the sub-frames before";
  }
}

TEST(SubFramePlan, AFastMachineBeginsLateButInTime) {
  Machine machine(kMs / 5);
  for (int i = 0; i < 32; ++i) machine.output_frame();  // software_ms is forgotten
  const auto drawings = machine.output_frame();
  const std::int64_t early_ns = machine.handed_ns() - drawings.front().begin_ns;
  EXPECT_GE(early_ns, 8 * kMs / 5);
  EXPECT_LE(early_ns, 8 * kMs / 5 + kMs);
}

TEST(SubFramePlan, OutputFramesFollowAtTheirRateAndNoneIsLate) {
  for (const std::int64_t drawing_ns : {kMs / 100, kMs / 2, 3 * kMs, 7 * kMs}) {
    Machine machine(drawing_ns, 7);
    machine.output_frame();
    for (int i = 0; i < 40; ++i) {
      const std::int64_t before_ns = machine.handed_ns();
      machine.output_frame();
      EXPECT_EQ(machine.handed_ns() - before_ns, 10 * kMs) << drawing_ns;
    }
  }
}

TEST(SubFramePlan, ASlowMachineSpreadsItsDrawingsOverTheSubFrames) {
  Machine machine(2 * kMs, 2);
  machine.output_frame();
  const auto drawings = machine.output_frame();
  ASSERT_GE(drawings.size(), 4u);
  int next = 0;
  for (const auto& drawing : drawings) {
    EXPECT_EQ(drawing.first, next);
    EXPECT_LE(drawing.count, 2) << "4 drawings in 10 ms, with the reserve";
    EXPECT_EQ(drawing.target_ns - machine.handed_ns(),
              2 * kMs + (2 * drawing.first + drawing.count) * kMs * 5 / 8);
    next += drawing.count;
  }
  EXPECT_EQ(next, 8);
}

TEST(SubFramePlan, ASlowDrawingCostsSubFramesAndNotTheRefresh) {
  Machine machine(kMs, 1);
  for (int i = 0; i < 3; ++i) machine.output_frame();
  const std::int64_t before_ns = machine.handed_ns();
  const auto drawings = machine.output_frame({{2, 4 * kMs}});
  EXPECT_LT(drawings.size(), 8u);
  EXPECT_EQ(drawings.back().first + drawings.back().count + machine.left(), 8);
  EXPECT_EQ(machine.handed_ns() - before_ns, 10 * kMs);
  EXPECT_EQ(machine.output_frame().size(), 8u);
}

TEST(SubFramePlan, ABurstOfSlowDrawingsCostsNothingIfOneWasSeenLately) {
  constexpr std::int64_t kSlow_ns = kMs * 3 / 2;
  Machine machine(kMs / 2);
  for (int i = 0; i < 3; ++i) machine.output_frame();
  EXPECT_LT(machine.output_frame({{0, kSlow_ns}, {1, kSlow_ns}, {2, kSlow_ns}}).size(), 8u);
  for (std::size_t first = 0; first < 6; ++first) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(machine.output_frame().size(), 8u);
    const auto drawings =
        machine.output_frame({{first, kSlow_ns}, {first + 1, kSlow_ns}, {first + 2, kSlow_ns}});
    EXPECT_EQ(drawings.size(), 8u) << first;
  }
}

TEST(SubFramePlan, DrawingsBeginLateAgainAfterABurst) {
  Machine machine(kMs / 2);
  for (int i = 0; i < 3; ++i) machine.output_frame();
  const auto early_ns = [&] {
    const auto drawings = machine.output_frame();
    return machine.handed_ns() - drawings.front().begin_ns;
  };
  const std::int64_t before_ns = early_ns();
  machine.output_frame({{2, 2 * kMs}});
  EXPECT_GT(early_ns(), before_ns + kMs);
  for (int i = 0; i < 31; ++i) machine.output_frame();
  EXPECT_EQ(early_ns(), before_ns);
}

TEST(SubFramePlan, ATimeThatSufficesAfterAllCostsNoSubFrame) {
  Machine machine(kMs, 1);
  for (int i = 0; i < 3; ++i) machine.output_frame();
  std::map<std::size_t, std::int64_t> other_ns{{0, kMs * 17 / 5}};  // 4.6 ms for seven are left
  for (std::size_t i = 1; i < 8; ++i) other_ns[i] = kMs / 2;
  EXPECT_EQ(machine.output_frame(other_ns).size(), 8u);
}

TEST(SubFramePlan, WithoutTimeForTheLastDrawingTheOneBeforeIsUsed) {
  Machine machine(kMs, 1);
  for (int i = 0; i < 3; ++i) machine.output_frame();
  const auto drawings = machine.output_frame({{6, 3 * kMs}});
  EXPECT_EQ(drawings.size(), 7u);
  EXPECT_EQ(machine.left(), 1);
}

TEST(SubFramePlan, AMachineThatNeedsMoreThanAnOutputFrameForADrawingSkipsWholeOnes) {
  Machine machine(12 * kMs, 12);
  machine.output_frame();
  for (int i = 0; i < 5; ++i) {
    const std::int64_t before_ns = machine.handed_ns();
    const auto drawings = machine.output_frame();
    ASSERT_EQ(drawings.size(), 1u);
    EXPECT_EQ(drawings[0].count, 8);
    EXPECT_EQ(machine.handed_ns() - before_ns, 20 * kMs);
  }
}

TEST(SubFramePlan, FollowsTheRhythmOfTheProjector) {
  SubFramePlan plan(settings(0.5));
  plan.start(kPlanStart_ns);
  plan.drawn({0, 8}, kMs / 2);
  plan.presented({.handed_ns = kPlanStart_ns + 3 * kMs,
                  .display_ns = kPlanStart_ns + 12 * kMs,
                  .next_ns = kPlanStart_ns + 17 * kMs});
  plan.start(kPlanStart_ns + 4 * kMs);
  EXPECT_EQ(plan.hand_over_ns(), kPlanStart_ns + 17 * kMs);
}

TEST(SubFramePlan, EachSubFrameIsLitForItsOwnPartOfTheOutputFrame) {
  const SubFramePlan plan(settings(1));
  const PresentTimes output{100 * kMs, 107 * kMs};
  EXPECT_EQ(plan.times_of(0, output).display_ns, 102 * kMs + kMs * 5 / 8);
  EXPECT_EQ(plan.times_of(7, output).display_ns, 112 * kMs - kMs * 5 / 8);
  EXPECT_EQ(plan.times_of(7, output).display_ns - plan.times_of(7, output).handed_ns,
            plan.times_of(0, output).display_ns - plan.times_of(0, output).handed_ns);
}

}  // namespace
}  // namespace handcast::projector
