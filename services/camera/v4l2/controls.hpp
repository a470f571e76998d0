// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/camera/v4l2/device.hpp"

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

/// The controls of a device, as they are now: setting one may make others inactive.
std::vector<Control> controls_of(int fd);

/// The control with an id of the kernel; empty if the device has none.
std::optional<Control> find_control(int fd, std::uint32_t id);

/// Writes a value, which must be in the control's range. What the device holds then; `value` if the
/// control cannot be read. Errors: bad_config (read-only, inactive, locked, refused by the driver),
/// disconnected, unavailable (in use).
Result<std::int64_t> write_control(const Device& device, const Control& control,
                                   std::int64_t value);
/// The value of a control; empty if it cannot be read.
std::optional<std::int64_t> read_control(int fd, const Control& control);

/// Sets controls in their order, e.g. "gain=20" or "power_line_frequency=50 Hz". Reports values
/// that the device changed. Errors: bad_config (no such control: with those that the device has;
/// those of value_for()), and those of write_control().
Result<void> set_controls(const Device& device, const std::vector<std::string>& assignments);

}  // namespace handcast::camera::v4l2
