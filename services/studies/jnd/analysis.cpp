// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"
#include "services/studies/jnd/course.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> logs_in(const std::string& name) {
  std::error_code failed;
  if (!fs::is_directory(name, failed)) return std::vector<fs::path>{name};
  std::vector<fs::path> logs;
  for (const auto& entry : fs::directory_iterator(name, failed))
    if (const auto file = entry.path().filename().string();
        file.starts_with("subject-") && file.ends_with(".csv") && !file.ends_with(".light.csv"))
      logs.push_back(entry.path());
  std::ranges::sort(logs);
  if (logs.empty())
    return fail(Errc::bad_config,
                fmt::format("{}: there are no logs of subjects (subject-NN.csv)", name));
  return logs;
}

/// The settings that a log was made with, from its first row.
Result<CourseSettings> settings_of(const StudyTable& log) {
  CourseSettings settings;
  const auto subject = log.number(0, 0);
  if (!subject) return tl::make_unexpected(subject.error());
  const auto& seed = log.rows[0][1];
  const auto read = std::from_chars(seed.data(), seed.data() + seed.size(), settings.seed);
  const auto kind = std::ranges::find(kProcedureNames, log.rows[0][2]);
  if (*subject < 1 || *subject > kMostSubjects || read.ec != std::errc{} ||
      kind == std::end(kProcedureNames))
    return fail(
        Errc::bad_data,
        fmt::format("{}: row 1 has subject {}, seed {} and protocol {}, which are not those "
                    "of a study",
                    log.name, quote(log.rows[0][0]), quote(seed), quote(log.rows[0][2])));
  settings.subject = static_cast<int>(*subject);
  settings.procedure = static_cast<ProcedureKind>(kind - std::begin(kProcedureNames));
  return settings;
}

Result<void> add_log(const StudyTable& log, JndFindings& findings,
                     std::vector<Measured>& measured) {
  if (log.rows.empty()) {
    findings.unfinished.push_back(fmt::format("{}: no trial was answered", log.name));
    return {};
  }
  const auto settings = settings_of(log);
  if (!settings) return tl::make_unexpected(settings.error());
  Course course(*settings);
  if (auto replayed = course.replay(log); !replayed) return replayed;
  for (const auto& result : course.results()) {
    const auto subject = log.rows[0][0];
    findings.sessions.push_back({subject, result});
    if (!result.is_training)
      measured.push_back({subject,
                          std::string(kConditionNames[static_cast<std::size_t>(result.condition)]),
                          result.jnd_ms});
  }
  if (course.trial())
    findings.unfinished.push_back(
        fmt::format("{}: {} of 4 sessions are complete", log.name, course.results().size()));
  return {};
}

Result<void> add_file(const fs::path& file, JndFindings& findings,
                      std::vector<Measured>& measured) {
  const auto table = read_study_table(file);
  if (!table) return tl::make_unexpected(table.error());
  if (table->columns == Course::columns()) return add_log(*table, findings, measured);
  const auto read = measured_in(*table, "jnd_ms");
  if (!read) return tl::make_unexpected(read.error());
  measured.insert(measured.end(), read->begin(), read->end());
  return {};
}

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>handcast: just noticeable delay</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: light dark; --ink: light-dark(#1c232b, #dfe3e8); --first: light-dark(#8b97a5, #7d8894); --second: light-dark(#1273c4, #58b0ff); }
body { color: var(--ink); font: 16px/1.55 system-ui, sans-serif; margin: 2.5rem auto; max-width: 900px; padding: 0 1.2rem; }
h1 { font-weight: 500; } h2 { font-size: 1.1rem; margin-top: 2.2rem; }
svg { display: block; width: 100%; height: auto; } svg text { fill: var(--ink); font: 12px system-ui, sans-serif; }
.bar0 { fill: var(--first); } .bar1 { fill: var(--second); } .axis { stroke: var(--ink); stroke-opacity: .18; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } td, th { padding: .2rem .9rem .2rem 0; text-align: right; } td:first-child, th:first-child { text-align: left; }
figure { margin: 0; } img { max-width: 100%; } small { opacity: .75; }
</style>
<h1>Just noticeable delay</h1>
)";

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text)
    html += c == '<' || c == '>' || c == '&' || c == '"' ||
                    (static_cast<unsigned char>(c) < 0x20 && c != '\n')
                ? fmt::format("&#{};", static_cast<int>(static_cast<unsigned char>(c)))
                : std::string(1, c);
  return html;
}

