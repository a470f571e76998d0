#include "supervisor/verbs.hpp"

#include <fmt/format.h>

#include <array>

#include "supervisor/exit.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::array kVerbs{
    VerbEntry{"up", "up RIG.toml [--set path=value]... [--seconds N] [--out DIR]",
              "Runs a rig until Ctrl-C, `handcast down` or N seconds; DIR gets live.json.", run_up},
    VerbEntry{"down", "down [--rig NAME]", "Stops a rig and waits until it has stopped.", run_down},
    VerbEntry{"status", "status [--json] [--rig NAME]", "Shows a rig's services, rates and times.", run_status},
    VerbEntry{"restart", "restart SERVICE [--rig NAME]", "Starts one service of a rig again.", run_restart},
    VerbEntry{"swap", "swap SERVICE BACKEND [--rig NAME]", "Gives one service another back end while the rest goes on.", run_swap},
    VerbEntry{"config", "config --print [FILE] | --check FILE | --reference [--set path=value]...",
              "Prints a whole rig file, checks one, or explains every setting.", run_config},
    VerbEntry{"simulate", "simulate ...", "Scores a rig in virtual time against its digital twin.", nullptr},
    VerbEntry{"report", "report ...", "Turns the results of runs into a report.", nullptr},
};

}  // namespace

std::span<const VerbEntry> verbs() { return kVerbs; }

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const auto& verb : kVerbs) names.emplace_back(verb.name);
  return names;
}

std::filesystem::path program_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

int complain(int exit_code, std::string_view sentence) {
  fmt::print(stderr, "handcast: {}\n", sentence);
  return exit_code;
}

int complain(const Error& error) { return complain(error.code == Errc::bad_config ? kExitConfig : kExitFailure, error.what); }

}  // namespace handcast::supervisor
