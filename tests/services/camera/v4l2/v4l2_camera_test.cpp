// SPDX-License-Identifier: Apache-2.0
// A webcam while it streams.
#include <gmock/gmock.h>

#include <cerrno>

#include "renderer/media/jpeg.hpp"
#include "tests/services/camera/camera_contract.hpp"
#include "tests/services/camera/v4l2/webcam_test.hpp"

namespace handcast::camera {
namespace {

using config::WebcamFormat;
using test::EmulatedWebcam;
using testing::Each;
using testing::HasSubstr;

/// A webcam of the size of the paper's camera, made when the row is first opened.
const CameraBackend& row_over_a_webcam() {
  static constexpr auto kOpen = [](const Opening& with) {
    static EmulatedWebcam webcam(
        {.formats = {{.sizes = {{720, 540, {20, 200}}}}}, .controls = test::webcam_controls()});
    return open_camera(with.rig, with.calibration, with.epoch_ns);
  };
  static const CameraBackend the_row = [] {
    auto row = *std::ranges::find(camera_backends(), "v4l2", &CameraBackend::name);
    row.open = kOpen;
    return row;
  }();
  return the_row;
}
INSTANTIATE_TEST_SUITE_P(Webcam, CameraContract, testing::Values(row_over_a_webcam()), name_of_row);

class Webcam : public test::WebcamTest {
 protected:
  /// The image that was sent with the time of the last frame.
  EmulatedWebcam::Sent sent(const EmulatedWebcam& webcam) {
    EmulatedWebcam::Sent nearest;
    for (const auto& one : webcam.sent())
      if (std::abs(one.exposed_ns - frame().header.origin_ns) <
          std::abs(nearest.exposed_ns - frame().header.origin_ns))
        nearest = one;
    return nearest;
  }
  /// Waits until so many more images were sent.
  static void wait_for_images(const EmulatedWebcam& webcam, std::size_t count) {
    for (const auto before = webcam.sent().size(); webcam.sent().size() < before + count;)
      sleep_until_ns(now_ns() + 1'000'000);
  }
};

TEST_F(Webcam, EveryFormatGivesTheSameImage) {
  const EmulatedWebcam webcam(test::small_webcam());
  for (const auto format : {WebcamFormat::grey, WebcamFormat::y16, WebcamFormat::y10,
                            WebcamFormat::nv12, WebcamFormat::yuyv}) {
    for (const auto& [width, height] : {std::pair(64, 48), std::pair(33, 17)}) {
      rig_.camera.v4l2.format = format;
      calibration_.camera.width_px = width;
      calibration_.camera.height_px = height;
      ASSERT_TRUE(open());
      for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(capture());
        EXPECT_THAT(grey(), Each(grey().front())) << "padding and colour are left out";
        EXPECT_EQ(grey().front(), 10 + sent(webcam).sequence % 100);
      }
    }
  }
  EXPECT_EQ(webcam.misuses(), 0);
}

TEST_F(Webcam, MotionJpegIsDecoded) {
  EmulatedWebcam webcam(test::small_webcam());
  webcam.show([](std::uint32_t) {
    return renderer::jpeg_of(renderer::Image<std::uint32_t>(64, 48, 0xff646464).view());
  });
  rig_.camera.v4l2.format = WebcamFormat::mjpeg;
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  EXPECT_THAT(grey(), Each(100));
}

TEST_F(Webcam, ADamagedMotionJpegIsBadDataAndIsCounted) {
  EmulatedWebcam webcam(test::small_webcam());
  webcam.show([](std::uint32_t sequence) {
    auto jpeg = renderer::jpeg_of(renderer::Image<std::uint32_t>(64, 48, 0xff646464).view());
    if (sequence < 2) jpeg.resize(jpeg.size() / 2);
    return jpeg;
  });
  rig_.camera.v4l2.format = WebcamFormat::mjpeg;
  ASSERT_TRUE(open());
  const auto damaged = capture();
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, Errc::bad_data);
  EXPECT_THAT(damaged.error().what, HasSubstr("an image is"));
  ASSERT_TRUE(capture_patiently()) << "the stream goes on";
  EXPECT_GE(frame().lost.incomplete, 1u);
  EXPECT_EQ(frame().lost.incomplete + frame().lost.skipped, 2u);
}

TEST_F(Webcam, TheOriginIsTheMiddleOfTheExposure) {
  for (const std::uint32_t source : {V4L2_BUF_FLAG_TSTAMP_SRC_SOE, V4L2_BUF_FLAG_TSTAMP_SRC_EOF}) {
    auto description = test::small_webcam();
    description.stamps = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | source;
    const EmulatedWebcam webcam(description);
    rig_.camera.delivery_ms = 2;
    ASSERT_TRUE(open());
    ASSERT_TRUE(capture());
    EXPECT_EQ(frame().header.origin_ns, sent(webcam).exposed_ns + 1'000'000);
    EXPECT_GT(frame().origin_error_ns, 0);
    camera_.reset();
  }
}

