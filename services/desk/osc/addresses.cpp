// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/addresses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/quoted.hpp"
#include "ipc/base/join.hpp"
#include "services/desk/controls/control_value.hpp"
#include "services/desk/osc/pattern.hpp"

namespace handcast::desk::osc {
namespace {

/// A list of numbers or texts from all arguments.
Result<std::string> assign_list(const Control& control, const Message& message) {
  std::vector<std::string> elements;
  for (const auto& argument : message.arguments()) {
    if (control.kind == Kind::texts) {
      if (!argument.is_text()) return fail(Errc::bad_data, "takes texts (s)");
      elements.push_back(config::quoted(argument.text));
      continue;
    }
    if (!argument.is_number()) return fail(Errc::bad_data, "takes numbers (f)");
    const auto one = assign_number(control, argument.number, argument.type == 'f');
    if (!one) return tl::make_unexpected(one.error());
    elements.push_back(one->substr(control.path.size() + 1));
  }
  return fmt::format("{}=[{}]", control.path, join(elements, ", "));
}

void add_value(MessageWriter& message, const config::Value& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) message.add(*flag);
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    message.add(static_cast<std::int32_t>(*whole));
  if (const auto* number = std::get_if<double>(&value.data))
    message.add(static_cast<float>(*number));
  if (const auto* text = std::get_if<std::string>(&value.data)) message.add(*text);
  if (const auto* list = std::get_if<config::Array>(&value.data))
    for (const auto& element : *list) add_value(message, element);
}

/// Whole numbers stand for numbers, too ("1" for 1.0), but a receiver expects one type.
void make_floats(config::Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    value.data = static_cast<double>(*whole);
  else if (auto* list = std::get_if<config::Array>(&value.data))
    std::ranges::for_each(*list, make_floats);
}

}  // namespace

std::string address_of(std::string_view path) {
  auto address = "/" + std::string(path);
  std::ranges::replace(address, '.', '/');
  return address;
}

Addresses::Addresses(std::span<const Control> controls) : controls_(controls) {
  for (std::size_t i = 0; i < controls.size(); ++i) {
    addresses_.push_back(address_of(controls[i].path));
    index_.emplace(addresses_.back(), i);
  }
}

std::optional<std::size_t> Addresses::find(std::string_view address) const {
  const auto found = index_.find(address);
  return found == index_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::size_t> Addresses::find_all(std::string_view pattern, int& steps) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < addresses_.size() && steps > 0; ++i)
    if (matches(pattern, addresses_[i], steps)) found.push_back(i);
  return found;
}

Result<std::string> assignment_of(const Control& control, const Message& message) {
  if (message.count == 1 && message.all[0].type == 'N') return control.path;
  if (control.kind == Kind::numbers || control.kind == Kind::texts)
    return assign_list(control, message);
  const auto& argument = message.all[0];
  if (message.count != 1 || (!argument.is_number() && !argument.is_text()))
    return fail(Errc::bad_data, fmt::format("takes one number or text, but has {} arguments ({})",
                                            message.count, message.count ? argument.type : '-'));
  return argument.is_text() ? assign_text(control, argument.text)
                            : assign_number(control, argument.number, argument.type == 'f');
}

std::string write_value(const Control& control, std::string_view toml) {
  MessageWriter message(address_of(control.path));
  auto value = read_value(toml);
  if (control.kind == Kind::number || control.kind == Kind::numbers) make_floats(value);
  add_value(message, value);
  return message.packet();
}

}  // namespace handcast::desk::osc
