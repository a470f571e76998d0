// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/course.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "services/lab/twin/random.hpp"
#include "services/studies/base/latin_square.hpp"

namespace handcast::study {
namespace {

constexpr int kSessions = 4, kTraining = 2;

}  // namespace

Course::Course(const CourseSettings& settings) : settings_(settings) {
  const auto order =
      latin_order(static_cast<std::size_t>(settings.subject - 1), kConditionNames.size());
  for (std::size_t i = 0; i < conditions_.size(); ++i)
    conditions_[i] = static_cast<Condition>(order[i % order.size()]);
  begin_session();
}

void Course::begin_session() {
  number_ = 0;
  belief_ = PsychometricBelief();
  const auto subject = static_cast<std::uint64_t>(settings_.subject),
             which = 10 * subject + static_cast<std::uint64_t>(session_);
  procedure_ = make_procedure(settings_.procedure, settings_.seed ^ twin::mixed(which));
}

bool Course::is_late_first() const {
  const auto session = static_cast<std::uint64_t>(session_),
             trial = 1000 * session + static_cast<std::uint64_t>(number_),
             subject = static_cast<std::uint64_t>(settings_.subject);
  return twin::mixed(settings_.seed ^ twin::mixed(trial ^ twin::mixed(subject))) >> 63;
}

std::optional<Trial> Course::trial() const {
  if (session_ == kSessions) return {};
  return Trial{.session = session_,
               .is_training = session_ < kTraining,
               .condition = conditions_[static_cast<std::size_t>(session_)],
               .number = number_,
               .delay_ms = procedure_->next_ms(),
               .is_late_first = is_late_first()};
}

void Course::answer(const Answer& answer) {
  const auto asked = *trial();
  const bool is_correct = answer.picks_first == asked.is_late_first;
  belief_.learn(asked.delay_ms, is_correct);
  procedure_->answer(is_correct);
  ++number_;
  if (!procedure_->is_over()) return;
  const auto* stairs = dynamic_cast<const Staircase*>(procedure_.get());
  const double jnd_ms = procedure_->jnd_ms();
  results_.push_back(
      {.is_training = asked.is_training,
       .condition = asked.condition,
       .trials = number_,
       .jnd_ms = jnd_ms,
       .mean_of_five_ms = stairs ? std::optional(stairs->mean_of_five_ms()) : std::nullopt,
       .fit = belief_.estimate()});
  ++session_;
  begin_session();
}

CsvRow Course::columns() {
  return {"subject",     "seed",     "protocol",       "session",  "phase",  "condition",
          "trial",       "delay_ms", "late",           "stimulus", "answer", "correct",
          "reaction_ms", "repeats",  "worst_error_ms", "time"};
}

CsvRow Course::line(const Answer& answer, std::string_view time) const {
  const auto asked = *trial();
  const auto interval = [](bool is_first) { return is_first ? "1" : "2"; };
  return {fmt::format("{}", settings_.subject),
          fmt::format("{}", settings_.seed),
          std::string(kProcedureNames[static_cast<std::size_t>(settings_.procedure)]),
          fmt::format("{}", asked.session + 1),
          asked.is_training ? "training" : "test",
          std::string(kConditionNames[static_cast<std::size_t>(asked.condition)]),
          fmt::format("{}", asked.number + 1),
          fmt::format("{:.4f}", asked.delay_ms),
          interval(asked.is_late_first),
          settings_.stimulus,
          interval(answer.picks_first),
          answer.picks_first == asked.is_late_first ? "1" : "0",
          fmt::format("{:.1f}", answer.reaction_ms),
          fmt::format("{}", answer.repeats),
          fmt::format("{:.4f}", answer.worst_error_ms),
          std::string(time)};
}

Result<void> Course::replay(const StudyTable& log) {
  enum Column : std::size_t { kAnswer = 10, kReaction = 12, kRepeats, kError, kTime };
  for (std::size_t r = 0; r < log.rows.size(); ++r) {
    const auto& row = log.rows[r];
    Answer answer{.picks_first = row[kAnswer] == "1"};
    const auto reaction_ms = log.number(r, kReaction), error_ms = log.number(r, kError);
    const auto repeats = log.whole(r, kRepeats, 0, 1'000'000);
    for (const auto* number : {&reaction_ms, &error_ms})
      if (!*number) return tl::make_unexpected(number->error());
    if (!repeats) return tl::make_unexpected(repeats.error());
    answer.reaction_ms = *reaction_ms;
    answer.repeats = *repeats;
    answer.worst_error_ms = *error_ms;
    const auto expected = trial() ? line(answer, row[kTime]) : CsvRow();
    if (expected.empty() || !std::equal(row.begin(), row.begin() + kAnswer, expected.begin()))
      return fail(
          Errc::bad_data,
          fmt::format("{}: row {} does not follow from the rows before it; the log was made "
                      "with another seed, protocol or stimulus, or was changed",
                      log.name, r + 1));
    this->answer(answer);
  }
  return {};
}

}  // namespace handcast::study
