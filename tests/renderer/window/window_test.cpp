// SPDX-License-Identifier: Apache-2.0
// The window on a real X server, whose monitors are simulated.
#include "renderer/window/window.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "ipc/base/clock.hpp"
#include "tests/display_server.hpp"
#include "tests/renderer/window/screen_reader.hpp"

namespace handcast::renderer {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kRed = 0xff0000ff, kBlack = 0xff000000;
constexpr int kLeft = 1024;  ///< of DUMMY1

/// A picture of 800 x 600 that is red in its region.
struct RedSquare {
  RedSquare() {
    for (int y = region.y0; y < region.y1; ++y)
      std::fill_n(pixels.row(y) + region.x0, region.width(), kRed);
  }
  Rect region{100, 50, 200, 150};
  Image<std::uint32_t> pixels{800, 600, 0xffffffff};
};

class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!server_) GTEST_SKIP() << test::DisplayServer::why();
  }
  static WindowSettings full_screen() {
    return {
        .title = "light", .width_px = 800, .height_px = 600, .full_screen = true, .vsync = false};
  }
  /// Shows the red square until it is seen.
  bool shows_red_at(Window& window, int x, int y) const {
    for (const auto limit = Deadline::in(5s); !limit.passed();) {
      (void)window.show(square_.pixels.view(), square_.region);
      if (test::pixel(x, y) == kRed) return true;
    }
    return false;
  }

  test::DisplayServer server_;
  RedSquare square_;
};

TEST_F(WindowTest, CoversTheMonitorThatIsNotTheOperatorsOwn) {
  test::paint_the_desktop(0x00ff00);
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  ASSERT_TRUE(shows_red_at(**window, kLeft + 150, 100));
  EXPECT_EQ(test::pixel(kLeft + 100, 50), kRed) << "the first pixel of the region";
  EXPECT_EQ(test::pixel(kLeft + 199, 149), kRed) << "the last one";
  EXPECT_EQ(test::pixel(kLeft + 99, 50), kBlack);
  EXPECT_EQ(test::pixel(kLeft + 200, 149), kBlack);
  EXPECT_EQ(test::pixel(kLeft + 799, 599), kBlack);
  EXPECT_EQ(test::pixel(500, 100), 0xff00ff00) << "the operator's monitor is left alone";
  EXPECT_TRUE(test::shows_a_window());
}

TEST_F(WindowTest, IsBlackWhereAnOlderPictureWasLit) {
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  ASSERT_TRUE(shows_red_at(**window, kLeft + 150, 100));
  RedSquare lower;
  lower.region = {100, 400, 200, 500};
  for (int frame = 0; frame < 3; ++frame)  // there are several buffers
    ASSERT_TRUE((*window)->show(lower.pixels.view(), lower.region));
  EXPECT_EQ(test::pixel(kLeft + 150, 450), 0xffffffff);
  EXPECT_EQ(test::pixel(kLeft + 150, 100), kBlack);
}

TEST_F(WindowTest, TheMouseIsReportedWhileItsButtonIsPressed) {
  auto window = Window::open({.title = "drag", .width_px = 400, .height_px = 300, .vsync = false});
  ASSERT_TRUE(window) << window.error().what;
  for (const auto limit = Deadline::in(5s); !test::shows_a_window() && !limit.passed();)
    (void)(*window)->show(square_.pixels.view(), square_.region);
  test::drag_in_window(30, 40, 130, 90);
  std::vector<PointerEvent> events;
  for (const auto limit = Deadline::in(5s); events.size() < 3 && !limit.passed();) {
    (void)(*window)->show(square_.pixels.view(), square_.region);
    for (const auto& event : (*window)->take_pointer()) events.push_back(event);
  }
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].kind, PointerEvent::Kind::press);
  EXPECT_EQ(events[0].x_px, 30);
  EXPECT_EQ(events[0].y_px, 40);
  EXPECT_EQ(events[1].kind, PointerEvent::Kind::move);
  EXPECT_EQ(events[1].x_px, 130);
  EXPECT_EQ(events[2].kind, PointerEvent::Kind::release);
  EXPECT_EQ(events[2].y_px, 90);
}

