// SPDX-License-Identifier: Apache-2.0
// A rig whose camera is a webcam. Its camera service sees an emulated one.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "ipc/base/clock.hpp"
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
  std::unique_ptr<Command> up_with_webcam() const {
    const Variable preload("LD_PRELOAD", HANDCAST_EMULATED_WEBCAM_LIBRARY),
        webcam("HANDCAST_EMULATED_WEBCAM", plug());
    return up({"--set", "camera.backend=v4l2", "--set", "camera.rate_hz=100"});
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

}  // namespace
}  // namespace handcast::system_test
