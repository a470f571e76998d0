// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
  std::string_view usage;               ///< the command line after "handcast "
  std::string_view sentence;            ///< its purpose, for `handcast help`
  int (*run)(const Arguments&);         ///< its function; null: the program handcast-NAME
  VerbGroup group = VerbGroup::set_up;  ///< its group
  std::string_view options{};           ///< one line per option, for `handcast help VERB`
};

/// All verbs.
std::span<const VerbEntry> verbs();
/// The names of all verbs.
std::vector<std::string> verb_names();

/// The folder of this program, which also holds the daemons and the verbs that are programs.
std::filesystem::path program_folder();

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
int run_top(const Arguments& arguments);
int run_install_units(const Arguments& arguments);
/// @}

/// Prints "handcast: sentence" to stderr and returns the exit code.
int complain(int exit_code, std::string_view sentence);
/// The same with the sentence and the exit code of an error.
int complain(const Error& error);

}  // namespace handcast::supervisor