TEST_F(Webcam, WithAnotherClockTheArrivalCounts) {
  for (const std::uint32_t clock :
       {V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, V4L2_BUF_FLAG_TIMESTAMP_COPY}) {
    auto description = test::small_webcam();
    description.stamps = clock;
    EmulatedWebcam webcam(description);
    webcam.set({.stamps_late_ns = -500'000'000});
    rig_.camera.delivery_ms = 2;
    ASSERT_TRUE(open());
    ASSERT_TRUE(capture());
    const auto exposed_ns = sent(webcam).exposed_ns;
    EXPECT_GE(frame().header.origin_ns, exposed_ns + 1'000'000);
    EXPECT_LE(frame().header.origin_ns, now_ns() - 3'000'000);
    EXPECT_GE(frame().origin_error_ns, 10'000'000) << "at least a period";
    camera_.reset();
  }
}

TEST_F(Webcam, StampsFromTheFutureAreNotUsed) {
  EmulatedWebcam webcam(test::small_webcam());
  webcam.set({.stamps_late_ns = 60'000'000'000});
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  EXPECT_LE(frame().header.origin_ns, now_ns());
}

TEST_F(Webcam, OlderImagesAreSkippedAndCounted) {
  const EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const auto first_id = frame().header.frame_id;
  wait_for_images(webcam, 4);
  ASSERT_TRUE(capture());
  EXPECT_GE(frame().header.frame_id, first_id + 4);
  EXPECT_EQ(frame().lost.skipped + frame().lost.underrun, frame().header.frame_id - first_id - 1);
  EXPECT_EQ(frame().lost.missing, 0u);
}

TEST_F(Webcam, AfterAPauseTheImageIsNewAndEveryLossIsCounted) {
  rig_.camera.rate_hz = 250;
  const EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const auto first = frame().header;
  const std::int64_t away_until_ns = now_ns() + 100'000'000;
  sleep_until_ns(away_until_ns);
  ASSERT_TRUE(capture());
  EXPECT_GE(frame().header.origin_ns, away_until_ns - 20'000'000);
  EXPECT_GT(frame().lost.underrun, 0u) << "no buffer was free";
  EXPECT_EQ(frame().lost.skipped + frame().lost.underrun,
            frame().header.frame_id - first.frame_id - 1);
}

TEST_F(Webcam, GapsInTheSequenceAreMissingImages) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  webcam.lose_images(3);
  std::uint32_t missing = 0;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(capture());
    missing += frame().lost.missing;
  }
  EXPECT_EQ(missing, 3u);
}

TEST_F(Webcam, BrokenImagesAreNeverDelivered) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  webcam.break_images(3);
  std::uint32_t incomplete = 0;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(capture());
    incomplete += frame().lost.incomplete;
    EXPECT_THAT(grey(), Each(grey().front()));
  }
  EXPECT_EQ(incomplete, 3u);
}

TEST_F(Webcam, ADriverThatDoesNotCountIsUsed) {
  EmulatedWebcam webcam(test::small_webcam());
  webcam.set({.does_not_count = true});
  ASSERT_TRUE(open());
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(capture());
    EXPECT_EQ(frame().lost.missing, 0u);
  }
}

TEST_F(Webcam, UnpluggedItIsDisconnectedAtOnce) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  webcam.unplug();
  const auto captured = capture_patiently();
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::disconnected);
  EXPECT_THAT(captured.error().what, HasSubstr("'Emulated Webcam' (/dev/video0, "
                                               "usb-0000:00:14.0-1) was unplugged"));
}

TEST_F(Webcam, IsOpenedAgainWhenItIsBackAndItsNumbersGoOn) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(capture());
  const auto last = frame().header;
  webcam.unplug();
  EXPECT_EQ(capture_patiently().error().code, Errc::disconnected);
  expect_refused(Errc::unavailable, HasSubstr("no camera is attached"));
  webcam.plug_in();
  sleep_until_ns(now_ns() + 50'000'000);
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  EXPECT_GT(frame().header.frame_id, last.frame_id);
  EXPECT_GT(frame().header.origin_ns, last.origin_ns);
}

TEST_F(Webcam, AnErrorOfTheDriverIsADisconnection) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  webcam.set({.stops = true});
  EXPECT_EQ(capture_patiently().error().code, Errc::disconnected);
}

TEST_F(Webcam, SilenceIsADisconnectionInTheEndAndATimeoutBefore) {
  EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  webcam.set({.is_silent = true});
  wait_for_images(webcam, 0);
  while (capture(std::chrono::milliseconds(20))) {
  }
  const auto early = capture(std::chrono::milliseconds(20));
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, Errc::timeout);
  const auto captured = capture_patiently();
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::disconnected);
  EXPECT_THAT(captured.error().what, HasSubstr("sends no more whole images"));
}

TEST_F(Webcam, ClosingItGivesEverythingBack) {
  const EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  EXPECT_TRUE(webcam.streams());
  EXPECT_GE(webcam.buffers(), 2);
  camera_.reset();
  EXPECT_FALSE(webcam.streams());
  EXPECT_EQ(webcam.buffers(), 0);
  EXPECT_EQ(webcam.misuses(), 0);
}

}  // namespace
}  // namespace handcast::camera
