// SPDX-License-Identifier: Apache-2.0
// handcast doctor: whether a rig, and the computer that runs it, are fit for a show.
#include <fmt/format.h>

#include <iterator>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/control/rig_address.hpp"
#include "services/tools/doctor/devices.hpp"
#include "services/tools/doctor/display.hpp"
#include "services/tools/doctor/lamp.hpp"
#include "services/tools/doctor/live.hpp"
#include "services/tools/doctor/machine.hpp"
#include "services/tools/doctor/pauses.hpp"
#include "services/tools/doctor/real_time.hpp"
#include "services/tools/doctor/rig_file.hpp"
#include "services/tools/doctor/start_check.hpp"
#include "services/tools/doctor/tracker.hpp"

namespace handcast::doctor {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> settings;
  double seconds = 5;
  bool as_json = false;
};

/// The findings about a running rig; one finding if it is not up.
std::vector<Finding> findings_of(Result<std::vector<Finding>> live) {
  if (live) return std::move(*live);
  return {
      {"rig", Grade::advice,
       "it was not watched, so nothing is known of cameras, hands and light: " + live.error().what,
       "start it with `handcast up`, and call the doctor again"}};
}

std::vector<Finding> rigs_of_others() {
  std::vector<Finding> findings;
  for (const auto& rig : control::rigs_of_others())
    findings.push_back({"other users", Grade::advice, rig,
                        "stop it if it uses the same camera, tracker or projector"});
  return findings;
}

std::vector<Finding> examine(const Options& options) {
  const auto rig = config::load_rig(options.file, options.settings);
  auto findings = examine_file(rig);
  if (!rig) return findings;
  auto live = examine_live(rig->name, options.seconds);
  const bool is_up = live.has_value();
  const auto asking = is_up ? Asking::not_now : Asking::now;
  for (auto more :
       {examine_start(options.file, options.settings), rigs_of_others(), examine_machine(*rig),
        std::vector{examine_real_time(*rig)}, examine_pauses(*rig, asking), examine_display(*rig),
        examine_devices(*rig, asking), examine_lamp(*rig), examine_tracker(*rig, asking),
        findings_of(std::move(live))})
    std::move(more.begin(), more.end(), std::back_inserter(findings));
  return findings;
}

int run_verb(int argc, char** argv) {
  CommandLine line(
      "handcast doctor",
      "Checks a rig before the show: its file, its devices, this computer, and, if the rig is up, "
      "what it sees and casts. Exit 1 if there is a fault.");
  Options options;
  line.add("RIG.toml", options.file, "The rig file");
  line.add("--set path=value", options.settings, "A setting that overrides the file's");
  line.add("--seconds N", options.seconds, "How long a rig that is up is watched", {0.5, 3600});
  line.add("--json", options.as_json, "The same as JSON");
  if (const auto code = line.answered(argc, argv)) return *code;
  const auto findings = examine(options);
  fmt::print("{}", options.as_json ? to_json(findings) : printable(print(findings)));
  return has_fault(findings) ? kExitBadResult : kExitDone;
}

}  // namespace
}  // namespace handcast::doctor

int main(int argc, char** argv) {
  return handcast::run_program("handcast doctor", argc, argv, handcast::doctor::run_verb);
}
