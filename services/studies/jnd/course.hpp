// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/csv.hpp"
#include "ipc/base/result.hpp"
#include "services/studies/base/study_table.hpp"
#include "services/studies/jnd/procedure.hpp"

namespace handcast::study {

/// The late light that is compared with perfect light: as the projector sends it, or with the gaps
/// at the edges of the hand filled.
enum class Condition { baseline, fill };
inline constexpr std::array<std::string_view, 2> kConditionNames{"baseline", "fill"};

/// A comparison of two intervals with the same motion, of which one has late light.
struct Trial {
  int session = 0;  ///< 0 to 3
  bool is_training = false;
  Condition condition = Condition::baseline;
  int number = 0;  ///< in the session, from 0
  double delay_ms = 0;
  bool is_late_first = false;
};

/// What a subject answered.
struct Answer {
  bool picks_first = false;
  double reaction_ms = 0;  ///< from the end of the second interval
  /// What was shown: intervals that were shown again because a refresh was missed, and the farthest
  /// that a picture was from the refresh that it was drawn for.
  /// @{
  int repeats = 0;
  double worst_error_ms = 0;
  /// @}
};

/// The result of a session.
struct SessionResult {
  bool is_training = false;
  Condition condition = Condition::baseline;
  int trials = 0;
  double jnd_ms = 0;                      ///< by the procedure: of the staircase, the last delay
  std::optional<double> mean_of_five_ms;  ///< of a staircase: at its last five reversals
  PsychometricEstimate fit;               ///< from all answers
};

inline constexpr std::string_view kSubjectLogs = "subject";  ///< the kind of the logs: log_name()

/// What a course is made of.
struct CourseSettings {
  int subject = 1;  ///< 1 to kMostSubjects
  std::uint64_t seed = 1;
  ProcedureKind procedure = ProcedureKind::staircase;
  std::string stimulus;  ///< what is shown, in words: a course goes on with the same only
};

/// All that a subject does (Casper DPM, Just Noticeable Difference): a training and a test session
/// with each condition, in the order of a Latin square. The trials are a pure function of the
/// settings and the answers.
class Course {
 public:
  explicit Course(const CourseSettings& settings);

  /// The next trial; empty at the end.
  std::optional<Trial> trial() const;
  /// The answer to it.
  void answer(const Answer& answer);
  /// True if the next trial is the first of its session.
  bool begins_session() const { return number_ == 0; }
  /// Of the sessions that are over.
  const std::vector<SessionResult>& results() const { return results_; }

  /// The columns of the log of a subject, and its line for an answer to the present trial.
  /// @{
  static CsvRow columns();
  CsvRow line(const Answer& answer, std::string_view time) const;
  /// @}
  /// Gives the answers of an earlier log again. Errors: bad_data (a line is not what this course
  /// would have asked: it was made with other settings, or the file was changed).
  Result<void> replay(const StudyTable& log);

 private:
  bool is_late_first() const;
  void begin_session();

  CourseSettings settings_;
  std::array<Condition, 4> conditions_{};
  int session_ = 0, number_ = 0;
  std::unique_ptr<Procedure> procedure_;
  PsychometricBelief belief_;
  std::vector<SessionResult> results_;
};

}  // namespace handcast::study
