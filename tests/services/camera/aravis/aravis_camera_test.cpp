// SPDX-License-Identifier: Apache-2.0
#include <arv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <span>
#include <thread>

#include "config/settings/choice.hpp"
#include "services/camera/aravis/device.hpp"
#include "services/camera/aravis/pixels.hpp"
#include "services/camera/camera.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/aravis/fake_camera.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;
using test::FakeCamera;
using testing::AllOf;
using testing::HasSubstr;

/// A rig with a GigE Vision camera at the loopback.
class AravisCamera : public testing::Test {
 protected:
  AravisCamera() : memory_(msg::CameraFrame::bytes(kWidth, kHeight)) {
    calibration_.camera.width_px = kWidth;
    calibration_.camera.height_px = kHeight;
    rig_.camera.backend = "aravis";
    rig_.camera.rate_hz = 200;
    rig_.camera.exposure_ms = 1;
    rig_.camera.aravis.device = "127.0.0.1";
    rig_.camera.aravis.packet_bytes = 8000;
  }

  Result<void> open() {
    camera_.reset();
    auto opened = open_camera(rig_, calibration_, now_ns());
    if (!opened) return tl::make_unexpected(opened.error());
    camera_ = std::move(*opened);
    return {};
  }
  std::string refusal() {
    const auto opened = open();
    if (opened) return "it was accepted";
    EXPECT_EQ(opened.error().code, Errc::bad_config) << opened.error().what;
    return opened.error().what;
  }

  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  Result<void> capture(std::chrono::nanoseconds within = 5s) {
    frame().lost = {};
    return camera_->capture(frame(), kWidth * kHeight, Deadline::in(within));
  }
  /// Captures until there is an image. The last error, if there was one.
  std::string capture_again(std::chrono::nanoseconds within) {
    std::string error;
    for (const auto until = Deadline::in(within); !until.passed();) {
      const auto captured = capture(20ms);
      if (captured) return error;
      EXPECT_EQ(captured.error().code, Errc::timeout) << captured.error().what;
      error = captured.error().what;
    }
    ADD_FAILURE() << "no image: " << error;
    return error;
  }

  /// Puts a camera at the loopback.
  void plug_in(FakeCamera::Fill fill = {}) {
    fake_ = std::make_unique<FakeCamera>(std::move(fill));
    ASSERT_TRUE(fake_->is_running());
  }

  static constexpr int kWidth = 360, kHeight = 270;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::vector<std::byte> memory_;
  std::atomic<std::uint32_t> count_ = 0;    ///< images drawn by the camera
  std::atomic<std::int64_t> drawn_ns_ = 0;  ///< when it drew the last one
  std::unique_ptr<FakeCamera> fake_;
  std::unique_ptr<Camera> camera_;
};

/// Writes the number of an image into its first bytes.
FakeCamera::Fill numbered(std::atomic<std::uint32_t>& count) {
  return [&count](std::uint8_t* pixels, std::size_t bytes) {
    const std::uint32_t number = ++count;
    std::memset(pixels, static_cast<int>(number % 251), bytes);
    std::memcpy(pixels, &number, sizeof(number));
  };
}

std::uint32_t total(const msg::FrameLosses& lost) {
  return lost.missing + lost.incomplete + lost.underrun + lost.skipped;
}

std::uint32_t number_in(const msg::CameraFrame& frame) {
  std::uint32_t number = 0;
  std::memcpy(&number, frame.pixels(), sizeof(number));
  return number;
}

TEST_F(AravisCamera, ImagesComeWholeAndInOrderWithTheNumbersOfTheCamera) {
  plug_in(numbered(count_));
  ASSERT_TRUE(open());
  std::uint64_t last_id = 0;
  std::uint32_t last_number = 0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(capture());
    const auto number = number_in(frame());
    if (i > 0) {
      EXPECT_EQ(frame().header.frame_id - last_id, number - last_number);
    }
    last_id = frame().header.frame_id;
    last_number = number;
    const auto* pixels = frame().pixels();
    EXPECT_TRUE(std::all_of(pixels + 4, pixels + kWidth * kHeight,
                            [&](std::uint8_t pixel) { return pixel == number % 251; }));
    EXPECT_EQ(frame().exposure_ns, 1'000'000);
  }
}

TEST_F(AravisCamera, TheOriginIsTheMiddleOfTheExposureByTheClockOfThisComputer) {
  // The fake camera's clock is CLOCK_REALTIME, its stamp is taken when it has drawn the image. The
  // image arrives at least delivery_ms after its exposure.
  rig_.camera.delivery_ms = 0.2;
  plug_in([this](std::uint8_t*, std::size_t) { drawn_ns_ = now_ns(); });
  ASSERT_TRUE(open());
  std::int64_t last_ns = 0;
  int between = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(capture());
    const std::int64_t origin_ns = frame().header.origin_ns;
    EXPECT_GT(origin_ns, last_ns);
    last_ns = origin_ns;
    // From the drawing to the end of the exposure: the least delay less delivery_ms.
    const auto end_ns = origin_ns + frame().exposure_ns / 2;
    between += end_ns >= drawn_ns_ - 500'000 && end_ns < drawn_ns_ + 3'000'000;
    EXPECT_LE(origin_ns, now_ns() - frame().exposure_ns / 2 - 200'000);
    EXPECT_GE(frame().origin_error_ns, 0);
    EXPECT_LT(frame().origin_error_ns, 2'000'000);
  }
  EXPECT_GE(between, 80);
}

