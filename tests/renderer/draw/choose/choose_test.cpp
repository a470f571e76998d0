// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <thread>

#include "renderer/draw/choose/open_painter.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "tests/renderer/draw/painter_scene.hpp"

namespace handcast::renderer::test {
namespace {

using config::PainterChoice;
using testing::HasSubstr;

constexpr int kSlow_ms = 40;  ///< more than what other processes and sanitizers add to a frame

/// A painter that takes longer, and counts what it fills.
class SlowPainter final : public Painter {
 public:
  SlowPainter(int width_px, int height_px) : cpu_(make_cpu_painter(width_px, height_px)) {}

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(kSlow_ms));
    cpu_->draw(hands, region);
  }
  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    cpu_->warp(grid, from, region);
  }
  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    return last = cpu_->fill(mask, settings, region);
  }
  void darken(std::span<const Rect> areas, Rect region) override { cpu_->darken(areas, region); }
  View<const std::uint32_t> colour() override { return cpu_->colour(); }
  Shown shown(int step) override { return cpu_->shown(step); }

  FillCounts last;

 private:
  std::unique_ptr<Painter> cpu_;
};

/// The time of painters that paint nothing.
struct FakeTime {
  std::int64_t now_ns = 0;
};

/// Takes a given time for each frame.
class FakePainter final : public Painter {
 public:
  using FrameMs = std::function<double(int frame)>;

  FakePainter(FakeTime& time, FrameMs frame_ms) : time_(time), frame_ms_(std::move(frame_ms)) {}

  void draw(std::span<const DrawnHand> /*hands*/, Rect /*region*/) override {
    time_.now_ns += ms_to_ns(frame_ms_(frames++));
  }
  void warp(const WarpGrid& /*grid*/, Rect /*from*/, Rect /*region*/) override {}
  FillCounts fill(View<const std::uint8_t> /*mask*/, const config::Fill& /*settings*/,
                  Rect /*region*/) override {
    return {};
  }
  void darken(std::span<const Rect> /*areas*/, Rect /*region*/) override {}
  View<const std::uint32_t> colour() override { return {}; }
  Shown shown(int) override { return {}; }

  int frames = 0;

 private:
  FakeTime& time_;
  FrameMs frame_ms_;
};

/// A contest of painters whose frames take these times.
struct FakeContest {
  FakeContest(FakePainter::FrameMs one_ms, FakePainter::FrameMs other_ms)
      : one(time, std::move(one_ms)), other(time, std::move(other_ms)) {
    times = contest(one, other, 200, 150, {}, [this] { return time.now_ns; });
  }

  FakeTime time;
  FakePainter one, other;
  std::pair<FrameTime, FrameTime> times;
};

FakePainter::FrameMs always(double ms) {
  return [ms](int /*frame*/) { return ms; };
}

/// Opens a painter and returns what it logs.
std::string log_of(PainterChoice choice, std::unique_ptr<Painter>& painter) {
  testing::internal::CaptureStderr();
  painter = open_painter(choice, 200, 150);
  return testing::internal::GetCapturedStderr();
}

void expect_draws(Painter& painter) {
  Shape shape;
  shape.rectangle({20, 20}, {120, 100});
  draw(painter, shape, {0, 0, 200, 150});
  EXPECT_NE(painter.colour().at(50, 50), 0u);
}

TEST(Contest, TheSlowerPainterHasTheLongerFrames) {
  const auto cpu = make_cpu_painter(1024, 768);
  SlowPainter slow(1024, 768);
  const auto [fast_times, slow_times] = contest(*cpu, slow, 1024, 768);
  EXPECT_GE(slow_times.p50_ms, kSlow_ms);
  EXPECT_LT(fast_times.p50_ms, slow_times.p50_ms);
  EXPECT_LE(fast_times.p50_ms, fast_times.p99_ms);
}

TEST(Contest, ItsFramesAreAboutAsLargeAsAHand) {
  SlowPainter painter(1024, 768);
  contest(painter, painter, 1024, 768, {.limit_s = 0});
  EXPECT_NEAR(painter.last.lit, 40'000, 8'000);
  EXPECT_NEAR(painter.last.filled, 5'000, 2'000);
}

