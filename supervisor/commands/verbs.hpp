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

/// What follows the verb on the command line.
using Arguments = std::vector<std::string>;

/// What a verb is for. `handcast help` lists the verbs by group.
enum class VerbGroup { run, look, change, set_up, score };

/// A verb as `handcast help` describes it.
struct VerbEntry {
  std::string_view name;
  std::string_view usage;  ///< what follows "handcast "
  std::string_view sentence;
  int (*run)(const Arguments&);  ///< null: a program of its own, handcast-NAME
  VerbGroup group = VerbGroup::set_up;
};

/// Every verb.
std::span<const VerbEntry> verbs();
/// Their names.
std::vector<std::string> verb_names();

/// The folder of this program, which also holds the daemons and the verbs that are programs.
std::filesystem::path program_folder();

// The verbs of this program. Each returns an exit code (ipc/base/exit_code.hpp).

int run_up(const Arguments& arguments);
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

/// Prints "handcast: sentence" and returns the exit code.
int complain(int exit_code, std::string_view sentence);
/// The same with the error's sentence and exit code.
int complain(const Error& error);

}  // namespace handcast::supervisor
