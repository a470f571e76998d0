// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/studies/base/comparison.hpp"
#include "services/studies/base/hand_layout.hpp"
#include "services/studies/base/study_table.hpp"
#include "services/studies/character/game.hpp"

namespace handcast::study {

/// A session of Guess the Character.
struct CharacterSession {
  int number = 0;  ///< from 0
  bool is_training = false;
  bool is_corrected = false;  ///< by the cascade of the rig; else the tracker's hand is drawn
  Face face = Face::back;
};
inline constexpr int kCharacterTraining = 4;

/// The sessions of a subject: four for training, then `tests` with both methods in turn, whose
/// first is that of a Latin square. The hand is turned over behind every two, so that each method
/// meets both faces.
std::vector<CharacterSession> character_sessions(int subject, int tests);

/// The settings that switch all corrections off, as config/rigs/baseline.toml does, and those that
/// leave the rig as its file has it.
std::vector<std::string> settings_of(bool is_corrected);

/// Who plays, with which hand and which random numbers.
struct CharacterPlayer {
  int subject = 1;
  std::uint64_t seed = 1;
  msg::Side hand = msg::Side::left;
};

/// The log of a subject: a line for each round, and one with round 0 for the question of difficulty
/// at the end of a session, without which a session is not over.
/// @{
CsvRow character_columns();
CsvRow line_of(const CharacterPlayer& player, const CharacterSession& session, int round,
               const CharacterRound& answer);
CsvRow line_of(const CharacterPlayer& player, const CharacterSession& session, int difficulty);
/// @}
/// Whether a log may be gone on with. Errors: bad_config (it has another seed or hand).
Result<void> check_player(const StudyTable& log, const CharacterPlayer& player);
/// How many sessions of a log are over.
int sessions_done(const StudyTable& log);

/// What was found in logs, without training.
struct CharacterFindings {
  /// The mean time of a round: by subject, and by pair of sessions of a subject as in the paper.
  /// @{
  Comparison seconds, pairs;
  /// @}
  std::vector<double> accuracy;  ///< share of right answers, by condition
  /// By condition and difficulty 1 to 5: how many sessions.
  std::vector<std::array<int, 5>> difficulty;
};
/// Also of logs without seed and hand, as they were once. Errors: bad_data (no log, a line that is
/// none of the game).
Result<CharacterFindings> analyse_characters(const std::vector<StudyTable>& logs);
nlohmann::json to_json(const CharacterFindings& findings);
std::string page_of(const CharacterFindings& findings);

/// `handcast study character`. Returns the exit code.
int run_character(int argc, char** argv);

}  // namespace handcast::study