TEST_F(AravisCamera, SettingsArriveInTheRegistersOfTheCamera) {
  plug_in();
  rig_.camera.aravis.offset_x_px = 64;
  rig_.camera.aravis.offset_y_px = 32;
  rig_.camera.aravis.gain_db = 7;
  rig_.camera.aravis.features = {"TestRegister=4711"};
  ASSERT_TRUE(open());
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_WIDTH), 360u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_HEIGHT), 270u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_X_OFFSET), 64u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET), 32u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US), 1000u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US), 5000u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_GAIN_RAW), 7u);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT), ARV_PIXEL_FORMAT_MONO_8);
  EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_TEST), 4711u);
}

TEST_F(AravisCamera, ARefusedSettingIsNamedWithTheRangeOfTheCamera) {
  plug_in();
  const auto good = rig_.camera;
  const auto refused = [&](auto change) {
    rig_.camera = good;
    change(rig_.camera);
    return refusal();
  };
  EXPECT_THAT(refused([](auto& c) { c.aravis.offset_x_px = 2000; }),
              AllOf(HasSubstr("360 x 270 px at 2000, 0"), HasSubstr("2048 x 2048 px")));
  EXPECT_THAT(refused([](auto& c) { c.aravis.gain_db = 50; }),
              AllOf(HasSubstr("aravis.gain_db"), HasSubstr("50"), HasSubstr("0..10")));
  EXPECT_THAT(refused([](auto& c) { c.aravis.format = config::PixelFormat::mono12_packed; }),
              AllOf(HasSubstr("aravis.format"), HasSubstr("Mono8")));
  EXPECT_THAT(refused([](auto& c) { c.aravis.features = {"NoSuchThing=1"}; }),
              HasSubstr("the camera has no feature 'NoSuchThing'"));
  EXPECT_THAT(refused([](auto& c) { c.aravis.features = {"AcquisitionMode=Sideways"}; }),
              AllOf(HasSubstr("AcquisitionMode"), HasSubstr("Continuous")));
  EXPECT_THAT(refused([](auto& c) { c.aravis.features = {"GainRaw=eleven"}; }),
              AllOf(HasSubstr("GainRaw"), HasSubstr("whole number")));
  EXPECT_THAT(refused([](auto& c) { c.aravis.features = {"GainRaw"}; }),
              HasSubstr("GainRaw=VALUE"));
  EXPECT_THAT(refused([](auto& c) {
                c.exposure_ms = 100;
                c.rate_hz = 2000;
              }),
              HasSubstr("rate_hz: 2000 Hz is outside"));
}

TEST_F(AravisCamera, AnImageOfTheCalibrationThatTheSensorDoesNotHaveIsRefused) {
  plug_in();
  calibration_.camera.width_px = 4096;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("4096 x 270 px"), HasSubstr("2048 x 2048 px"),
                               HasSubstr("calibration")));
}

TEST_F(AravisCamera, PixelsOfEveryFormatArriveAsGrey) {
  const std::vector<std::pair<std::string, std::uint32_t>> formats{
      {"Mono10", 0x01100003}, {"Mono10p", 0x010a0046}, {"Mono10Packed", 0x010c0004},
      {"Mono12", 0x01100005}, {"Mono12p", 0x010c0047}, {"Mono12Packed", 0x010c0006}};
  const test::Scratch scratch;
  FakeCamera::offer(formats, scratch.path() / "camera.xml");
  const std::shared_ptr<void> at_the_end(nullptr, [](void*) { FakeCamera::offer_the_usual(); });
  for (const auto& [name, value] : formats) {
    SCOPED_TRACE(name);
    const auto format = *config::choice_named<config::PixelFormat>(name);
    rig_.camera.aravis.format = format;
    std::vector<std::uint8_t> sent(bytes_of(format, kWidth * kHeight)), grey(kWidth * kHeight);
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint8_t>(i % 251);
    to_grey(format, sent, grey);
    plug_in([&](std::uint8_t* pixels, std::size_t bytes) {
      std::memcpy(pixels, sent.data(), std::min(bytes, sent.size()));
    });
    const auto opened = open();
    ASSERT_TRUE(opened) << opened.error().what;
    ASSERT_TRUE(capture());
    EXPECT_EQ(fake_->read(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT), value);
    EXPECT_TRUE(std::ranges::equal(grey, std::span(frame().pixels(), grey.size())));
    camera_.reset();
    fake_.reset();
  }
}

TEST_F(AravisCamera, ACameraThatWasNotCalibratedIsRefused) {
  plug_in();
  calibration_.camera_device = "23456789";
  EXPECT_THAT(refusal(), HasSubstr("made with the camera '23456789', and this is 'GV01'"));
  calibration_.camera_device = "GV01";
  EXPECT_TRUE(open());
}

