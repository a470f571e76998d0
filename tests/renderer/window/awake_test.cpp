// SPDX-License-Identifier: Apache-2.0
// Whether the X server blanks the screen while light comes from a window.
#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "renderer/window/window.hpp"
#include "tests/display_server.hpp"
// clang-format off
#include <X11/extensions/scrnsaver.h>  // last: it defines None
// clang-format on

namespace handcast::renderer {
namespace {

class AwakeTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!server_) GTEST_SKIP() << test::DisplayServer::why();
    display_ = XOpenDisplay(nullptr);
    ASSERT_NE(display_, nullptr);
    XSetScreenSaver(display_, 1, 0, DontPreferBlanking, AllowExposures);
    XFlush(display_);
  }
  void TearDown() override {
    if (display_ != nullptr) XCloseDisplay(display_);
  }
  bool is_blanked() const {
    XScreenSaverInfo info{};
    XScreenSaverQueryInfo(display_, DefaultRootWindow(display_), &info);
    return info.state == ScreenSaverOn;
  }
  bool becomes_blanked() const {
    for (const auto limit = Deadline::in(std::chrono::seconds(20)); !limit.passed(); usleep(50'000))
      if (is_blanked()) return true;
    return false;
  }

  test::DisplayServer server_;
  Display* display_ = nullptr;
};

TEST_F(AwakeTest, TheScreenIsNotBlankedWhileThereIsLightAndIsAfterwards) {
  if (!becomes_blanked()) GTEST_SKIP() << "this X server does not blank its screen";
  {
    const auto window = Window::open({.title = "light", .keeps_awake = true, .vsync = false});
    ASSERT_TRUE(window) << window.error().what;
    EXPECT_FALSE(is_blanked()) << "it is woken";
    usleep(3'000'000);
    EXPECT_FALSE(is_blanked());
  }
  EXPECT_TRUE(becomes_blanked());
}

}  // namespace
}  // namespace handcast::renderer
