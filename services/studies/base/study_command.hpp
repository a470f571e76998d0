// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/studies/base/study_table.hpp"

/// What the commands of all studies do alike.
namespace handcast::study {

/// Persons have numbers from 1 to this instead of names.
inline constexpr int kMostSubjects = 999;

/// Declares --rig and --hand.
void add_rig_hand(CommandLine& line, std::string& rig, msg::Side& side);

/// "KIND-NN.csv", the log of a person.
std::string log_name(std::string_view kind, int person);
/// The logs of that kind in a folder, in order, or the file that is no folder. Errors: bad_config
/// (a folder without logs).
Result<std::vector<std::filesystem::path>> logs_in(const std::string& name, std::string_view kind);
/// Reads all of them. Errors: those of logs_in() and read_study_table().
Result<std::vector<StudyTable>> read_logs(const std::vector<std::string>& names,
                                          std::string_view kind);

/// Writes results; nothing if `file` is empty. Errors: those of write_whole().
Result<void> write_json(const std::string& file, const nlohmann::json& json);
/// Writes FOLDER/index.html, and creates the folder. Returns the file. Errors: as write_json().
Result<std::filesystem::path> write_page(const std::filesystem::path& folder,
                                         std::string_view html);

/// Prints what was done, or the error. Returns the exit code.
int end_of(std::string_view command, const Result<std::string>& done);

}  // namespace handcast::study
