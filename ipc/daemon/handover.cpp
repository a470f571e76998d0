// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/handover.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "ipc/daemon/contract.hpp"

namespace handcast::daemon {
namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string_view value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value ? value : "";
}

int descriptor_in(const char* variable) {
  return std::max(parse_number<int>(value_of(variable)).value_or(-1), -1);
}

/// Reads "NUMBER:" off the beginning of a text.
template <class Number>
bool take_field(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ':') return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return true;
}

}  // namespace

std::string print_rings(const Rings& rings) {
  std::string text;
  for (const auto& [stream, fd] : rings)
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", stream, fd);
  return text;
}

Rings parse_rings(std::string_view text) {
  Rings rings;
  while (!text.empty()) {
    const auto comma = text.find(',');
    const auto entry = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    const auto equals = entry.find('=');
    if (equals == 0 || equals == std::string_view::npos) continue;
    if (const auto fd = parse_number<int>(entry.substr(equals + 1)); fd && *fd >= 0)
      rings.emplace_back(entry.substr(0, equals), *fd);
  }
  return rings;
}

std::optional<int> find_ring(const Rings& rings, std::string_view stream) {
  const auto found =
      std::ranges::find_if(rings, [&](const auto& ring) { return ring.first == stream; });
  return found == rings.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> to_environment(const Handover& handover) {
  std::vector<std::string> variables{
      fmt::format("{}={}", kRingsVariable, print_rings(handover.rings))};
  const auto add = [&](const char* name, auto value) {
    variables.push_back(fmt::format("{}={}", name, value));
  };
  if (handover.ready_fd >= 0) add(kReadyVariable, handover.ready_fd);
  if (handover.epoch_ns) add(kEpochVariable, *handover.epoch_ns);
  if (handover.standby_fd >= 0) add(kStandbyVariable, handover.standby_fd);
  if (!handover.rig.empty()) add(kRigVariable, handover.rig);
  if (handover.state_fd >= 0) add(kStateVariable, handover.state_fd);
  return variables;
}

Handover from_environment() {
  return {.rings = parse_rings(value_of(kRingsVariable)),
          .ready_fd = descriptor_in(kReadyVariable),
          .standby_fd = descriptor_in(kStandbyVariable),
          .epoch_ns = parse_number<std::int64_t>(value_of(kEpochVariable)),
          .rig = std::string(value_of(kRigVariable)),
          .state_fd = descriptor_in(kStateVariable)};
}

std::uint64_t own_network() {
  struct stat status {};
  return stat("/proc/self/ns/net", &status) == 0 ? status.st_ino : 0;
}

std::string print_mark(const RigMark& mark) {
  return fmt::format("{}:{}:{}", mark.network, mark.epoch_ns, mark.address);
}

std::optional<RigMark> mark_in(std::string_view command_line) {
  const auto option = fmt::format("{0}{1}{0}", '\0', kRigOption);
  const auto found = command_line.find(option);
  if (found == std::string_view::npos) return std::nullopt;
  auto text = command_line.substr(found + option.size());
  text = text.substr(0, text.find('\0'));
  RigMark mark;
  if (!take_field(text, mark.network) || !take_field(text, mark.epoch_ns)) return std::nullopt;
  mark.address = text;
  return mark;
}

}  // namespace handcast::daemon
