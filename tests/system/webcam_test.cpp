// SPDX-License-Identifier: Apache-2.0
// A rig whose camera is a webcam. Its camera service sees an emulated one.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class RigWithAWebcam : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
#ifdef HANDCAST_WITH_SANITIZER
    GTEST_SKIP() << "a sanitizer must be loaded before the emulated webcam";
#endif
  }
  std::string plug() const { return scratch_.path() / "plugged_in"; }
  void plug_in() const { std::ofstream(plug()) << "1"; }
  void unplug() const { std::filesystem::remove(plug()); }
  std::unique_ptr<Command> up_with(Arguments more) const {
    const Variable preload("LD_PRELOAD", HANDCAST_EMULATED_WEBCAM_LIBRARY),
        webcam("HANDCAST_EMULATED_WEBCAM", plug());
    more.insert(more.end(), {"--set", "camera.rate_hz=100"});
    return up(more);
  }
  std::unique_ptr<Command> up_with_webcam() const {
    return up_with({"--set", "camera.backend=v4l2"});
  }
  /// A calibration of the reference rig, made with this camera.
  std::string calibration_of(const std::string& camera) const {
    auto calibration = calib::reference_rig();
    calibration.camera_device = camera;
    const std::string file = scratch_.path() / "calibration.toml";
    std::ofstream(file) << calib::print_calibration(calibration);
    return file;
  }
  static bool has(const Command& rig, const std::string& text) {
    return rig.log().find(text) != std::string::npos;
  }
  bool camera_is_ready() const { return service("camera")["state"] == "ready"; }
};

TEST_F(RigWithAWebcam, LosesItAndHasItBackWithoutAnyHelp) {
  plug_in();
  const auto rig = up_with_webcam();
  wait_until_light();
  EXPECT_THAT(rig->log(), HasSubstr("sends GREY 720x540 at 100 Hz"));
  const int before = service("camera")["pid"];
  unplug();
  EXPECT_TRUE(
      eventually([&] { return has(*rig, "(/dev/video0, usb-0000:00:14.0-1) was unplugged"); }));
  EXPECT_TRUE(eventually([&] { return has(*rig, "no camera is attached"); }));
  expect_more_light();
  const std::int64_t back_ns = now_ns();
  plug_in();
  EXPECT_TRUE(eventually([&] { return camera_is_ready() && service("camera")["pid"] != before; }));
  RecordProperty("back_ms", static_cast<int>(ns_to_ms(now_ns() - back_ns)));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithAWebcam, WaitsForOneThatIsPluggedInLater) {
  const auto rig = up_with_webcam();
  EXPECT_TRUE(eventually([&] { return has(*rig, "camera 'v4l2': no camera is attached"); }));
  plug_in();
  EXPECT_TRUE(eventually([&] { return camera_is_ready(); }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

/// When the images and the light of a new camera came, which has another exposure time.
struct Change {
  std::int64_t longest_dark_ns = 0;          ///< between two frames of light
  std::optional<std::int64_t> first_origin;  ///< of the first new image
  std::int64_t ready_ns = 0;                 ///< when it was published
  std::optional<std::int64_t> used_ns;       ///< when light that was made from it was published
};

Change watch_change(std::int64_t old_exposure_ns, const std::function<bool()>& is_over) {
  using namespace std::chrono_literals;
  auto frames = client::open_stream<msg::CameraFrame>("twin", "camera.frames");
  auto lights = client::open_stream<msg::Projection>("twin", "projection.frames");
  Change change;
  if (!frames || !lights) return change;
  std::int64_t last_ns = now_ns();
  while (!is_over()) {
    while (const auto frame = frames->next(Deadline::now()))
      if (!change.first_origin && (*frame)->exposure_ns != old_exposure_ns) {
        change.first_origin = (*frame)->header.origin_ns;
        change.ready_ns = (*frame)->header.published_ns;
      }
    const auto light = lights->next(Deadline::in(5ms));
    if (!light) continue;
    const auto at_ns = (*light)->header.published_ns;
    change.longest_dark_ns = std::max(change.longest_dark_ns, at_ns - last_ns);
    last_ns = at_ns;
    if (!change.used_ns && change.first_origin &&
        (*light)->made_from.image_ns >= *change.first_origin)
      change.used_ns = at_ns;
  }
  return change;
}

TEST_F(RigWithAWebcam, ItReplacesTheTwinsCameraWhileTheLightGoesOn) {
  plug_in();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  const auto rig = up_with({"--set", "camera.exposure_ms=2.25"});
  wait_until_light();
  auto swapping = std::async(std::launch::async, [&] {
    return handcast({"swap", "camera", "v4l2"});
  });
  const auto until_ns = now_ns() + 10'000'000'000;
  const auto change = watch_change(2'250'000, [&, used = 0]() mutable {
    const bool is_done = swapping.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return (is_done && ++used > 200) || now_ns() > until_ns;
  });
  const auto swapped = swapping.get();
  EXPECT_EQ(swapped.exit_code, 0) << swapped.log;
  ASSERT_TRUE(change.first_origin) << "no image of the webcam came";
  ASSERT_TRUE(change.used_ns) << "no light was made from it";
  EXPECT_LT(*change.used_ns - change.ready_ns, 1'000'000'000);
  std::printf(
      "webcam instead of the twin: in use %.0f ms after its first image; light paused %.0f ms\n",
      ns_to_ms(*change.used_ns - change.ready_ns), ns_to_ms(change.longest_dark_ns));
  EXPECT_EQ(service("camera")["backend"], "v4l2");
}

TEST_F(RigWithAWebcam, ACameraThatWasNotCalibratedIsRefusedAndTheOldOneGoesOn) {
  plug_in();
  const auto rig = up_with({"--set", "calibration=" + calibration_of("Another Webcam")});
  wait_until_light();
  const auto swapped = handcast({"swap", "camera", "v4l2"});
  EXPECT_EQ(swapped.exit_code, 100);
  EXPECT_THAT(swapped.log, HasSubstr("made with the camera 'Another Webcam', and this is "
                                     "'Emulated Webcam'"));
  EXPECT_EQ(service("camera")["backend"], "twin");
  expect_more_light();
  ASSERT_TRUE(std::filesystem::exists(calibration_of("Emulated Webcam")));
  const auto reloaded = handcast({"reload"});
  EXPECT_EQ(reloaded.exit_code, 0) << reloaded.log;
  EXPECT_EQ(handcast({"swap", "camera", "v4l2"}).exit_code, 0);
  expect_more_light();
  EXPECT_EQ(service("camera")["backend"], "v4l2");
}

}  // namespace
}  // namespace handcast::system_test
