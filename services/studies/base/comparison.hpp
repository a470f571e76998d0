// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/studies/base/statistics.hpp"
#include "services/studies/base/study_table.hpp"

namespace handcast::study {

/// A value of a subject under a condition.
struct Measured {
  std::string subject, condition;
  double value = 0;
};

/// Values of two or more conditions by subject.
struct Comparison {
  std::vector<std::string> conditions;      ///< "baseline" first, else as they came
  std::vector<std::string> subjects;        ///< those that have a value of every condition
  std::vector<std::vector<double>> values;  ///< by condition and subject
  std::vector<Summary> summaries;           ///< by condition
  std::optional<PairedTest> test;           ///< of the second condition against the first
  std::vector<std::string> left_out;        ///< subjects that lack a condition
};

/// Compares them. Several values of a subject under a condition count as their mean. Errors:
/// bad_data (no subject has a value of every condition).
Result<Comparison> compare(const std::vector<Measured>& measured);

/// Reads the columns subject, condition and `value`. Errors: bad_data.
Result<std::vector<Measured>> measured_in(const StudyTable& table, std::string_view value);

/// `unit`: the end of the names of all values, "ms".
nlohmann::json to_json(const Comparison& comparison, const std::string& unit);
/// The same in sentences for people: "baseline 3.08 ± 1.38 ms, …".
std::string describe(const Comparison& comparison, const std::string& unit);

}  // namespace handcast::study
