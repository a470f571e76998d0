// SPDX-License-Identifier: Apache-2.0
// Corners that are dragged with the mouse, on a real X server.
#include <gtest/gtest.h>

#include "ipc/base/clock.hpp"
#include "services/tools/calibrate/by_hand.hpp"
#include "tests/display_server.hpp"
#include "tests/renderer/window/screen_reader.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

TEST(DragWindow, ACornerThatIsDraggedInTheWindowMovesInTheProjectorsImage) {
  const test::DisplayServer server;
  if (!server) GTEST_SKIP() << test::DisplayServer::why();
  const auto draft = calib::reference_rig();
  const int width_px = draft.projector.width_px, height_px = draft.projector.height_px;
  const auto window = open_drag_window(width_px, height_px, nullptr);
  ASSERT_TRUE(window) << window.error().what;
  const std::vector<std::uint8_t> levels(
      static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 100);
  for (const auto limit = Deadline::in(5s); !test::shows_a_window() && !limit.passed();)
    ASSERT_TRUE((*window)->show(levels));

  DraggedCorners corners(draft);
  const auto before = corners.corners_px()[1];
  // The window has half of the projector's size.
  const glm::ivec2 from(before / 2.0), to = from + glm::ivec2(-20, 15);
  test::drag_in_window(from.x, from.y, to.x, to.y);
  int released = 0;
  for (const auto limit = Deadline::in(5s); released == 0 && !limit.passed();) {
    ASSERT_TRUE((*window)->show(levels));
    for (const auto& grip : (*window)->take_grips()) {
      if (grip.kind == Grip::Kind::press) corners.grab(grip.px);
      if (grip.kind == Grip::Kind::move) corners.drag_to(grip.px);
      released += grip.kind == Grip::Kind::release;
    }
  }
  EXPECT_EQ(released, 1);
  EXPECT_LT(glm::distance(corners.corners_px()[1], before + glm::dvec2(-40, 30)), 1e-6);
}

TEST(DragWindow, WithoutADisplayItSaysSo) {
  ::unsetenv("DISPLAY");
  const auto window = open_drag_window(64, 48, nullptr);
  ASSERT_FALSE(window);
  EXPECT_EQ(window.error().code, Errc::unavailable);
}

}  // namespace
}  // namespace handcast::calibrate
