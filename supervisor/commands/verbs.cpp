// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/verbs.hpp"

#include <fmt/format.h>

#include <array>

#include "ipc/base/log.hpp"

namespace handcast::supervisor {
namespace {

using Group = VerbGroup;

constexpr std::string_view kRig = "  --rig NAME   which rig, if several are up\n";

constexpr std::array kVerbs{
    VerbEntry{
        "up", "up RIG.toml [--set path=value]... [--seconds N] [--out DIR] [--no-keeper]",
        "Runs a rig until Ctrl-C or `handcast down`.", run_up, Group::run,
        "  --set path=value   a setting that overrides that of the file; may be repeated\n"
        "  --seconds N        stops after N seconds\n"
        "  --out DIR          where files to be kept go: live.json with the times of all steps,\n"
        "                     observer.json with the scores, pictures\n"
        "  --no-keeper        without the process that replaces a dead supervisor; systemd does\n"
        "                     that for a unit of install-units\n"},
    VerbEntry{
        "play", "play DIR [--set path=value]... [--seconds N] [--out DIR]",
        "Runs a recorded rig with the recording in place of its sensors.", run_play, Group::run,
        "  DIR                a folder of `handcast record`; played in a loop, with the rig's\n"
        "                     settings and calibration. Streams that were not recorded come\n"
        "                     from the rig's own sensors\n"
        "  --set path=value   as for `handcast up`: projector.backend=file where there is no\n"
        "                     projector\n"
        "  --seconds N        stops after N seconds\n"
        "  --out DIR          as for `handcast up`\n"},
    VerbEntry{"down", "down [--rig NAME]", "Stops a rig and waits until it has stopped.", run_down,
              Group::run, kRig},
    VerbEntry{"status", "status [--json] [--rig NAME]", "Shows a rig's services, rates and times.",
              run_status, Group::look,
              "  --json       the same as JSON\n"
              "  --rig NAME   which rig, if several are up\n"},
    VerbEntry{"restart", "restart SERVICE [--rig NAME]",
              "Replaces one service of a rig by a new process.", run_restart, Group::change, kRig},
    VerbEntry{
        "swap", "swap SERVICE BACKEND [--rig NAME]", "Gives one service another back end.",
        run_swap, Group::change,
        "  SERVICE      as `handcast status` lists it\n"
        "  BACKEND      config/REFERENCE.md lists them; a wrong word prints those of the service\n"
        "  --rig NAME   which rig, if several are up\n"},
    VerbEntry{"reload", "reload [--rig NAME]",
              "Applies a changed rig file: replaces only the services whose settings changed.",
              run_reload, Group::change, kRig},
    VerbEntry{"top", "top [--rig NAME] [--once] [--json]",
              "Watches rings and services in the terminal.", run_top, Group::look,
              "  --once       prints one look and ends\n"
              "  --json       prints one look as JSON\n"
              "  --rig NAME   which rig, if several are up\n"},
    VerbEntry{"preview", "preview [--rig NAME] [--shot FILE.png] [--after S] [--layers LIST]",
              "Shows what a rig sees and casts, in a window or as a picture.", nullptr,
              Group::look},
    VerbEntry{"record", "record DIR [--rig NAME] [--seconds N] [--rings LIST] [--npy]",
              "Writes all rings of a rig to a folder, which the back ends `replay` play.", nullptr,
              Group::look},
    VerbEntry{"latency", "latency [--seconds N] [--json] [--rig NAME]",
              "Shows the time that each step took, from exposure to light.", run_latency,
              Group::look,
              "  --seconds N  of the last N seconds (default 10); supervisor.history_s are kept\n"
              "  --json       the same as JSON\n"
              "  --rig NAME   which rig, if several are up\n"},
    VerbEntry{"trace", "trace [--seconds N] -o FILE [--rig NAME]",
              "Writes the last N seconds as a Perfetto trace.", run_trace, Group::look,
              "  --seconds N  the last N seconds (default 10); supervisor.history_s are kept\n"
              "  -o FILE      the file to write; ui.perfetto.dev opens it\n"
              "  --rig NAME   which rig, if several are up\n"},
    VerbEntry{"install-units",
              "install-units RIG.toml [--set path=value]... [--out DIR] [--system [--user NAME]] "
              "[--print]",
              "Writes a systemd unit that runs the rig.", run_install_units, Group::set_up,
              "  --set path=value   as for `handcast up`\n"
              "  --out DIR          as for `handcast up`; default: a folder of the unit, "
              "/var/lib/handcast/NAME\n"
              "                     with --system\n"
              "  --system           a unit of the machine instead of one of this user\n"
              "  --user NAME        the user as which it runs; default: the one who calls sudo\n"
              "  --print            prints the unit and writes nothing\n"},
    VerbEntry{"devices", "devices [--json] [--leap-calibration FILE]",
              "Lists what is attached, and what it would be called in a rig file.", nullptr,
              Group::set_up},
    VerbEntry{"init", "init [RIG.toml] [--yes] [--force] ...",
              "Asks what a rig is made of and writes its rig file.", nullptr, Group::set_up},
    VerbEntry{"calibrate", "calibrate RIG.toml [STEP...] [--check] [--print-board FILE.pdf] ...",
              "Measures lenses, a second camera, projector and tracker of a rig and writes its "
              "calibration.",
              nullptr, Group::set_up},
    VerbEntry{"doctor", "doctor RIG.toml [--set path=value]... [--seconds N] [--json]",
              "Checks a rig, and the computer that runs it, before the show.", nullptr,
              Group::set_up},
    VerbEntry{
        "config",
        "config --print [FILE] [--set path=value]... | --check FILE [--set "
        "path=value]... | --reference",
        "Prints a complete rig file, checks one, or explains all settings.", run_config,
        Group::set_up,
        "  --print      all settings, with defaults where FILE has none\n"
        "  --check      what `handcast up` would refuse: settings, back ends, and the files that\n"
        "               the services open; devices, outputs and ports are not opened\n"
        "  --reference  the page config/REFERENCE.md\n"},
    VerbEntry{"template", "template DIR [--rig RIG.toml] [--width PX]",
              "Writes templates for the pictures that are cast on the hands.", nullptr,
              Group::set_up},
    VerbEntry{"simulate", "simulate ...", "Scores a rig in virtual time against its digital twin.",
              nullptr, Group::score},
    VerbEntry{"sweep", "sweep ...",
              "Scores a rig with all combinations of some settings, on all cores.", nullptr,
              Group::score},
    VerbEntry{"detect", "detect ...", "Finds the landmarks of the hands in pictures.", nullptr,
              Group::score},
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
  names.reserve(kVerbs.size());
  for (const auto& verb : kVerbs) names.emplace_back(verb.name);
  return names;
}

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

int complain(int exit_code, std::string_view sentence) {
  log::put(log::for_journal(log::Level::error, fmt::format("handcast: {}\n", printable(sentence))));
  return exit_code;
}

int complain(const Error& error) { return complain(exit_code_of(error), error.what); }

}  // namespace handcast::supervisor
