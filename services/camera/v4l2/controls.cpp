// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/controls.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <charconv>

#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::camera::v4l2 {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::optional<std::int64_t> number_in(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<std::int64_t> entry_for(const Control& control, std::string_view text) {
  const auto number = number_in(text);
  for (const auto& item : control.menu)
    if (item.index == number || item.text == text) return item.index;
  for (const auto& item : control.menu)
    if (!kernel_name(text).empty() && kernel_name(item.text) == kernel_name(text))
      return item.index;
  return std::nullopt;
}

std::optional<std::int64_t> meant_by(const Control& control, std::string_view text) {
  switch (control.kind) {
    case ControlKind::menu:
      return entry_for(control, text);
    case ControlKind::button:
      return 0;
    case ControlKind::boolean:
      if (text == "true") return 1;
      if (text == "false") return 0;
      break;
    default:
      break;
  }
  const auto number = number_in(text);
  if (!number || *number < control.least || *number > control.most) return std::nullopt;
  return on_step(control, *number);
}

}  // namespace

std::string kernel_name(std::string_view title) {
  std::string name;
  bool is_apart = false;
  for (const char c : title) {
    if (is_plain(c)) {
      if (is_apart && !name.empty()) name += '_';
      name += lower(c);
    }
    is_apart = !is_plain(c);
  }
  return name;
}

std::string range_of(const Control& control) {
  if (control.kind == ControlKind::button) return "any value";
  if (control.kind == ControlKind::menu) {
    std::vector<std::string> entries;
    for (const auto& item : control.menu)
      entries.push_back(fmt::format("{} ({})", item.index, item.text));
    return join(entries, ", ");
  }
  const auto range = fmt::format("{} to {}", control.least, control.most);
  return control.step > 1 ? fmt::format("{} in steps of {}", range, control.step) : range;
}

Result<std::int64_t> value_for(const Control& control, std::string_view text) {
  if (const auto value = meant_by(control, text)) return *value;
  return fail(Errc::bad_config, fmt::format("the control {} cannot be {}; it accepts {}",
                                            control.name, quote(text), range_of(control)));
}

std::int64_t on_step(const Control& control, std::int64_t value) {
  if (control.step <= 1) return value;
  // Differences of 64-bit values do not overflow as unsigned ones.
  const auto step = static_cast<std::uint64_t>(control.step);
  const auto above = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(control.least);
  const auto range =
      static_cast<std::uint64_t>(control.most) - static_cast<std::uint64_t>(control.least);
  const auto steps = std::min(above / step + (above % step > (step - 1) / 2 ? 1 : 0), range / step);
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(control.least) + steps * step);
}

