// SPDX-License-Identifier: Apache-2.0
#include "services/studies/character/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "services/studies/base/latin_square.hpp"
#include "services/studies/base/page.hpp"

namespace handcast::study {
namespace {

enum Column : std::size_t {
  kSubject,
  kSession,
  kPhase,
  kCondition,
  kFace,
  kRound,
  kPalm,
  kAsked,
  kPicked,
  kCorrect,
  kSeconds,
  kDifficulty,
  kColumns
};
constexpr std::array kConditions{"baseline", "corrected"};

CsvRow begin_line(int subject, const CharacterSession& session) {
  CsvRow row(kColumns);
  row[kSubject] = fmt::format("{}", subject);
  row[kSession] = fmt::format("{}", session.number + 1);
  row[kPhase] = session.is_training ? "training" : "test";
  row[kCondition] = kConditions[session.is_corrected];
  row[kFace] = session.face == Face::palm ? "palm" : "back";
  return row;
}

/// Bars that show how often each difficulty was named, stacked.
std::string difficulties_of(const CharacterFindings& findings) {
  std::string rows;
  for (std::size_t c = 0; c < findings.difficulty.size(); ++c) {
    int all = 0, before = 0;
    for (const int count : findings.difficulty[c]) all += count;
    rows += fmt::format(
        "<tr><td>{}<td><svg viewBox=\"0 0 500 22\" role=\"img\" aria-label=\"answers 1 "
        "to 5\">",
        escaped(findings.seconds.conditions[c]));
    for (std::size_t d = 0; d < 5; ++d) {
      const int count = findings.difficulty[c][d];
      if (count == 0) continue;
      rows += fmt::format(
          "<rect x=\"{:.1f}\" width=\"{:.1f}\" height=\"22\" fill=\"hsl({} 55% 45%)\">"
          "<title>{}: {} sessions</title></rect>",
          500.0 * before / all, 500.0 * count / all, 140 - 30 * static_cast<int>(d), d + 1, count);
      before += count;
    }
    rows += "</svg>";
  }
  return "<h2>How difficult was the task?</h2><table class=\"wide\">" + rows +
         "</table><small>From easy (1, left) to hard (5, right), sessions.</small>";
}

}  // namespace

std::vector<CharacterSession> character_sessions(int subject, int tests) {
  const auto order = latin_order(static_cast<std::size_t>(subject - 1), 2);
  std::vector<CharacterSession> sessions;
  for (int number = 0; number < kCharacterTraining + tests; ++number)
    sessions.push_back({.number = number,
                        .is_training = number < kCharacterTraining,
                        .is_corrected = order[static_cast<std::size_t>(number % 2)] == 1,
                        .face = number / 2 % 2 == 0 ? Face::palm : Face::back});
  return sessions;
}

std::vector<std::string> settings_of(bool is_corrected) {
  std::vector<std::string> assignments;
  for (const char* assignment :
       {"cascade.skin.fit=false", "cascade.filter.method=none", "cascade.correct.method=none",
        "cascade.register.method=none", "cascade.fill.method=none"}) {
    const std::string text(assignment);
    assignments.push_back(is_corrected ? text.substr(0, text.find('=')) : text);
  }
  return assignments;
}

CsvRow character_columns() {
  return {"subject", "session", "phase",  "condition", "face",    "round",
          "palm",    "asked",   "picked", "correct",   "seconds", "difficulty"};
}

CsvRow line_of(int subject, const CharacterSession& session, int round,
               const CharacterRound& answer) {
  auto row = begin_line(subject, session);
  row[kRound] = fmt::format("{}", round);
  row[kPalm] = std::string(1, answer.palm);
  row[kAsked] = fmt::format("{}", answer.asked + 1);
  row[kPicked] = fmt::format("{}", answer.picked + 1);
  row[kCorrect] = answer.is_correct() ? "1" : "0";
  row[kSeconds] = fmt::format("{:.3f}", answer.seconds);
  return row;
}

CsvRow line_of(int subject, const CharacterSession& session, int difficulty) {
  auto row = begin_line(subject, session);
  row[kRound] = "0";
  row[kDifficulty] = fmt::format("{}", difficulty);
  return row;
}

int sessions_done(const StudyTable& log) {
  return static_cast<int>(
      std::ranges::count_if(log.rows, [](const auto& row) { return row[kRound] == "0"; }));
}

Result<CharacterFindings> analyse_characters(const std::vector<StudyTable>& logs) {
  std::vector<Measured> measured;
  std::map<std::string, std::array<int, 2>> answers;  // right ones, all
  std::map<std::string, std::array<int, 5>> difficulty;
  for (const auto& log : logs) {
    if (log.columns != character_columns())
      return fail(Errc::bad_data, fmt::format("{}: the file is no log of this game", log.name));
    for (std::size_t r = 0; r < log.rows.size(); ++r) {
      const auto& row = log.rows[r];
      if (row[kPhase] == "training") continue;
      const auto number = log.number(r, row[kRound] == "0" ? kDifficulty : kSeconds),
                 session = log.number(r, kSession);
      if (!number || !session)
        return tl::make_unexpected(!number ? number.error() : session.error());
      if (row[kRound] == "0") {
        if (*number >= 1 && *number <= 5)
          ++difficulty[row[kCondition]][static_cast<std::size_t>(*number) - 1];
        continue;
      }
      // Sessions follow in pairs with both methods: they are compared with each other.
      const int pair = (static_cast<int>(*session) - 1) / 2;
      measured.push_back({fmt::format("{}/{}", row[kSubject], pair), row[kCondition], *number});
      answers[row[kCondition]][0] += row[kCorrect] == "1";
      ++answers[row[kCondition]][1];
    }
  }
  auto seconds = compare(measured);
  if (!seconds) return tl::make_unexpected(seconds.error());
  CharacterFindings findings{.seconds = std::move(*seconds), .accuracy = {}, .difficulty = {}};
  for (const auto& condition : findings.seconds.conditions) {
    findings.accuracy.push_back(static_cast<double>(answers[condition][0]) / answers[condition][1]);
    findings.difficulty.push_back(difficulty[condition]);
  }
  return findings;
}

nlohmann::json to_json(const CharacterFindings& findings) {
  auto json = to_json(findings.seconds, "s");
  for (std::size_t c = 0; c < findings.accuracy.size(); ++c) {
    auto& condition = json["conditions"][findings.seconds.conditions[c]];
    condition["accuracy"] = findings.accuracy[c];
    condition["difficulty"] = findings.difficulty[c];
  }
  return json;
}

std::string page_of(const CharacterFindings& findings) {
  std::string page = page_head("Guess the Character");
  page += "<p>The time of a round, by pair of sessions that follow each other, in seconds.</p>";
  page += fmt::format("<figure>{}</figure><pre>{}", bars_of(findings.seconds, "s"),
                      escaped(describe(findings.seconds, "s")));
  for (std::size_t c = 0; c < findings.accuracy.size(); ++c)
    page += fmt::format("{}: {:.1f} % of the answers are right\n",
                        escaped(findings.seconds.conditions[c]), 100 * findings.accuracy[c]);
  return page + "</pre>" + difficulties_of(findings) + "</html>\n";
}

}  // namespace handcast::study
