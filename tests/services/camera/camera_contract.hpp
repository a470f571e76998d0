// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "services/camera/camera.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/pictures.hpp"
#include "tests/services/unread_settings.hpp"

/// What every camera back end must do. A test instantiates it with the rows of a table:
///   INSTANTIATE_TEST_SUITE_P(Rows, CameraContract, testing::ValuesIn(table), name_of_row);
namespace handcast::camera {

using namespace std::chrono_literals;

class CameraContract : public testing::TestWithParam<CameraBackend> {
 protected:
  CameraContract()
      : calibration_(calib::reference_rig()), memory_(msg::CameraFrame::bytes(width(), height())) {
    rig_.camera.backend = GetParam().name;
    rig_.camera.rate_hz = 200;
    rig_.camera.replay.directory = scratch_.path();
    if (GetParam().name == "leap") {  // has only sizes of its own
      calibration_.camera.width_px = 640;
      calibration_.camera.height_px = 240;
      memory_.resize(msg::CameraFrame::bytes(width(), height()));
    }
    if (GetParam().name == "replay")
      test::write_pictures(scratch_.path(), 3, calibration_.camera.width_px,
                           calibration_.camera.height_px);
    auto opened = GetParam().open(opening_of(rig_, calibration_, epoch_ns_).value());
    if (!opened) throw std::runtime_error(opened.error().what);
    camera_ = std::move(*opened);
  }

  std::size_t width() const { return static_cast<std::size_t>(calibration_.camera.width_px); }
  std::size_t height() const { return static_cast<std::size_t>(calibration_.camera.height_px); }
  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  Result<void> capture(Deadline deadline) {
    return camera_->capture(frame(), width() * height(), deadline);
  }

  /// The second frame of a camera.
  struct SecondFrame {
    std::int64_t since_first_ns = 0, exposure_ns = 0;
    std::vector<std::uint8_t> pixels;
    /// `jitter_ns`: of a device whose clock is known only by arrivals.
    bool equals(const SecondFrame& other, std::int64_t jitter_ns) const {
      return std::abs(since_first_ns - other.since_first_ns) <= jitter_ns &&
             exposure_ns == other.exposure_ns && pixels == other.pixels;
    }
  };
  /// The second frame of a camera that is opened with `rig`. A camera from which a slow machine
  /// could not fetch the first two frames is opened again.
  std::optional<SecondFrame> second_frame(const config::Rig& rig) {
    for (int attempt = 1; attempt <= 10; ++attempt) {
      camera_.reset();  // a device is opened only once at a time
      const auto epoch_ns = now_ns() + attempt * to_ns(400ms);
      auto opened = GetParam().open(opening_of(rig, calibration_, epoch_ns).value());
      if (!opened) throw std::runtime_error(opened.error().what);
      camera_ = std::move(*opened);
      if (!capture(Deadline::in(10s))) continue;
      const std::int64_t first_ns = frame().header.origin_ns;
      if (!capture(Deadline::in(10s)) || frame().header.frame_id != 1) continue;
      const auto* pixels = frame().pixels();
      return SecondFrame{frame().header.origin_ns - first_ns,
                         frame().exposure_ns,
                         {pixels, pixels + width() * height()}};
    }
    return std::nullopt;
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
  auto late = capture(Deadline::now());
  for (int i = 0; i < 20 && late; ++i) late = capture(Deadline::now());  // images that were there
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Errc::timeout);
  EXPECT_TRUE(capture(Deadline::in(5s))) << "a timeout must not end the stream";
}

TEST_P(CameraContract, FramesNobodyFetchedAreSkippedNotQueued) {
  ASSERT_TRUE(capture(Deadline::in(5s)));
  const auto first = frame().header;
  const std::int64_t away_until_ns = now_ns() + to_ns(300ms);
  sleep_until_ns(away_until_ns);
  ASSERT_TRUE(capture(Deadline::in(5s)));
  EXPECT_GE(frame().header.frame_id, first.frame_id + 10);
  // From a queue it would be 300 ms old. On a busy machine a controller's image is on its way for
  // 60 ms.
  EXPECT_GE(frame().header.origin_ns, away_until_ns - to_ns(150ms));
}

TEST_P(CameraContract, AnImageThatDoesNotFitIsRefusedNotWritten) {
  const auto captured = camera_->capture(frame(), width() * height() - 1, Deadline::in(5s));
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::bad_config);
}

TEST_P(CameraContract, AFrameDependsOnlyOnTheSettingsThatItsRowNames) {
  rig_.camera.rate_hz = 20;
  rig_.twin.motion = "builtin:two_hands";
  const auto frame = second_frame(rig_);
  const auto other = second_frame(test::with_unread_settings_changed(rig_, "camera", GetParam()));
  ASSERT_TRUE(frame && other) << "the machine is too slow";
  const std::int64_t jitter_ns = GetParam().name == "leap" ? to_ns(8ms) : 0;
  EXPECT_TRUE(frame->equals(*other, jitter_ns)) << "a setting is missing in the row's `reads`";
}

inline std::string name_of_row(const testing::TestParamInfo<CameraBackend>& row) {
  return std::string(row.param.name);
}

/// Names the row in the messages of a failed test.
inline void PrintTo(const CameraBackend& row, std::ostream* out) { *out << row.name; }

}  // namespace handcast::camera
