// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "tests/renderer/pipeline/driven_pipeline.hpp"

namespace handcast::renderer {
namespace {

/// Draws like cpu until one of its frames fails. That frame and all later ones are dark.
class FailingPainter final : public Painter {
 public:
  FailingPainter(int good_frames, int& draws) : good_frames_(good_frames), draws_(draws) {}

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    if (++draws_ <= good_frames_) cpu_->draw(hands, region);
  }
  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    if (draws_ <= good_frames_) cpu_->warp(grid, from, region);
  }
  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    return draws_ <= good_frames_ ? cpu_->fill(mask, settings, region) : FillCounts{};
  }
  void darken(std::span<const Rect> areas, Rect region) override { cpu_->darken(areas, region); }
  View<const std::uint32_t> colour() override {
    return draws_ <= good_frames_ ? cpu_->colour() : std::as_const(dark_).view();
  }
  Shown shown(int step) override { return cpu_->shown(step); }
  std::optional<Error> failure() const override {
    if (draws_ <= good_frames_) return {};
    return Error{Errc::unavailable, "painter test: the GPU was lost"};
  }

 private:
  std::unique_ptr<Painter> cpu_ = make_cpu_painter(1024, 768);
  Image<std::uint32_t> dark_{1024, 768};
  int good_frames_;
  int& draws_;
};

void expect_equal_light(const Frame& frame, const Frame& expected) {
  ASSERT_GT(lit_pixels(expected), 20'000);
  EXPECT_EQ(frame.fill.lit, expected.fill.lit);
  EXPECT_EQ(frame.fill.filled, expected.fill.filled);
  const Rect& r = expected.region;
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x)
      ASSERT_EQ(frame.colour.at(x, y), expected.colour.at(x, y)) << x << ' ' << y;
}

class FailingPainterTest : public ::testing::TestWithParam<config::FillMethod> {};
INSTANTIATE_TEST_SUITE_P(Fills, FailingPainterTest,
                         ::testing::Values(config::FillMethod::none, config::FillMethod::reflect),
                         [](const auto& each) {
                           return std::string(words_of(each.param)[static_cast<int>(each.param)]);
                         });

TEST_P(FailingPainterTest, IsReplacedWithinTheFrameSoThatNoneIsDark) {
  const config::Cascade settings = cascade(config::CorrectMethod::vertices, GetParam());
  const calib::Calibration calibration = rig_above_hand();
  int draws = 0;
  const auto failing = *Pipeline::create(settings, {.smooth = false}, {}, calibration, {},
                                         std::make_unique<FailingPainter>(2, draws));
  const auto healthy = make_pipeline(settings);
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand}, {6, 4});
  feed_still(*failing, {hand});
  feed_still(*healthy, {hand});
  testing::internal::CaptureStderr();
  for (int i = 0; i < 5; ++i) {
    const std::int64_t now_ns = (104 + i) * kMs;
    const TimedImage camera{image.view(), now_ns - 2 * kMs};
    const Frame frame = failing->render(now_ns, now_ns + 4 * kMs, camera);
    expect_equal_light(frame, healthy->render(now_ns, now_ns + 4 * kMs, camera));
  }
  EXPECT_EQ(draws, 3) << "it is not asked again";
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, ::testing::HasSubstr("the GPU was lost; drawing with cpu"));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
}

}  // namespace
}  // namespace handcast::renderer
