// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The arguments after the verb.
using Arguments = std::vector<std::string>;

/// The purpose of a verb. `handcast help` lists the verbs by group.
enum class VerbGroup { run, look, change, set_up, score };

/// A row of the table of verbs.
struct VerbEntry {
  std::string_view name;                ///< "up"
  std::string_view sentence;            ///< its purpose
  int (*run)(const Arguments&);         ///< its function; null: the program handcast-NAME
  VerbGroup group = VerbGroup::set_up;  ///< its group
};

/// All verbs.
std::span<const VerbEntry> verbs();
/// The row of a verb; null if there is no such verb.
const VerbEntry* find_verb(std::string_view name);

/// The command line of a verb of the table, still without arguments.
CommandLine command_line_of(std::string_view verb, std::string notes = "");
/// Declares --rig.
void add_rig(CommandLine& line, std::string& rig);
/// The range of --seconds, which fits into an int64 of nanoseconds.
inline constexpr CommandLine::Range kSomeSeconds{0.001, 1e9};

/// Runs a verb. Returns an exit code (ipc/base/exit_code.hpp).
/// @{
int run_up(const Arguments& arguments);
int run_play(const Arguments& arguments);
int run_config(const Arguments& arguments);
int run_down(const Arguments& arguments);
int run_status(const Arguments& arguments);
int run_restart(const Arguments& arguments);
int run_swap(const Arguments& arguments);
int run_reload(const Arguments& arguments);
int run_trace(const Arguments& arguments);
int run_latency(const Arguments& arguments);
int run_content(const Arguments& arguments);
int run_desk(const Arguments& arguments);
int run_set(const Arguments& arguments);
int run_get(const Arguments& arguments);
int run_watch(const Arguments& arguments);
int run_undo(const Arguments& arguments);
int run_save(const Arguments& arguments);
int run_preset(const Arguments& arguments);
int run_blackout(const Arguments& arguments);
int run_freeze(const Arguments& arguments);
int run_master(const Arguments& arguments);
int run_top(const Arguments& arguments);
int run_install_units(const Arguments& arguments);
/// @}

/// Prints "handcast: sentence" to stderr and returns the exit code.
int complain(int exit_code, std::string_view sentence);
/// The same with the sentence and the exit code of an error.
int complain(const Error& error);

}  // namespace handcast::supervisor
