// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/verbs.hpp"

#include <fmt/format.h>

#include <array>

namespace handcast::supervisor {
namespace {

using Group = VerbGroup;

constexpr std::array kVerbs{
    VerbEntry{"up", "up RIG.toml [--set path=value]... [--seconds N] [--out DIR] [--no-keeper]",
              "Runs a rig until Ctrl-C, `handcast down` or N seconds; writes DIR/live.json. "
              "--no-keeper: for systemd.",
              run_up, Group::run},
    VerbEntry{"down", "down [--rig NAME]", "Stops a rig and waits until it has stopped.", run_down,
              Group::run},
    VerbEntry{"status", "status [--json] [--rig NAME]", "Shows a rig's services, rates and times.",
              run_status, Group::look},
    VerbEntry{"restart", "restart SERVICE [--rig NAME]", "Starts one service of a rig again.",
              run_restart, Group::change},
    VerbEntry{"swap", "swap SERVICE BACKEND [--rig NAME]",
              "Restarts one service with another back end.", run_swap, Group::change},
    VerbEntry{"reload", "reload [--rig NAME]",
              "Applies a changed rig file: restarts only the services whose settings changed.",
              run_reload, Group::change},
    VerbEntry{"top", "top [--rig NAME] [--once] [--json]",
              "Watches rings and services in the terminal.", run_top, Group::look},
    VerbEntry{"latency", "latency [--seconds N] [--json] [--rig NAME]",
              "Shows the time that each step took, from exposure to light.", run_latency,
              Group::look},
    VerbEntry{"trace", "trace [--seconds N] -o FILE [--rig NAME]",
              "Writes the last N seconds as a Perfetto trace.", run_trace, Group::look},
    VerbEntry{"install-units", "install-units RIG.toml [--set path=value]... [--system] [--print]",
              "Writes a systemd unit that runs the rig.", run_install_units},
    VerbEntry{"config", "config --print [FILE] | --check FILE | --reference [--set path=value]...",
              "Prints a complete rig file, checks one, or explains all settings.", run_config},
    VerbEntry{"simulate", "simulate ...", "Scores a rig in virtual time against its digital twin.",
              nullptr, Group::score},
    VerbEntry{"sweep", "sweep ...",
              "Scores a rig with all combinations of some settings, on all cores.", nullptr,
              Group::score},
    VerbEntry{"detect", "detect ...", "Finds the landmarks of the hands in pictures.", nullptr,
              Group::look},
    VerbEntry{"chart", "chart RESULTS.csv... [--out DIR]",
              "Draws charts of sweeps: speed against accuracy, and limits of the methods.", nullptr,
              Group::score},
    VerbEntry{"report", "report ...", "Turns the results of runs into a report.", nullptr,
              Group::score},
};

}  // namespace

std::span<const VerbEntry> verbs() { return kVerbs; }

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const auto& verb : kVerbs) names.emplace_back(verb.name);
  return names;
}

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

int complain(int exit_code, std::string_view sentence) {
  fmt::print(stderr, "handcast: {}\n", sentence);
  return exit_code;
}

int complain(const Error& error) { return complain(exit_code_of(error), error.what); }

}  // namespace handcast::supervisor
