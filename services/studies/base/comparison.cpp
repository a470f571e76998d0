// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "ipc/base/join.hpp"

namespace handcast::study {
namespace {

/// The texts in the order in which they come first.
template <class Get>
std::vector<std::string> distinct(const std::vector<Measured>& measured, Get get) {
  std::vector<std::string> all;
  std::set<std::string> known;
  for (const auto& each : measured)
    if (known.insert(get(each)).second) all.push_back(get(each));
  return all;
}

std::string p_text(double p) { return p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", p); }

}  // namespace

Result<Comparison> compare(const std::vector<Measured>& measured) {
  Comparison comparison;
  comparison.conditions = distinct(measured, [](const auto& each) { return each.condition; });
  const auto base = std::ranges::find(comparison.conditions, "baseline");
  if (base != comparison.conditions.end())
    std::rotate(comparison.conditions.begin(), base, base + 1);
  std::map<std::pair<std::string, std::string>, std::vector<double>> found;
  for (const auto& each : measured) found[{each.subject, each.condition}].push_back(each.value);
  comparison.values.resize(comparison.conditions.size());
  for (const auto& subject : distinct(measured, [](const auto& each) { return each.subject; })) {
    const auto lacks = [&](const auto& condition) { return !found.contains({subject, condition}); };
    if (std::ranges::any_of(comparison.conditions, lacks)) {
      comparison.left_out.push_back(subject);
      continue;
    }
    comparison.subjects.push_back(subject);
    for (std::size_t c = 0; c < comparison.conditions.size(); ++c)
      comparison.values[c].push_back(summary_of(found[{subject, comparison.conditions[c]}]).mean);
  }
  if (comparison.subjects.empty())
    return fail(Errc::bad_data, "no subject has a value of every condition");
  for (const auto& values : comparison.values) comparison.summaries.push_back(summary_of(values));
  if (comparison.values.size() >= 2)
    comparison.test = paired_t_test(comparison.values[0], comparison.values[1]);
  return comparison;
}

Result<std::vector<Measured>> measured_in(const StudyTable& table, std::string_view value) {
  const auto subject = table.column("subject"), condition = table.column("condition"),
             number = table.column(value);
  for (const auto* column : {&subject, &condition, &number})
    if (!*column) return tl::make_unexpected(column->error());
  std::vector<Measured> measured;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto read = table.number(row, *number);
    if (!read) return tl::make_unexpected(read.error());
    measured.push_back({table.rows[row][*subject], table.rows[row][*condition], *read});
  }
  if (measured.empty())
    return fail(Errc::bad_data, fmt::format("{}: the table has no rows", table.name));
  return measured;
}

nlohmann::json to_json(const Comparison& comparison, const std::string& unit) {
  nlohmann::json json{{"subjects", comparison.subjects},
                      {"left_out", comparison.left_out},
                      {"order", comparison.conditions},
                      {"conditions", nlohmann::json::object()},
                      {"paired_t_test", nullptr}};
  for (std::size_t c = 0; c < comparison.conditions.size(); ++c) {
    const auto& summary = comparison.summaries[c];
    json["conditions"][comparison.conditions[c]] = {{"count", summary.count},
                                                    {"values_" + unit, comparison.values[c]},
                                                    {"mean_" + unit, summary.mean},
                                                    {"sd_" + unit, summary.population_sd},
                                                    {"sample_sd_" + unit, summary.sample_sd},
                                                    {"median_" + unit, summary.median}};
  }
  if (const auto& test = comparison.test)
    json["paired_t_test"] = {{"t", test->t},
                             {"df", test->freedom},
                             {"p", test->p},
                             {"mean_difference_" + unit, test->mean_difference},
                             {"interval_" + unit, {test->interval_low, test->interval_high}},
                             {"effect_size", test->effect_size}};
  return json;
}

std::string describe(const Comparison& comparison, const std::string& unit) {
  std::string text;
  for (std::size_t c = 0; c < comparison.conditions.size(); ++c) {
    const auto& summary = comparison.summaries[c];
    text +=
        fmt::format("{}: {:.2f} ± {:.2f} {} (mean ± population deviation of {}), median {:.2f}\n",
                    comparison.conditions[c], summary.mean, summary.population_sd, unit,
                    summary.count, summary.median);
  }
  if (const auto& test = comparison.test)
    text += fmt::format(
        "{} minus {}: {:+.2f} {} (95 % interval {:.2f} to {:.2f}), paired t-test t({}) = {:.2f}, "
        "{}, effect size d = {:.2f}\n",
        comparison.conditions[1], comparison.conditions[0], test->mean_difference, unit,
        test->interval_low, test->interval_high, test->freedom, test->t, p_text(test->p),
        test->effect_size);
  if (!comparison.left_out.empty())
    text += fmt::format("left out, because a condition is missing: {}\n",
                        join(comparison.left_out, ", "));
  return text;
}

}  // namespace handcast::study
