// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

namespace handcast::bench {

/// A figure and what it must not exceed (or fall below).
struct Goal {
  std::string name;
  double value = 0, limit = 0;
  std::string unit;
  bool at_least = false;

  bool met() const { return at_least ? value >= limit : value <= limit; }
};

inline void print_goals(const std::vector<Goal>& goals) {
  for (const Goal& goal : goals)
    fmt::print("{} {}: {:.3g} {} (goal {} {:g})\n", goal.met() ? "met " : "MISS", goal.name,
               goal.value, goal.unit, goal.at_least ? ">=" : "<=", goal.limit);
}

inline bool write_goals(const std::string& path, const std::vector<Goal>& goals) {
  std::ofstream file(path);
  file << "{\"goals\": [";
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Goal& goal = goals[i];
    file << fmt::format(
        R"({}{{"name": "{}", "value": {:.4g}, "limit": {:g}, "unit": "{}", "met": {}, "at_least": {}}})",
        i ? ",\n " : "\n ", goal.name, goal.value, goal.limit, goal.unit, goal.met(),
        goal.at_least);
  }
  file << "\n]}\n";
  return static_cast<bool>(file.flush());
}

}  // namespace handcast::bench
