// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"
#include "ipc/base/text.hpp"
#include "services/studies/base/page.hpp"
#include "services/studies/base/study_command.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kProtocol = 2, kStimulus = 9;

/// The settings that a log was made with, from its first row.
Result<CourseSettings> settings_of(const StudyTable& log) {
  CourseSettings settings;
  const auto subject = log.whole(0, 0, 1, kMostSubjects);
  if (!subject) return tl::make_unexpected(subject.error());
  const auto& seed = log.rows[0][1];
  const auto read = std::from_chars(seed.data(), seed.data() + seed.size(), settings.seed);
  const auto kind = std::ranges::find(kProcedureNames, log.rows[0][2]);
  if (read.ec != std::errc{} || kind == std::end(kProcedureNames))
    return fail(
        Errc::bad_data,
        fmt::format("{}: row 1 has subject {}, seed {} and protocol {}, which are not those "
                    "of a study",
                    log.name, quote(log.rows[0][0]), quote(seed), quote(log.rows[0][2])));
  settings.stimulus = log.rows[0][kStimulus];
  settings.subject = *subject;
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
  const auto way = log.rows[0][kProtocol] + ", " + settings->stimulus;
  if (!findings.way.empty() && findings.way != way)
    return fail(Errc::bad_data,
                fmt::format("{} was made with another protocol or stimulus ({}) than the logs "
                            "before it ({}); analyse them apart",
                            log.name, way, findings.way));
  findings.way = way;
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

std::string sessions_of(const JndFindings& findings) {
  if (findings.sessions.empty()) return "";
  std::string rows =
      "<h2>Sessions</h2><table><tr><th>Subject<th>Phase<th>Condition<th>Trials"
      "<th>JND<th>last five reversals<th>fit (95 %)</tr>";
  for (const auto& [subject, result] : findings.sessions)
    rows += fmt::format(
        "<tr><td>{}<td>{}<td>{}<td>{}<td>{:.2f}<td>{}<td>{:.2f} ({:.2f}…{:.2f})</tr>",
        html_of(subject), result.is_training ? "training" : "test",
        kConditionNames[static_cast<std::size_t>(result.condition)], result.trials, result.jnd_ms,
        result.mean_of_five_ms ? fmt::format("{:.2f}", *result.mean_of_five_ms) : "–",
        result.fit.jnd_ms, result.fit.low_ms, result.fit.high_ms);
  return rows +
         "</table><small>All in ms. Fit: a logistic psychometric function with lapses, from "
         "all answers of the session.</small>";
}

}  // namespace

Result<JndFindings> analyse(const std::vector<std::string>& files) {
  JndFindings findings;
  std::vector<Measured> measured;
  for (const auto& name : files) {
    const auto logs = logs_in(name, kSubjectLogs);
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
         {"mean_of_five_reversals_ms",
          result.mean_of_five_ms ? nlohmann::json(*result.mean_of_five_ms) : nlohmann::json()},
         {"fit_ms", result.fit.jnd_ms},
         {"fit_interval_ms", {result.fit.low_ms, result.fit.high_ms}},
         {"slope", result.fit.slope},
         {"lapse", result.fit.lapse}});
  return json;
}

std::string page_of(const JndFindings& findings, const std::string& heat) {
  std::string page = page_head("Just noticeable delay");
  page +=
      "<p>The delay of light on a moving hand that people notice in 75 % of the comparisons with "
      "perfect light.</p>";
  page += fmt::format("<figure>{}</figure><pre>{}</pre>", bars_of(findings.comparison, "ms"),
                      html_of(describe(findings.comparison, "ms")));
  if (!heat.empty())
    page += fmt::format(
        "<h2>Where they looked</h2><img src=\"{}\" alt=\"Places of the hand that "
        "subjects marked, by condition\">",
        html_of(heat));
  for (const auto& sentence : findings.unfinished)
    page += fmt::format("<p>{}</p>", html_of(sentence));
  return page + sessions_of(findings) + "</html>\n";
}

}  // namespace handcast::study
