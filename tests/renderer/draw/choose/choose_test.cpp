// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <chrono>
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
  View<const std::uint32_t> colour() override { return cpu_->colour(); }
  Shown shown(int step) override { return cpu_->shown(step); }

  FillCounts last;

 private:
  std::unique_ptr<Painter> cpu_;
};

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
  const auto [fast_times, slow_times] = contest(*cpu, slow, 1024, 768, 0.3);
  EXPECT_GE(slow_times.p50_ms, kSlow_ms);
  EXPECT_LT(fast_times.p50_ms, slow_times.p50_ms);
  EXPECT_LE(fast_times.p50_ms, fast_times.p99_ms);
}

TEST(Contest, ItsFramesAreAboutAsLargeAsAHand) {
  SlowPainter painter(1024, 768);
  contest(painter, painter, 1024, 768, 0);
  EXPECT_NEAR(painter.last.lit, 40'000, 8'000);
  EXPECT_NEAR(painter.last.filled, 5'000, 2'000);
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