TEST(Contest, EndsAsSoonAsThreeRoundsAreClear) {
  constexpr int kFrames = 3 * 4;
  for (const bool is_first_faster : {false, true}) {
    const FakeContest clear(always(is_first_faster ? 1 : 2), always(is_first_faster ? 2 : 1));
    EXPECT_EQ(clear.one.frames, kFrames);
    EXPECT_EQ(clear.other.frames, kFrames);
    EXPECT_EQ(clear.times.first.p50_ms < clear.times.second.p50_ms, is_first_faster);
  }
}

TEST(Contest, GoesOnUntilItsLimitIfPaintersAreAlike) {
  const FakeContest alike(always(1), always(1.4));
  EXPECT_NEAR(ns_to_ms(alike.time.now_ns), 300, 1.4);
  EXPECT_NEAR(alike.times.first.p50_ms, 1, 1e-9);
  EXPECT_NEAR(alike.times.second.p50_ms, 1.4, 1e-9);
}

TEST(Contest, IsNotDecidedByAWinInEverySecondRound) {
  const FakeContest alternating(always(1), [](int frame) { return frame / 4 % 2 ? 0.9 : 2; });
  EXPECT_NEAR(ns_to_ms(alternating.time.now_ns), 300, 2);
}

TEST(Contest, OfASlowPainterOnlyTheFramesWithinTheLimitAreWaitedFor) {
  const FakeContest slow(always(0.5), always(70));
  EXPECT_LE(ns_to_ms(slow.time.now_ns), 300 + 70);
  EXPECT_NEAR(slow.times.second.p50_ms, 70, 1e-9);
  const FakeContest hopeless(always(1000), always(1));
  EXPECT_EQ(hopeless.one.frames, 2) << "one that warms up and one that counts";
  EXPECT_EQ(hopeless.other.frames, 2);
  EXPECT_NEAR(hopeless.times.first.p50_ms, 1000, 1e-9);
}

TEST(Contest, TheFirstFrameOfARoundDoesNotCount) {
  const FakeContest warm([](int frame) { return frame % 4 == 0 ? 50 : 1; }, always(2));
  EXPECT_NEAR(warm.times.first.p99_ms, 1, 1e-9);
  EXPECT_EQ(warm.one.frames, 3 * 4);
}

TEST(OpenPainter, CpuIsSilent) {
  std::unique_ptr<Painter> painter;
  EXPECT_EQ(log_of(PainterChoice::cpu, painter), "");
  expect_draws(*painter);
}

TEST(OpenPainter, GlNamesItsGpuOrSaysWhyCpuDraws) {
  std::unique_ptr<Painter> painter;
  const std::string log = log_of(PainterChoice::gl, painter);
  EXPECT_THAT(log,
              testing::AnyOf(testing::ContainsRegex("painter gl: .+, a (software|hardware)"),
                             testing::ContainsRegex("cannot be opened: .+; drawing with cpu")));
  expect_draws(*painter);
}

TEST(OpenPainter, AutoSaysWhatItMeasured) {
  std::unique_ptr<Painter> painter;
  const std::string log = log_of(PainterChoice::automatic, painter);
  if (log.find("cannot be opened") != std::string::npos) GTEST_SKIP() << log;
  EXPECT_THAT(log, testing::ContainsRegex("painter auto: (cpu|gl) is faster: a frame takes "
                                          "[0-9.]+ ms .+ with cpu, [0-9.]+ ms .+ with gl on "));
  expect_draws(*painter);
}

#ifdef HANDCAST_WITH_GL
TEST(OpenPainter, WithoutADisplayOfEglCpuDraws) {
  // A new process: EGL reads the list of drivers once, and threads of a driver do not survive a
  // fork.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1);
        const auto painter = open_painter(PainterChoice::gl, 200, 150);
        expect_draws(*painter);
        _exit(testing::Test::HasFailure() ? 1 : 0);
      },
      testing::ExitedWithCode(0), "painter gl cannot be opened: .*EGL.*; drawing with cpu");
}
#endif

}  // namespace
}  // namespace handcast::renderer::test
