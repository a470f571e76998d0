// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <type_traits>
#include <vector>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"

/// Helpers for tests that cover all settings.
namespace handcast::config {

/// All settings of a rig, which must outlive the result.
inline std::vector<Setting> every_setting(Rig& rig) {
  std::vector<Setting> all;
  for (const auto& section : list_settings(rig))
    all.insert(all.end(), section.settings.begin(), section.settings.end());
  return all;
}

/// The paths of the settings whose values differ between two rigs.
inline std::vector<std::string> differences(Rig a, Rig b) {
  const auto of_a = every_setting(a), of_b = every_setting(b);
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (print_value(of_a[i]) != print_value(of_b[i])) paths.push_back(of_a[i].path);
  return paths;
}

/// Changes a setting to another allowed value, one that is hard to print if its type has such
/// values.
inline void change(const Setting& setting) {
  std::visit(
      [&](const auto& target) {
        if constexpr (std::is_same_v<std::decay_t<decltype(target)>, ChoiceTarget>) {
          target.assign(target.value, (target.index(target.value) + 1) % target.words.size());
          return;
        } else {
          auto* value = target;
          using T = std::decay_t<decltype(*value)>;
          if constexpr (std::is_same_v<T, bool>) *value = !*value;
          if constexpr (std::is_same_v<T, int>) *value += *value + 1 <= setting.range.max ? 1 : -1;
          if constexpr (std::is_same_v<T, double>)
            *value =
                (*value + setting.range.min) / 2 + (setting.range.max - setting.range.min) / 3e6;
          if constexpr (std::is_same_v<T, std::vector<double>>) {
            if (!value->empty()) value->pop_back();  // it keeps its length
            value->push_back(setting.name() == "cores" ? 1 : 0.1);
          }
          if constexpr (std::is_same_v<T, std::vector<std::string>>)
            value->push_back(setting.name() == "keep_out" ? "1 2, 3.5 4, -5 6"
                             : setting.name() == "hours"  ? "mon 10:00-18:00"
                                                          : "a, \"quoted\" [text] = 1");
          if constexpr (std::is_same_v<T, std::string>)
            *value = setting.path == "name" ? "another_rig"
                                            : "/a \"quoted\" \\ path\twith a tab and a hä\x01";
        }
      },
      setting.target);
}

}  // namespace handcast::config