TEST_F(AravisCamera, ALostPacketCostsItsImageAndIsCounted) {
  plug_in();
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  fake_->lose(0.02);  // one image of 97,200 bytes has 13 packets
  std::uint64_t first = frame().header.frame_id, last = first, images = 0, lost = 0, by_packets = 0;
  for (const auto until = Deadline::in(10s); images < 100 && !until.passed();) {
    if (!capture(1s)) continue;
    ++images;
    last = frame().header.frame_id;
    lost += total(frame().lost);
    by_packets += frame().lost.incomplete + frame().lost.missing;
  }
  EXPECT_EQ(images, 100u);
  EXPECT_GT(by_packets, 5u);
  EXPECT_EQ(last - first, images + lost);
}

TEST_F(AravisCamera, PacketsThatAllStayOnTheWayAreSaidWithTheRemedy) {
  plug_in();
  fake_->lose(1);
  ASSERT_TRUE(open());
  std::string said;
  for (const auto until = Deadline::in(5s);
       !until.passed() && said.find("packet_bytes") == said.npos;) {
    const auto captured = capture(20ms);
    ASSERT_FALSE(captured);
    said = captured.error().what;
  }
  EXPECT_THAT(said, HasSubstr("answers, but none of its images arrives; packets of 8000 bytes"));
  fake_->lose(0);
  capture_again(5s);
}

TEST_F(AravisCamera, ImagesThatNobodyFetchedAreCountedAsSkipped) {
  plug_in();
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const auto first = frame().header.frame_id;
  std::this_thread::sleep_for(200ms);
  ASSERT_TRUE(capture());
  EXPECT_GE(frame().lost.skipped, 10u);
  EXPECT_EQ(frame().header.frame_id - first, 1 + total(frame().lost));
}

TEST_F(AravisCamera, ACameraThatLeavesAndReturnsIsOpenedAgain) {
  plug_in();
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const auto before = frame().header;
  fake_.reset();
  std::string error;
  for (const auto until = Deadline::in(400ms); !until.passed();)
    if (const auto captured = capture(20ms); !captured) error = captured.error().what;
  EXPECT_THAT(error, HasSubstr("opened again as soon as it answers"));
  plug_in();
  const std::int64_t back_ns = now_ns();
  capture_again(10s);
  std::printf("  an image %.0f ms after the return\n", ns_to_ms(now_ns() - back_ns));
  EXPECT_GT(frame().header.frame_id, before.frame_id);
  EXPECT_GT(frame().header.origin_ns, before.origin_ns);
  EXPECT_TRUE(capture());
}

TEST_F(AravisCamera, AnAbsentCameraDoesNotHoldUpTheEndOfTheProcess) {
  plug_in();
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  fake_.reset();
  std::this_thread::sleep_for(150ms);
  std::atomic<bool> done = false;
  std::jthread end([&] {
    camera_.reset();
    done = true;
  });
  for (const auto until = Deadline::in(2s); !done && !until.passed();)
    std::this_thread::sleep_for(5ms);
  EXPECT_TRUE(done);
}

TEST_F(AravisCamera, ASoftwareTriggerComesAtTheRateOfTheSettings) {
  plug_in();
  rig_.camera.aravis.trigger = config::Trigger::software;
  rig_.camera.rate_hz = 50;
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const std::int64_t first_ns = frame().header.origin_ns;
  const auto first = frame().header.frame_id;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(capture());
  const auto period_ns = (frame().header.origin_ns - first_ns) /
                         static_cast<std::int64_t>(frame().header.frame_id - first);
  EXPECT_GE(period_ns, 18'000'000);
}

TEST_F(AravisCamera, ACameraThatAnotherProgramControlsIsNotTaken) {
  plug_in();
  ASSERT_TRUE(open());
  const auto second = open_camera(rig_, calibration_, now_ns());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::unavailable);
  EXPECT_THAT(second.error().what, HasSubstr("another program"));
  EXPECT_TRUE(capture()) << "the first program goes on";
}

TEST_F(AravisCamera, WithoutACameraTheSentenceSaysSo) {
  rig_.camera.aravis.device = "";
  const auto opened = open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::unavailable);
  EXPECT_THAT(opened.error().what, HasSubstr("no GigE Vision or USB3 Vision camera"));
}

TEST_F(AravisCamera, AnUnknownNameIsAnsweredWithTheCamerasThatAreThere) {
  plug_in();
  rig_.camera.aravis.device = "Basler-1";
  const auto opened = open();
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().what,
              AllOf(HasSubstr("no camera 'Basler-1'"), HasSubstr("GV01"), HasSubstr("127.0.0.1")));
}

TEST_F(AravisCamera, ACameraIsFoundByItsSerialNumberOrWhenItIsTheOnlyOne) {
  plug_in();
  for (const auto* name : {"GV01", ""}) {
    rig_.camera.aravis.device = name;
    const auto opened = open();
    ASSERT_TRUE(opened) << opened.error().what;
    EXPECT_TRUE(capture());
  }
}

}  // namespace
}  // namespace handcast::camera
