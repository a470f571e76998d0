// SPDX-License-Identifier: Apache-2.0
#include "services/studies/character/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "ipc/base/text.hpp"
#include "services/studies/base/latin_square.hpp"
#include "services/studies/base/page.hpp"

namespace handcast::study {
namespace {

enum Column : std::size_t {
  kSubject,
  kSeed,
  kHand,
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

CsvRow begin_line(const CharacterPlayer& player, const CharacterSession& session) {
  CsvRow row(kColumns);
  row[kSubject] = fmt::format("{}", player.subject);
  row[kSeed] = fmt::format("{}", player.seed);
  row[kHand] = player.hand == msg::Side::left ? "left" : "right";
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
        html_of(findings.seconds.conditions[c]));
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
  sessions.reserve(std::size_t{kCharacterTraining} + static_cast<std::size_t>(tests));
  for (int number = 0; number < kCharacterTraining + tests; ++number)
    sessions.push_back({.number = number,
                        .is_training = number < kCharacterTraining,
                        .is_corrected = order[static_cast<std::size_t>(number % 2)] == 1,
                        .face = number / 2 % 2 == 0 ? Face::palm : Face::back});
  return sessions;
}

std::vector<std::string> settings_of(bool is_corrected) {
  std::vector<std::string> assignments;
  assignments.reserve(8);
  for (const char* assignment : {"cascade.predict.method=velocity", "cascade.predict.still_mm_s=0",
                                 "cascade.ladder.rung=landmarks", "cascade.skin.fit=false",
                                 "cascade.filter.method=none", "cascade.correct.method=none",
                                 "cascade.register.method=none", "cascade.fill.method=none"}) {
    const std::string text(assignment);
    assignments.push_back(is_corrected ? text.substr(0, text.find('=')) : text);
  }
  return assignments;
}

CsvRow character_columns() {
  return {"subject", "seed", "hand",  "session", "phase",   "condition", "face",
          "round",   "palm", "asked", "picked",  "correct", "seconds",   "difficulty"};
}

CsvRow line_of(const CharacterPlayer& player, const CharacterSession& session, int round,
               const CharacterRound& answer) {
  auto row = begin_line(player, session);
  row[kRound] = fmt::format("{}", round);
  row[kPalm] = std::string(1, answer.palm);
  row[kAsked] = fmt::format("{}", answer.asked + 1);
  row[kPicked] = fmt::format("{}", answer.picked + 1);
  row[kCorrect] = answer.is_correct() ? "1" : "0";
  row[kSeconds] = fmt::format("{:.3f}", answer.seconds);
  return row;
}

CsvRow line_of(const CharacterPlayer& player, const CharacterSession& session, int difficulty) {
  auto row = begin_line(player, session);
  row[kRound] = "0";
  row[kDifficulty] = fmt::format("{}", difficulty);
  return row;
}

Result<void> check_player(const StudyTable& log, const CharacterPlayer& player) {
  const auto ours = begin_line(player, {});
  for (const auto& row : log.rows)
    if (row[kSeed] != ours[kSeed] || row[kHand] != ours[kHand])
      return fail(Errc::bad_config,
                  fmt::format("{}: the log was made with --seed {} --hand {}; give the same, or "
                              "another subject or folder",
                              log.name, row[kSeed], row[kHand]));
  return {};
}

int sessions_done(const StudyTable& log) {
  return static_cast<int>(
      std::ranges::count_if(log.rows, [](const auto& row) { return row[kRound] == "0"; }));
}

namespace {

/// The rounds of sessions that are over, as they are compared.
struct Rounds {
  std::vector<Measured> by_subject, by_pair;
  std::map<std::string, std::array<int, 2>> answers;  ///< by condition: right ones, all
  std::map<std::string, std::array<int, 5>> difficulty;

