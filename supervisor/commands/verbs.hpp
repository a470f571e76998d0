// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/daemon/exit_code.hpp"

namespace handcast::supervisor {

using Arguments = std::vector<std::string>;  ///< what stands behind the verb

/// What a verb is for: `handcast help` lists them so.
enum class VerbGroup { run, look, change, set_up, score };

struct VerbEntry {
  std::string_view name;
  std::string_view usage;  ///< what stands behind "handcast "
  std::string_view sentence;
  int (*run)(const Arguments&);  ///< null: a program of its own, handcast-NAME
  VerbGroup group = VerbGroup::set_up;
};

/// Every verb of this installation.
std::span<const VerbEntry> verbs();

/// The folder of this program: where its daemons and other verbs are.
std::filesystem::path program_folder();
std::vector<std::string> verb_names();

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
