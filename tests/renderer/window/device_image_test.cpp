// SPDX-License-Identifier: Apache-2.0
// A painter whose images the window shows without a copy in memory.
#include <gtest/gtest.h>

#include "ipc/base/clock.hpp"
#include "renderer/draw/gl/gl_painter.hpp"
#include "renderer/window/window.hpp"
#include "tests/display_server.hpp"
#include "tests/renderer/draw/painter_scene.hpp"
#include "tests/renderer/window/screen_reader.hpp"

namespace handcast::renderer {
namespace {

using namespace std::chrono_literals;

constexpr int kWidth = 800, kHeight = 600;
constexpr int kLeft = 1024;  ///< of DUMMY1
constexpr Rect kRegion{100, 50, 300, 150};

class DeviceImageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!server_) GTEST_SKIP() << handcast::test::DisplayServer::why();
    auto window = Window::open({.title = "light",
                                .width_px = kWidth,
                                .height_px = kHeight,
                                .full_screen = true,
                                .vsync = false});
    ASSERT_TRUE(window) << window.error().what;
    window_ = std::move(*window);
    if (!window_->share_group()) GTEST_SKIP() << "the X server has no EGL";
    auto painter = open_gl_painter(kWidth, kHeight, {.shares = window_->share_group()});
    if (!painter) GTEST_SKIP() << painter.error().what;
    painter_ = std::move(*painter);
  }
  /// Draws a rectangle with a picture in the region.
  void draw() {
    test::Shape shape;
    shape.rectangle({kRegion.x0, kRegion.y0}, {kRegion.x1, kRegion.y1});
    const auto hand = shape.drawn();
    painter_->draw({&hand, 1}, kRegion);
  }
  /// Shows the painter's image until the middle of the region is lit.
  void show(const LightTable& table) const {
    for (const auto limit = Deadline::in(5s); !limit.passed();) {
      const auto image = painter_->device_image();
      ASSERT_TRUE(image);
      ASSERT_TRUE(window_->show(*image, kRegion, table));
      if (handcast::test::lit_pixels(kLeft + 190, 90, 20, 20) == 400) return;
    }
    FAIL() << "nothing was seen on the screen";
  }
  static LightTable table(double gamma) {
    config::Projector settings;
    settings.gamma = gamma;
    return light_table(settings);
  }

  handcast::test::IgnoreLeaks ignore_leaks_;
  handcast::test::DisplayServer server_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<GlPainter> painter_;  ///< ends before the window, as in the projector
};

TEST_F(DeviceImageTest, IsShownAsWriteLightWouldWriteIt) {
  for (const double gamma : {0., 1.8}) {
    draw();
    show(table(gamma));
    Texture expected(kWidth, kHeight, 0xff000000u);
    write_light(painter_->colour(), kRegion, table(gamma), expected.view());
    for (const auto& [x, y] :
         {std::pair{100, 50}, {299, 149}, {150, 70}, {280, 51}, {99, 50}, {300, 149}, {150, 200}})
      EXPECT_EQ(handcast::test::pixel(kLeft + x, y), expected.at(x, y))
          << x << ' ' << y << ", " << gamma;
  }
}

TEST_F(DeviceImageTest, PicturesFromMemoryAndFromTheGpuFollowEachOther) {
  draw();
  show(table(0));
  Texture red(kWidth, kHeight, 0xff0000ffu);
  for (const auto limit = Deadline::in(5s); !limit.passed();) {
    ASSERT_TRUE(window_->show(red.view(), kRegion));
    if (handcast::test::pixel(kLeft + 150, 70) == 0xff0000ffu) break;
  }
  EXPECT_EQ(handcast::test::pixel(kLeft + 150, 70), 0xff0000ffu);
  show(table(0));
  EXPECT_NE(handcast::test::pixel(kLeft + 150, 70), 0xff0000ffu);
}

TEST_F(DeviceImageTest, IsDarkWithoutARegion) {
  draw();
  show(table(0));
  for (int frame = 0; frame < 5; ++frame)  // there are several buffers
    ASSERT_TRUE(window_->show(*painter_->device_image(), {}, table(0)));
  EXPECT_EQ(handcast::test::lit_pixels(kLeft, 0, kWidth, kHeight), 0);
}

}  // namespace
}  // namespace handcast::renderer