namespace {

constexpr int kMostControls = 10'000;     // ends the list of a driver that has no end
constexpr std::int64_t kMostItems = 256;  // of a menu

ControlKind kind_of(std::uint32_t type) {
  switch (type) {
    case V4L2_CTRL_TYPE_INTEGER:
    case V4L2_CTRL_TYPE_INTEGER64:
    case V4L2_CTRL_TYPE_BITMASK:
      return ControlKind::number;
    case V4L2_CTRL_TYPE_BOOLEAN:
      return ControlKind::boolean;
    case V4L2_CTRL_TYPE_MENU:
    case V4L2_CTRL_TYPE_INTEGER_MENU:
      return ControlKind::menu;
    case V4L2_CTRL_TYPE_BUTTON:
      return ControlKind::button;
    default:
      return ControlKind::other;
  }
}

/// A text of the driver: at most `most` bytes, and without control characters.
std::string text_in(const char* bytes, std::size_t most) {
  return printable({bytes, std::find(bytes, bytes + most, '\0')});
}

std::vector<MenuItem> menu_of(int fd, const v4l2_query_ext_ctrl& control) {
  std::vector<MenuItem> menu;
  const auto last = std::min(control.maximum, control.minimum + kMostItems);
  for (std::int64_t index = control.minimum; index <= last; ++index) {
    v4l2_querymenu item{.id = control.id, .index = static_cast<__u32>(index)};
    if (call(fd, VIDIOC_QUERYMENU, &item) != 0) continue;  // menus may have gaps
    menu.push_back(
        {index, control.type == V4L2_CTRL_TYPE_INTEGER_MENU
                    ? std::to_string(static_cast<std::int64_t>(item.value))
                    : text_in(reinterpret_cast<const char*>(item.name), sizeof item.name)});
  }
  return menu;
}

Control control_in(int fd, const v4l2_query_ext_ctrl& entry) {
  Control control{.id = entry.id,
                  .kind = kind_of(entry.type),
                  .title = text_in(entry.name, sizeof entry.name),
                  .name = {},
                  .least = entry.minimum,
                  .most = entry.maximum,
                  .step = static_cast<std::int64_t>(std::min<__u64>(entry.step, INT64_MAX)),
                  .menu = {},
                  .is_read_only = (entry.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0,
                  .is_inactive = (entry.flags & V4L2_CTRL_FLAG_INACTIVE) != 0,
                  .is_grabbed = (entry.flags & V4L2_CTRL_FLAG_GRABBED) != 0};
  control.name = kernel_name(control.title);
  if (entry.type == V4L2_CTRL_TYPE_BITMASK) control.least = 0, control.step = 1;
  if (control.kind == ControlKind::menu) control.menu = menu_of(fd, entry);
  return control;
}

bool is_usable(const v4l2_query_ext_ctrl& entry) {
  return (entry.flags & V4L2_CTRL_FLAG_DISABLED) == 0 && entry.type != V4L2_CTRL_TYPE_CTRL_CLASS;
}

/// Reads or writes one control.
int transfer(int fd, unsigned long request, const Control& control, std::int64_t& value) {
  v4l2_ext_control one{};
  one.id = control.id;
  one.value64 = value;  // also fills `value`, on little-endian machines
  v4l2_ext_controls all{};
  all.ctrl_class = V4L2_CTRL_ID2CLASS(control.id);
  all.count = 1;
  all.controls = &one;
  const int number = call(fd, request, &all);
  const bool is_wide = control.least < INT32_MIN || control.most > INT32_MAX;
  value = is_wide ? static_cast<std::int64_t>(one.value64) : one.value;
  return number;
}

Result<void> check_writable(const Device& device, const Control& control) {
  const char* reason = control.kind == ControlKind::other ? "is a text or a table, which a rig "
                                                            "file cannot set"
                       : control.is_read_only             ? "can only be read"
                       : control.is_inactive ? "is inactive, because another control decides; set "
                                               "that one first (an automatic mode to manual)"
                       : control.is_grabbed  ? "is locked, because the camera is in use"
                                             : nullptr;
  if (reason == nullptr) return {};
  return fail(Errc::bad_config, fmt::format("{}: the control {} {}", describe(device.identity),
                                            control.name, reason));
}

/// The control of this name. Errors: bad_config, with those that the device has.
Result<Control> named(const Device& device, std::string_view name) {
  auto controls = controls_of(device.fd.get());
  const auto found = std::ranges::find(controls, name, &Control::name);
  if (found != controls.end()) return std::move(*found);
  std::vector<std::string> names;
  names.reserve(controls.size());
  for (const auto& control : controls) names.push_back(control.name);
  return fail(Errc::bad_config,
              fmt::format("{} has no control {}; {}", describe(device.identity), quote(name),
                          names.empty() ? "it has none" : "it has " + join(names, ", ")));
}

Result<void> set(const Device& device, const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos)
    return fail(Errc::bad_config,
                "v4l2.controls: " + quote(assignment) + " is not of the form name=value");
  const auto control = named(device, std::string_view(assignment).substr(0, equals));
  if (!control) return tl::make_unexpected(control.error());
  const auto value = value_for(*control, std::string_view(assignment).substr(equals + 1));
  if (!value) return fail_in(describe(device.identity), value.error());
  const auto held = write_control(device, *control, *value);
  if (!held) return tl::make_unexpected(held.error());
  if (*held != *value)
    log::warning("the control {} is {} instead of {}", control->name, *held, *value);
  return {};
}

}  // namespace

std::vector<Control> controls_of(int fd) {
  constexpr std::uint32_t kNext = V4L2_CTRL_FLAG_NEXT_CTRL | V4L2_CTRL_FLAG_NEXT_COMPOUND;
  std::vector<Control> controls;
  v4l2_query_ext_ctrl entry{.id = kNext};
  for (int i = 0; i < kMostControls && call(fd, VIDIOC_QUERY_EXT_CTRL, &entry) == 0; ++i) {
    if (is_usable(entry)) controls.push_back(control_in(fd, entry));
    entry = {.id = entry.id | kNext};
  }
  return controls;
}

std::optional<Control> find_control(int fd, std::uint32_t id) {
  v4l2_query_ext_ctrl entry{.id = id};
  if (call(fd, VIDIOC_QUERY_EXT_CTRL, &entry) != 0 || !is_usable(entry)) return std::nullopt;
  return control_in(fd, entry);
}

std::optional<std::int64_t> read_control(int fd, const Control& control) {
  std::int64_t value = 0;
  if (transfer(fd, VIDIOC_G_EXT_CTRLS, control, value) != 0) return std::nullopt;
  return value;
}

Result<std::int64_t> write_control(const Device& device, const Control& control,
                                   std::int64_t value) {
  if (auto writable = check_writable(device, control); !writable)
    return tl::make_unexpected(writable.error());
  std::int64_t sent = value;
  if (const int number = transfer(device.fd.get(), VIDIOC_S_EXT_CTRLS, control, sent); number != 0)
    return tl::make_unexpected(
        error_of(device.identity, Errc::bad_config,
                 fmt::format("the control {} cannot be set to {}; it accepts {}", control.name,
                             value, range_of(control)),
                 number));
  if (control.kind == ControlKind::button) return value;
  return read_control(device.fd.get(), control).value_or(value);
}

Result<void> set_controls(const Device& device, const std::vector<std::string>& assignments) {
  for (const auto& assignment : assignments)
    if (auto done = set(device, assignment); !done) return done;
  return {};
}

}  // namespace handcast::camera::v4l2
