// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::camera::v4l2 {

/// The kinds of controls whose values a rig file can set.
enum class ControlKind {
  number,   ///< also a set of bits
  boolean,  ///< 0 or 1
  menu,     ///< one of Control::menu
  button,   ///< it has no value; setting it does something
  other,    ///< a text or a table: cannot be set from a rig file
};

/// An entry of a menu.
struct MenuItem {
  std::int64_t index = 0;
  std::string text;
};

/// A control of a camera: gain, white balance, ...
struct Control {
  std::uint32_t id = 0;
  ControlKind kind = ControlKind::number;
  std::string title;  ///< the driver's name for it, e.g. "Power Line Frequency"
  std::string name;   ///< kernel_name(title), e.g. "power_line_frequency"
  std::int64_t least = 0, most = 0, step = 1;
  std::vector<MenuItem> menu;
  bool is_read_only = false;
  bool is_inactive = false;  ///< another control decides, such as an automatic one
  bool is_grabbed = false;   ///< locked while the device streams
};

/// A title as v4l2-ctl writes it: lower case, with underscores for all that is no letter or digit.
std::string kernel_name(std::string_view title);

/// The values that a control accepts, e.g. "0 to 255" or "0 (Disabled), 1 (50 Hz)".
std::string range_of(const Control& control);

/// The value that `text` means for a control. A number is rounded to the control's step; an entry
/// of a menu is an index or a text (as in the menu, or in the manner of kernel_name()); a boolean
/// is 0, 1, false or true; a button takes anything. Errors: bad_config, with the control's range.
Result<std::int64_t> value_for(const Control& control, std::string_view text);

/// `value` as near as the step of the control allows; it must lie in the range.
std::int64_t on_step(const Control& control, std::int64_t value);

}  // namespace handcast::camera::v4l2
