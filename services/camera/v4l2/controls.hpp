// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "services/camera/v4l2/control.hpp"
#include "services/camera/v4l2/device.hpp"

namespace handcast::camera::v4l2 {

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
