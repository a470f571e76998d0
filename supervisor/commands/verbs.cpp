// SPDX-License-Identifier: Apache-2.0
#include "supervisor/commands/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ipc/base/log.hpp"

namespace handcast::supervisor {
namespace {

using Group = VerbGroup;

constexpr std::array kVerbs{
    VerbEntry{"up", "Runs a rig until Ctrl-C or `handcast down`.", run_up, Group::run},
    VerbEntry{"play", "Runs a recorded rig with the recording in place of its sensors.", run_play,
              Group::run},
    VerbEntry{"down", "Stops a rig and waits until it has stopped.", run_down, Group::run},
    VerbEntry{"status", "Shows a rig's services, rates and times.", run_status, Group::look},
    VerbEntry{"restart", "Replaces one service of a rig by a new process.", run_restart,
              Group::change},
    VerbEntry{"swap", "Gives one service another back end.", run_swap, Group::change},
    VerbEntry{"reload",
              "Applies a changed rig file: replaces only the services whose settings changed.",
              run_reload, Group::change},
    VerbEntry{"content", "Shows or changes what is on the hands.", run_content, Group::change},
    VerbEntry{"desk", "Prints the address of the page that shows and works a rig.", run_desk,
              Group::change},
    VerbEntry{"set", "Changes settings at once, without a restart.", run_set, Group::change},
    VerbEntry{"get", "Shows the settings that `handcast set` changes.", run_get, Group::look},
    VerbEntry{"watch", "Prints every change of a setting, and who made it.", run_watch,
              Group::look},
    VerbEntry{"undo", "Takes the last change of a setting back.", run_undo, Group::change},
    VerbEntry{"save", "Keeps the changed settings for the next start of the rig.", run_save,
              Group::change},
    VerbEntry{"preset", "Shows, makes or loads a named set of settings.", run_preset,
              Group::change},
    VerbEntry{"blackout", "Switches all light off, or on again.", run_blackout, Group::change},
    VerbEntry{"freeze", "Lets the light stay as it is, or go on.", run_freeze, Group::change},
    VerbEntry{"master", "Sets or fades the light as a whole.", run_master, Group::change},
    VerbEntry{"lamp", "Turns the lamp of the projector on or off.", nullptr, Group::change},
    VerbEntry{"top", "Watches rings and services in the terminal.", run_top, Group::look},
    VerbEntry{"preview", "Shows what a rig sees and casts, in a window or as a picture.", nullptr,
              Group::look},
    VerbEntry{"record", "Writes all rings of a rig to a folder, which the back ends `replay` play.",
              nullptr, Group::look},
    VerbEntry{"day", "Prints the report of a day of the rig, and names its page.", nullptr,
              Group::look},
    VerbEntry{"latency", "Shows the time that each step took, from exposure to light.", run_latency,
              Group::look},
    VerbEntry{"trace", "Writes the last N seconds as a Perfetto trace.", run_trace, Group::look},
    VerbEntry{"install-units", "Writes a systemd unit that runs the rig.", run_install_units,
              Group::set_up},
    VerbEntry{"devices", "Lists what is attached, and what it would be called in a rig file.",
              nullptr, Group::set_up},
    VerbEntry{"init", "Asks what a rig is made of and writes its rig file.", nullptr,
              Group::set_up},
    VerbEntry{"calibrate",
              "Measures lenses, a second camera, projector and tracker of a rig and writes its "
              "calibration.",
              nullptr, Group::set_up},
    VerbEntry{"doctor", "Checks a rig, and the computer that runs it, before the show.", nullptr,
              Group::set_up},
    VerbEntry{"config", "Prints a complete rig file, checks one, or explains all settings.",
              run_config, Group::set_up},
    VerbEntry{"template", "Writes templates for the pictures that are cast on the hands.", nullptr,
              Group::set_up},
    VerbEntry{"gallery", "Shows looks on the moving hands of the digital twin, as a page.", nullptr,
              Group::look},
    VerbEntry{"study", "Runs studies and games with people, and analyses them.", nullptr,
              Group::score},
    VerbEntry{"simulate", "Scores a rig in virtual time against its digital twin.", nullptr,
              Group::score},
    VerbEntry{"sweep", "Scores a rig with all combinations of some settings, on all cores.",
              nullptr, Group::score},
    VerbEntry{"detect", "Finds the landmarks of the hands in pictures.", nullptr, Group::score},
    VerbEntry{"benchmark", "Scores methods, also one of your own, on a fixed set of cases.",
              nullptr, Group::score},
    VerbEntry{"export-twin", "Writes the images, times and truth of a motion of the twin.", nullptr,
              Group::score},
    VerbEntry{"chart", "Draws charts of sweeps: speed against accuracy, and limits of the methods.",
              nullptr, Group::score},
    VerbEntry{"report", "Turns the results of runs into a report.", nullptr, Group::score},
};

}  // namespace

std::span<const VerbEntry> verbs() { return kVerbs; }

const VerbEntry* find_verb(std::string_view name) {
  const auto found = std::ranges::find(kVerbs, name, &VerbEntry::name);
  return found == kVerbs.end() ? nullptr : &*found;
}

CommandLine command_line_of(std::string_view verb, std::string notes) {
  return {fmt::format("handcast {}", verb), std::string(find_verb(verb)->sentence),
          std::move(notes)};
}

void add_rig(CommandLine& line, std::string& rig) {
  line.add("--rig NAME", rig, "Which rig, if several are up");
}

int complain(int exit_code, std::string_view sentence) {
  log::put(log::for_journal(log::Level::error, fmt::format("handcast: {}\n", printable(sentence))));
  return exit_code;
}

int complain(const Error& error) { return complain(exit_code_of(error), error.what); }

}  // namespace handcast::supervisor