/// Bars of the conditions by subject, as the figure of the paper.
std::string bars_of(const Comparison& comparison) {
  constexpr double kWidth = 860, kHeight = 300, kLeft = 40, kBottom = 30, kTop = 30;
  double most = 1;
  for (const auto& values : comparison.values)
    for (const double value : values) most = std::max(most, value);
  const double per_ms = (kHeight - kBottom - kTop) / most, floor = kHeight - kBottom;
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"JND by subject and condition\">",
      kWidth, kHeight);
  const double step = most > 40 ? 20 : most > 12 ? 5 : most > 4 ? 2 : 1;
  for (double ms = 0; ms <= most; ms += step)
    svg += fmt::format(
        "<line class=\"axis\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>",
        kLeft, kWidth, floor - ms * per_ms, kLeft - 6, floor - ms * per_ms + 4, ms);
  const auto subjects = static_cast<double>(comparison.subjects.size()),
             conditions = static_cast<double>(comparison.conditions.size());
  const double group = (kWidth - kLeft) / subjects, bar = std::min(30.0, 0.7 * group / conditions);
  for (std::size_t s = 0; s < comparison.subjects.size(); ++s) {
    const double middle = kLeft + group * (static_cast<double>(s) + 0.5);
    for (std::size_t c = 0; c < comparison.conditions.size(); ++c) {
      const double height = comparison.values[c][s] * per_ms;
      svg += fmt::format(
          "<rect class=\"bar{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
          "height=\"{:.1f}\"><title>{}, {}: {:.2f} ms</title></rect>",
          c % 2, middle + (static_cast<double>(c) - conditions / 2) * bar, floor - height, bar - 2,
          height, escaped(comparison.subjects[s]), escaped(comparison.conditions[c]),
          comparison.values[c][s]);
    }
    if (subjects <= 40)
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", middle,
                         kHeight - 10, escaped(comparison.subjects[s]));
  }
  for (std::size_t c = 0; c < comparison.conditions.size(); ++c)
    svg += fmt::format(
        "<rect class=\"bar{}\" x=\"{}\" y=\"6\" width=\"12\" height=\"12\"/>"
        "<text x=\"{}\" y=\"16\">{}</text>",
        c % 2, kLeft + 150 * static_cast<double>(c), kLeft + 18 + 150 * static_cast<double>(c),
        escaped(comparison.conditions[c]));
  return svg + "<text x=\"0\" y=\"16\">ms</text></svg>";
}

std::string sessions_of(const JndFindings& findings) {
  if (findings.sessions.empty()) return "";
  std::string rows =
      "<h2>Sessions</h2><table><tr><th>Subject<th>Phase<th>Condition<th>Trials"
      "<th>JND<th>last five reversals<th>fit (95 %)</tr>";
  for (const auto& [subject, result] : findings.sessions)
    rows += fmt::format(
        "<tr><td>{}<td>{}<td>{}<td>{}<td>{:.2f}<td>{:.2f}<td>{:.2f} ({:.2f}…{:.2f})</tr>",
        escaped(subject), result.is_training ? "training" : "test",
        kConditionNames[static_cast<std::size_t>(result.condition)], result.trials, result.jnd_ms,
        result.mean_of_five_ms, result.fit.jnd_ms, result.fit.low_ms, result.fit.high_ms);
  return rows +
         "</table><small>All in ms. Fit: a logistic psychometric function with lapses, from "
         "all answers of the session.</small>";
}

}  // namespace

Result<JndFindings> analyse(const std::vector<std::string>& files) {
  JndFindings findings;
  std::vector<Measured> measured;
  for (const auto& name : files) {
    const auto logs = logs_in(name);
    if (!logs) return tl::make_unexpected(logs.error());
    for (const auto& log : *logs)
      if (auto added = add_file(log, findings, measured); !added)
        return tl::make_unexpected(added.error());
  }
  auto comparison = compare(measured);
  if (!comparison) {
    std::string why = comparison.error().what;
    for (const auto& sentence : findings.unfinished) why += "; " + sentence;
    return fail(Errc::bad_data, why);
  }
  findings.comparison = std::move(*comparison);
  return findings;
}

nlohmann::json to_json(const JndFindings& findings) {
  auto json = to_json(findings.comparison, "ms");
  json["unfinished"] = findings.unfinished;
  json["sessions"] = nlohmann::json::array();
  for (const auto& [subject, result] : findings.sessions)
    json["sessions"].push_back(
        {{"subject", subject},
         {"phase", result.is_training ? "training" : "test"},
         {"condition", kConditionNames[static_cast<std::size_t>(result.condition)]},
         {"trials", result.trials},
         {"jnd_ms", result.jnd_ms},
         {"mean_of_five_reversals_ms", result.mean_of_five_ms},
         {"fit_ms", result.fit.jnd_ms},
         {"fit_interval_ms", {result.fit.low_ms, result.fit.high_ms}},
         {"slope", result.fit.slope},
         {"lapse", result.fit.lapse}});
  return json;
}

std::string page_of(const JndFindings& findings, const std::string& heat) {
  std::string page(kHead);
  page +=
      "<p>The delay of light on a moving hand that people notice in 75 % of the comparisons with "
      "perfect light.</p>";
  page += fmt::format("<figure>{}</figure><pre>{}</pre>", bars_of(findings.comparison),
                      escaped(describe(findings.comparison, "ms")));
  if (!heat.empty())
    page += fmt::format(
        "<h2>Where they looked</h2><img src=\"{}\" alt=\"Places of the hand that "
        "subjects marked, by condition\">",
        escaped(heat));
  for (const auto& sentence : findings.unfinished)
    page += fmt::format("<p>{}</p>", escaped(sentence));
  return page + sessions_of(findings) + "</html>\n";
}

}  // namespace handcast::study