  /// A session that was begun anew counts from its last beginning on, and one without its last
  /// line does not count.
  Result<void> add(const StudyTable& log) {
    std::vector<std::size_t> begun;
    for (std::size_t r = 0; r < log.rows.size(); ++r) {
      const auto& row = log.rows[r];
      if (row[kPhase] == "training") continue;
      if (row[kRound] == "1") begun.clear();
      if (row[kRound] != "0") {
        begun.push_back(r);
        continue;
      }
      const auto answer = log.whole(r, kDifficulty, 1, 5);
      if (!answer) return tl::make_unexpected(answer.error());
      ++difficulty[row[kCondition]][static_cast<std::size_t>(*answer) - 1];
      for (const std::size_t round : begun)
        if (auto added = add_round(log, round); !added) return added;
      begun.clear();
    }
    return {};
  }

 private:
  Result<void> add_round(const StudyTable& log, std::size_t r) {
    const auto& row = log.rows[r];
    const auto seconds = log.number(r, kSeconds);
    if (!seconds) return tl::make_unexpected(seconds.error());
    const auto session = log.whole(r, kSession, 1, 1000);
    if (!session) return tl::make_unexpected(session.error());
    // Sessions follow in pairs with both methods: they are compared with each other.
    const int pair = (*session - 1) / 2;
    by_subject.push_back({row[kSubject], row[kCondition], *seconds});
    by_pair.push_back({fmt::format("{}/{}", row[kSubject], pair), row[kCondition], *seconds});
    answers[row[kCondition]][0] += row[kCorrect] == "1";
    ++answers[row[kCondition]][1];
    return {};
  }
};

/// The log with the columns of today: once, there were no seed and no hand.
Result<StudyTable> as_today(StudyTable log) {
  auto earlier = character_columns();
  earlier.erase(earlier.begin() + kSeed, earlier.begin() + kHand + 1);
  if (log.columns == earlier) {
    log.columns = character_columns();
    for (auto& row : log.rows) row.insert(row.begin() + kSeed, 2, "");
  }
  if (log.columns == character_columns()) return log;
  return fail(Errc::bad_data, fmt::format("{}: the file is no log of this game", log.name));
}

}  // namespace

Result<CharacterFindings> analyse_characters(const std::vector<StudyTable>& logs) {
  Rounds rounds;
  for (const auto& log : logs) {
    const auto today = as_today(log);
    if (!today) return tl::make_unexpected(today.error());
    if (auto added = rounds.add(*today); !added) return tl::make_unexpected(added.error());
  }
  auto by_subject = compare(rounds.by_subject), by_pair = compare(rounds.by_pair);
  if (!by_subject) return tl::make_unexpected(by_subject.error());
  if (!by_pair) return tl::make_unexpected(by_pair.error());
  CharacterFindings findings{.seconds = std::move(*by_subject),
                             .pairs = std::move(*by_pair),
                             .accuracy = {},
                             .difficulty = {}};
  for (const auto& condition : findings.seconds.conditions) {
    const auto& [right, all] = rounds.answers[condition];
    findings.accuracy.push_back(static_cast<double>(right) / all);
    findings.difficulty.push_back(rounds.difficulty[condition]);
  }
  return findings;
}

nlohmann::json to_json(const CharacterFindings& findings) {
  auto json = to_json(findings.seconds, "s");
  json["pairs"] = to_json(findings.pairs, "s");
  for (std::size_t c = 0; c < findings.accuracy.size(); ++c) {
    auto& condition = json["conditions"][findings.seconds.conditions[c]];
    condition["accuracy"] = findings.accuracy[c];
    condition["difficulty"] = findings.difficulty[c];
  }
  return json;
}

std::string page_of(const CharacterFindings& findings) {
  std::string page = page_head("Guess the Character");
  page += "<p>The mean time of a round by subject, in seconds.</p>";
  page += fmt::format(
      "<figure>{}</figure><pre>{}\nBy pair of sessions that follow each other, as in the paper. "
      "The "
      "test takes each pair for a subject of its own, so its p is too small:\n{}",
      bars_of(findings.seconds, "s"), html_of(describe(findings.seconds, "s")),
      html_of(describe(findings.pairs, "s")));
  for (std::size_t c = 0; c < findings.accuracy.size(); ++c)
    page += fmt::format("{}: {:.1f} % of the answers are right\n",
                        html_of(findings.seconds.conditions[c]), 100 * findings.accuracy[c]);
  return page + "</pre>" + difficulties_of(findings) + "</html>\n";
}

}  // namespace handcast::study