TEST_F(WindowTest, IsHiddenUntilItsFirstPicture) {
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  std::this_thread::sleep_for(200ms);
  EXPECT_FALSE(test::shows_a_window());
}

TEST_F(WindowTest, ComesBackToAMonitorThatWasUnplugged) {
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  ASSERT_TRUE(shows_red_at(**window, kLeft + 150, 100));
  ASSERT_TRUE(server_.unplug());
  auto lost = (*window)->show(square_.pixels.view(), square_.region);
  for (const auto limit = Deadline::in(5s); lost && !limit.passed();)
    lost = (*window)->show(square_.pixels.view(), square_.region);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, Errc::timeout);
  EXPECT_THAT(lost.error().what, HasSubstr("'DUMMY1' is unplugged"));
  for (int frame = 0; frame < 10; ++frame) {
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE((*window)->show(square_.pixels.view(), square_.region));
  }
  EXPECT_FALSE(test::shows_a_window()) << "it does not move to the operator's monitor";

  ASSERT_TRUE(server_.plug_in());
  EXPECT_TRUE(shows_red_at(**window, kLeft + 150, 100));
}

TEST_F(WindowTest, CoversItsMonitorAgainAfterAnotherProgramResizedIt) {
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  ASSERT_TRUE(shows_red_at(**window, kLeft + 150, 100));
  test::resize_windows(80, 60);
  EXPECT_TRUE(shows_red_at(**window, kLeft + 150, 100));
}

TEST_F(WindowTest, ComesBackAfterAnotherProgramHidIt) {
  auto window = Window::open(full_screen());
  ASSERT_TRUE(window) << window.error().what;
  ASSERT_TRUE(shows_red_at(**window, kLeft + 150, 100));
  test::paint_the_desktop(0x00ff00);
  test::hide_windows();
  EXPECT_TRUE(shows_red_at(**window, kLeft + 150, 100));
}

TEST_F(WindowTest, FindsAMonitorByTheModelInItsEdid) {
  test::set_edid_name("DUMMY1", "EPSON PJ");
  auto settings = full_screen();
  settings.monitor = "EPSON PJ";
  auto window = Window::open(settings);
  ASSERT_TRUE(window) << window.error().what;
  EXPECT_TRUE(shows_red_at(**window, kLeft + 150, 100));
}

TEST_F(WindowTest, AMonitorThatIsNotThereIsNamedWithThoseThatAre) {
  auto settings = full_screen();
  settings.monitor = "HDMI-9";
  const auto refused = Window::open(settings);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, HasSubstr("no monitor 'HDMI-9'"));
  EXPECT_THAT(refused.error().what, HasSubstr("1: 'DUMMY1' (800x600"));
}

TEST_F(WindowTest, AmongOtherWindowsHasTheSizeOfItsPicture) {
  auto window = Window::open({.title = "a look", .width_px = 320, .height_px = 240});
  ASSERT_TRUE(window) << window.error().what;
  EXPECT_EQ((*window)->width_px(), 320);
  EXPECT_EQ((*window)->height_px(), 240);
  EXPECT_TRUE((*window)->show(square_.pixels.view(), square_.region)) << "it is scaled";
  EXPECT_FALSE((*window)->is_closed());
}

TEST_F(WindowTest, ADeadServerEndsTheProcessInAStatedWay) {
  testing::GTEST_FLAG(death_test_style) = "fast";
  EXPECT_EXIT(
      {
        auto settings = full_screen();
        settings.when_display_is_lost = [] { std::_Exit(42); };
        auto window = Window::open(settings);
        server_.end();
        for (const auto limit = Deadline::in(5s); window && !limit.passed();)
          (void)(*window)->show(square_.pixels.view(), square_.region);
        std::_Exit(1);
      },
      testing::ExitedWithCode(42), "");
}

TEST(AWindow, WithoutADisplaySaysSo) {
  ::unsetenv("DISPLAY");
  const auto refused = Window::open({});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, HasSubstr("DISPLAY"));
}

}  // namespace
}  // namespace handcast::renderer
