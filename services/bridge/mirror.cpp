// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/mirror.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::bridge {

std::vector<std::string> Mirror::follow(std::string_view values) {
  std::map<std::string, std::string, std::less<>> now;
  while (!values.empty()) {
    const auto line = values.substr(0, values.find('\n'));
    values.remove_prefix(std::min(line.size() + 1, values.size()));
    const auto equals = line.find(" = ");
    if (equals == line.npos) continue;
    if (line.starts_with("light.") || line.starts_with("content."))
      now.emplace(line.substr(0, equals), line.substr(equals + 3));
  }
  std::vector<std::string> changes;
  for (const auto& [setting, value] : now)
    if (const auto before = theirs_.find(setting);
        before == theirs_.end() || before->second != value)
      changes.push_back(fmt::format("{}={}", setting, value));
  for (const auto& [setting, value] : theirs_)
    if (!now.contains(setting)) changes.push_back(setting);
  theirs_ = std::move(now);
  return changes;
}

}  // namespace handcast::bridge
