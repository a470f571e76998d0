// SPDX-License-Identifier: Apache-2.0
// A projector that is aligned by hand, in a whole rig whose camera does not see its light: with the
// mouse in the window on the operator's monitor, and with the keys of the terminal.
#include <gmock/gmock.h>

#include <array>
#include <filesystem>

#include "calib/calibration.hpp"
#include "tests/display_server.hpp"
#include "tests/renderer/window/screen_reader.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/terminal.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kWindow = "handcast: drag the corners";

class AlignByHand : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    if (!server_) GTEST_SKIP() << test::DisplayServer::why();
    test::paint_the_desktop(0);
    fs::copy_file("config/rigs/twin.toml", scratch_.path() / "twin.toml");
  }
  /// The corners that are dragged, clockwise from the top left: camera px.
  std::array<glm::dvec2, 4> corners_px() const {
    const double right = truth_.camera.width_px - 1, down = truth_.camera.height_px - 1;
    return {{{0.1 * right, 0.1 * down},
             {0.9 * right, 0.1 * down},
             {0.9 * right, 0.9 * down},
             {0.1 * right, 0.9 * down}}};
  }

  test::DisplayServer server_;
  calib::Calibration truth_ = calib::reference_rig();
};

TEST_F(AlignByHand, MouseAndArrowKeysMoveTheCornersOfTheHomographyThatIsWritten) {
  Terminal terminal(scratch_.path(), {"calibrate", scratch_.path() / "twin.toml", "screen", "--set",
                                      "twin.image.leak=0", "--set", "projector.backend=window",
                                      "--set", "observer.enabled=false", "--set",
                                      "camera.rate_hz=15", "--set", "landmarks.backend=twin"});
  ASSERT_TRUE(terminal.says("Enter begins")) << terminal.said();
  terminal.press("\n");
  ASSERT_TRUE(terminal.says("drag its corners")) << terminal.said();
  ASSERT_TRUE(eventually([] { return test::shows_a_window(kWindow); })) << terminal.said();
  // The crosses at the four corners are at most 516 px; the others are of the camera's image.
  EXPECT_TRUE(eventually([] { return test::lit_pixels(1024, 0, 800, 600) > 1000; }))
      << "the projector shows more than the crosses";
  ASSERT_TRUE(eventually([] { return test::lit_pixels(0, 0, 1024, 768) > 0; }))
      << "the window is drawn, so the mouse is listened to";

  // The window has half of the projector's size.
  const auto top_right = truth_.projector.pixel_of(corners_px()[1]);
  const glm::ivec2 from(top_right / 2.0), to = from + glm::ivec2(-20, 15);
  test::drag_in_window(from.x, from.y, to.x, to.y, kWindow);
  ASSERT_TRUE(terminal.says("corner 2 (top right)")) << terminal.said();
  terminal.press("3\x1b[C\x1b[C\x1b[A");
  ASSERT_TRUE(terminal.says("corner 3 (bottom right)")) << terminal.said();
  terminal.press("\n");
  ASSERT_EQ(terminal.wait(), 0) << terminal.said();

  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_THAT(found->made.screen, HasSubstr("aligned by hand"));
  const std::array<glm::dvec2, 4> moved_px{{{0, 0}, {-40, 30}, {10, -5}, {0, 0}}};
  for (std::size_t i = 0; i < moved_px.size(); ++i) {
    const auto px = corners_px()[i];
    const auto off = found->projector.pixel_of(px) - truth_.projector.pixel_of(px) - moved_px[i];
    EXPECT_LT(glm::length(off), 1e-3) << "corner " << i + 1;
  }
}

}  // namespace
}  // namespace handcast::system_test
