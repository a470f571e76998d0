// SPDX-License-Identifier: Apache-2.0
// The contract of all camera back ends.
#include "services/camera/camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scratch.hpp"
#include "tests/services/camera/pictures.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;

class CameraContract : public testing::TestWithParam<std::string_view> {
 protected:
  CameraContract()
      : calibration_(calib::reference_rig()), memory_(msg::CameraFrame::bytes(width(), height())) {
    rig_.camera.backend = GetParam();
    rig_.camera.rate_hz = 200;
    rig_.camera.replay.directory = scratch_.path();
    if (GetParam() == "replay")
      test::write_pictures(scratch_.path(), 3, calibration_.camera.width_px,
                           calibration_.camera.height_px);
    auto opened = open_camera(rig_, calibration_, epoch_ns_);
    if (!opened) throw std::runtime_error(opened.error().what);
    camera_ = std::move(*opened);
  }

  std::size_t width() const { return static_cast<std::size_t>(calibration_.camera.width_px); }
  std::size_t height() const { return static_cast<std::size_t>(calibration_.camera.height_px); }
  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  Result<void> capture(Deadline deadline) {
    return camera_->capture(frame(), width() * height(), deadline);
  }

  test::Scratch scratch_;
  config::Rig rig_;
  calib::Calibration calibration_;
  std::int64_t epoch_ns_ = now_ns();
  std::vector<std::byte> memory_;
  std::unique_ptr<Camera> camera_;
};

TEST_P(CameraContract, IdsAndOriginsIncreaseFromFrameToFrame) {
  msg::Header last{};
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(capture(Deadline::in(5s)));
    if (i > 0) {
      EXPECT_GT(frame().header.frame_id, last.frame_id);
      EXPECT_GT(frame().header.origin_ns, last.origin_ns);
    }
    last = frame().header;
  }
}

TEST_P(CameraContract, AFrameHasTheCalibrationsSizeAndWasExposedInThePast) {
  ASSERT_TRUE(capture(Deadline::in(5s)));
  EXPECT_EQ(frame().width_px, width());
  EXPECT_EQ(frame().height_px, height());
  EXPECT_GE(frame().header.origin_ns, epoch_ns_);
  EXPECT_LE(frame().header.origin_ns, now_ns());
}

TEST_P(CameraContract, ADeadlineInThePastIsATimeoutNotAHang) {
  ASSERT_TRUE(capture(Deadline::in(5s)));
  const auto late = capture(Deadline::now());
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Errc::timeout);
  EXPECT_TRUE(capture(Deadline::in(5s))) << "a timeout must not end the stream";
}

TEST_P(CameraContract, FramesNobodyFetchedAreSkippedNotQueued) {
  ASSERT_TRUE(capture(Deadline::in(5s)));
  const auto first = frame().header;
  const std::int64_t away_until_ns = now_ns() + to_ns(100ms);
  sleep_until_ns(away_until_ns);
  ASSERT_TRUE(capture(Deadline::in(5s)));
  EXPECT_GE(frame().header.frame_id, first.frame_id + 10);
  EXPECT_GE(frame().header.origin_ns, away_until_ns - to_ns(20ms));
}

TEST_P(CameraContract, AnImageThatDoesNotFitIsRefusedNotWritten) {
  const auto captured = camera_->capture(frame(), width() * height() - 1, Deadline::in(5s));
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::bad_config);
}

std::vector<std::string_view> all() { return service::names_of(camera_backends()); }
INSTANTIATE_TEST_SUITE_P(Backends, CameraContract, testing::ValuesIn(all()),
                         [](const auto& named) { return std::string(named.param); });

TEST(Camera, AnUnknownBackEndIsRefusedWithTheKnownOnesNamed) {
  config::Rig rig;
  rig.camera.backend = "polaroid";
  const auto opened = open_camera(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what,
              testing::AllOf(testing::HasSubstr("polaroid"), testing::HasSubstr("twin, replay")));
}

}  // namespace
}  // namespace handcast::camera
