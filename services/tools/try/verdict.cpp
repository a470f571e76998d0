// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace handcast::trial {
namespace {

std::string text_at(const Report& report, const char* key) {
  return report.at(key).get<std::string>();
}

/// "0 to 1, at first 0.5"; the choices of a choice.
std::string range_of(const Report& parameter) {
  using Numbers = std::vector<double>;
  const auto numbers = [&](const char* key) {
    std::vector<std::string> texts;
    for (const double number : parameter.at(key).get<Numbers>())
      texts.push_back(fmt::format("{:g}", number));
    return fmt::format("{}", fmt::join(texts, ","));
  };
  const auto choices = parameter.at("choices").get<std::vector<std::string>>();
  std::string text = fmt::format("{}", fmt::join(choices, ", "));
  if (choices.empty() && !parameter.at("least").empty() && !parameter.at("most").empty())
    text = numbers("least") + " to " + numbers("most");
  if (parameter.at("initial").empty()) return text;
  return fmt::format("{}{}at first {}", text, text.empty() ? "" : "; ", numbers("initial"));
}

}  // namespace

std::string verdict(const Report& report) {
  const auto source = text_at(report, "source"), error = text_at(report, "error");
  const int pictures = report.at("pictures");
  if (!report.at("loaded").get<bool>()) return fmt::format("{}: not loaded: {}", source, error);
  if (!report.at("drawn").get<bool>())
    return fmt::format("{}: not drawn: {} ({} pictures before)", source,
                       error.empty() ? "it has drawn nothing" : error, pictures);
  std::string motion = text_at(report, "motion");
  if (motion == "reacts")
    motion = fmt::format("still, reacts to {}",
                         fmt::join(report.at("reacts_to").get<std::vector<std::string>>(), ", "));
  return fmt::format("{}: {}{}, {:.1f} ms a picture (99 %: {:.1f}){}{}", source, motion,
                     report.at("plain").get<bool>() ? ", of one colour" : "",
                     report.at("median_ms").get<double>(), report.at("p99_ms").get<double>(),
                     error.empty() ? "" : "; ", error);
}

std::string parameter_list(const Report& report) {
  std::string list;
  for (const auto& parameter : report.at("parameters"))
    list +=
        fmt::format("    {:<16} {:<7} {} ({})\n", text_at(parameter, "name"),
                    text_at(parameter, "kind"), range_of(parameter), text_at(parameter, "label"));
  return list;
}

Report count(std::span<const Report> reports) {
  const auto with = [&](const char* key, const Report& value) {
    return std::ranges::count_if(reports, [&](const auto& each) { return each.at(key) == value; });
  };
  return {{"tried", reports.size()},
          {"loaded", with("loaded", true)},
          {"drawn", with("drawn", true)},
          {"moves", with("motion", "moves")},
          {"reacts", with("motion", "reacts")},
          {"still", with("motion", "still")},
          {"hangs", with("end", "hang")},
          {"crashes", with("end", "crash")},
          {"plain", std::ranges::count_if(reports, [](const auto& each) {
             return each.at("drawn") == true && each.at("plain") == true;
           })}};
}

std::string summary(std::span<const Report> reports) {
  const auto counted = count(reports);
  const auto of = [&](const char* key) { return counted.at(key).get<int>(); };
  return fmt::format(
      "{} of {} loaded, {} drawn: {} move, {} react to parameters, {} are still, {} are of one "
      "colour; {} hang, {} crash",
      of("loaded"), of("tried"), of("drawn"), of("moves"), of("reacts"), of("still"), of("plain"),
      of("hangs"), of("crashes"));
}

}  // namespace handcast::trial
