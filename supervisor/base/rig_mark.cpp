// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/rig_mark.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <charconv>

#include "ipc/daemon/contract.hpp"

namespace handcast::supervisor {
namespace {

/// Reads "NUMBER:" off the beginning of a text.
template <class Number>
bool take_field(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ':') return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return true;
}

}  // namespace

std::uint64_t own_network() {
  struct stat status {};
  return stat("/proc/self/ns/net", &status) == 0 ? status.st_ino : 0;
}

std::string print_mark(const RigMark& mark) {
  return fmt::format("{}:{}:{}", mark.network, mark.epoch_ns, mark.address);
}

std::optional<RigMark> mark_in(std::string_view command_line) {
  const auto option = fmt::format("{0}{1}{0}", '\0', daemon::kRigOption);
  const auto found = command_line.find(option);
  if (found == std::string_view::npos) return std::nullopt;
  auto text = command_line.substr(found + option.size());
  text = text.substr(0, text.find('\0'));
  RigMark mark;
  if (!take_field(text, mark.network) || !take_field(text, mark.epoch_ns)) return std::nullopt;
  mark.address = text;
  return mark;
}

}  // namespace handcast::supervisor
