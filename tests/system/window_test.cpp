// SPDX-License-Identifier: Apache-2.0
// A rig whose light is a window, while its display server and its monitor come and go.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "ipc/base/clock.hpp"
#include "tests/display_server.hpp"
#include "tests/renderer/window/screen_reader.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class LightInAWindow : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    if (!server_) GTEST_SKIP() << test::DisplayServer::why();
    test::paint_the_desktop(0);
  }
  /// Lit pixels of the monitor DUMMY1.
  static bool is_lit() { return test::lit_pixels(1024, 0, 800, 600) > 1000; }

  test::DisplayServer server_;
};

TEST_F(LightInAWindow, ComesBackWithTheDisplayServer) {
  const auto rig = up({"--set", "projector.backend=window"});
  wait_until_light();
  ASSERT_TRUE(eventually(is_lit));
  const auto camera = service("camera")["pid"];
  server_.end();
  ASSERT_TRUE(eventually([&] { return service("projector")["restarts"] > 0; }));
  ASSERT_TRUE(server_.start());
  EXPECT_TRUE(eventually(is_lit));
  EXPECT_EQ(service("camera")["pid"], camera);
  EXPECT_THAT(rig->log(), HasSubstr("the connection to the display server is lost"));
}

TEST_F(LightInAWindow, ComesBackToItsMonitor) {
  const auto rig = up({"--set", "projector.backend=window"});
  wait_until_light();
  ASSERT_TRUE(eventually(is_lit));
  const auto projector = service("projector")["pid"];
  ASSERT_TRUE(server_.unplug());
  ASSERT_TRUE(eventually(
      [&] { return rig->log().find("monitor 'DUMMY1' is unplugged") != std::string::npos; }));
  EXPECT_EQ(test::lit_pixels(0, 0, 1024, 768), 0) << "nothing is shown on the other monitor";
  ASSERT_TRUE(server_.plug_in());
  EXPECT_TRUE(eventually(is_lit));
  EXPECT_EQ(service("projector")["pid"], projector);
}

#ifdef HANDCAST_WITH_GL
TEST_F(LightInAWindow, IsDrawnByTheGpuOfTheWindow) {
  const auto rig = up({"--set", "projector.backend=window", "--set", "projector.painter=gl"});
  wait_until_light();
  ASSERT_TRUE(eventually(is_lit));
  EXPECT_THAT(rig->log(), HasSubstr("(EGL the window's)"));
  server_.end();
  ASSERT_TRUE(eventually([&] { return service("projector")["restarts"] > 0; }));
  ASSERT_TRUE(server_.start());
  EXPECT_TRUE(eventually(is_lit));
  EXPECT_EQ(rig->log().find("drawing with cpu"), std::string::npos) << rig->log();
}
#endif

/// HANDCAST_WINDOW_MINUTES=10 sets how long (without ctest, which ends it after five minutes).
/// Every two seconds the window is resized or hidden, or its monitor unplugged; each tenth time the
/// server dies.
TEST_F(LightInAWindow, LivesThroughMinutesOfDisturbance) {
  const char* text = std::getenv("HANDCAST_WINDOW_MINUTES");
  const auto minutes = std::chrono::duration<double, std::ratio<60>>(text ? std::atof(text) : 0.1);
  const auto rig = up({"--set", "projector.backend=window"});
  wait_until_light();
  ASSERT_TRUE(eventually(is_lit));
  const auto camera = service("camera")["pid"];
  int deaths = 0, disturbances = 0;
  const auto limit = Deadline::in(std::chrono::duration_cast<std::chrono::nanoseconds>(minutes));
  while (!limit.passed()) {
    switch (++disturbances % 10) {
      case 0: {
        const auto restarts = service("projector")["restarts"];
        server_.end();
        ASSERT_TRUE(eventually([&] { return service("projector")["restarts"] > restarts; }));
        ASSERT_TRUE(server_.start());
        ++deaths;
        break;
      }
      case 3:
      case 7:
        ASSERT_TRUE(server_.unplug());
        ASSERT_TRUE(server_.plug_in());
        break;
      case 1:
      case 5:
      case 9:
        test::hide_windows();
        break;
      default:
        test::resize_windows(40 * (disturbances % 10), 300);
    }
    ASSERT_TRUE(eventually(is_lit)) << "after disturbance " << disturbances;
    sleep_until_ns(now_ns() + seconds_to_ns(2));
    ASSERT_TRUE(eventually(is_lit)) << "two seconds after disturbance " << disturbances;
  }
  EXPECT_EQ(service("camera")["pid"], camera);
  std::cout << disturbances << " disturbances, " << deaths << " deaths of the server, "
            << service("projector")["restarts"] << " restarts of the projector, " << light()
            << " frames\n";
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(LightInAWindow, IsGoneAfterDown) {
  const auto rig = up({"--set", "projector.backend=window"});
  wait_until_light();
  ASSERT_TRUE(eventually(is_lit));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_TRUE(eventually([] { return test::lit_pixels(0, 0, 1824, 600) == 0; }));
}

}  // namespace
}  // namespace handcast::system_test
