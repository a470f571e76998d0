// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

/// What a person or another program would see and do at the X server of $DISPLAY.
namespace handcast::test {

/// The colour of a pixel of the screen, RGBA8 with red in the lowest byte.
std::uint32_t pixel(int x, int y);
/// Number of pixels that are not black in a rectangle of the screen.
int lit_pixels(int left, int top, int width, int height);
/// True if a window is shown, wherever it is.
bool shows_a_window();
/// Resizes, or hides, all windows that are shown.
/// @{
void resize_windows(int width, int height);
void hide_windows();
/// @}
/// True if a window with this title is shown.
bool shows_a_window(std::string_view title);
/// Presses the left button at one place of the shown window and releases it at another; px of the
/// window. `title`: of the window that is meant, if there are several.
void drag_in_window(int from_x, int from_y, int to_x, int to_y, std::string_view title = {});
/// Fills what no window covers. `rgb`: 0xRRGGBB.
void paint_the_desktop(unsigned long rgb);
/// Gives an output an EDID with this name.
void set_edid_name(std::string_view output, std::string_view name);

}  // namespace handcast::test
