// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace handcast::doctor {

std::string print(const std::vector<Finding>& findings) {
  std::string text;
  for (const auto& finding : findings) {
    text += fmt::format("{:<8} {:<18} {}\n", kGradeNames[static_cast<std::size_t>(finding.grade)],
                        finding.check, finding.sentence);
    if (!finding.remedy.empty()) text += fmt::format("{:<27} -> {}\n", "", finding.remedy);
  }
  const auto count = [&](Grade grade) {
    return std::ranges::count(findings, grade, &Finding::grade);
  };
  return text + fmt::format("faults: {}, advice: {}, good: {}\n", count(Grade::fault),
                            count(Grade::advice), count(Grade::good));
}

std::string to_json(const std::vector<Finding>& findings) {
  auto list = nlohmann::json::array();
  for (const auto& finding : findings)
    list.push_back({{"check", finding.check},
                    {"grade", kGradeNames[static_cast<std::size_t>(finding.grade)]},
                    {"sentence", finding.sentence},
                    {"remedy", finding.remedy}});
  return list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

bool has_fault(const std::vector<Finding>& findings) {
  return std::ranges::any_of(findings,
                             [](const Finding& finding) { return finding.grade == Grade::fault; });
}

}  // namespace handcast::doctor
