// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "ipc/base/join.hpp"

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
  return fail(Errc::bad_config, fmt::format("the control {} cannot be '{}'; it accepts {}",
                                            control.name, text, range_of(control)));
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

}  // namespace handcast::camera::v4l2
