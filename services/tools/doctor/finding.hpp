// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::doctor {

/// How bad a finding is.
enum class Grade {
  good,    ///< as it should be
  advice,  ///< the show can go on, but something could be better
  fault,   ///< the light will be late, wrong or missing
};
inline constexpr std::array<std::string_view, 3> kGradeNames{"good", "advice", "fault"};

/// The result of one check.
struct Finding {
  std::string check;  ///< what was looked at: "camera rate"
  Grade grade = Grade::good;
  std::string sentence;  ///< what was found
  std::string remedy;    ///< what to do, one line; empty if it is good
};

/// The findings for people, one line each and one for its remedy.
std::string print(const std::vector<Finding>& findings);
/// The same as JSON: an array of objects with the members of Finding.
std::string to_json(const std::vector<Finding>& findings);

/// Whether any finding is a fault.
bool has_fault(const std::vector<Finding>& findings);

}  // namespace handcast::doctor
