// SPDX-License-Identifier: Apache-2.0
// The verbs that send a request to a running rig.
#include <fmt/format.h>

#include <map>

#include "config/live/live_board.hpp"
#include "ipc/base/join.hpp"
#include "ipc/control/control_client.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/look/figures/figures.hpp"
#include "supervisor/succession/stop_rig.hpp"

namespace handcast::supervisor {
namespace {

struct ControlOutcome {
  int exit_code = kExitDone;
  nlohmann::json answer;
};

/// Chooses the rig and sends it a request. Prints errors.
ControlOutcome send(const std::string& rig_name, const control::Request& request) {
  const auto rig = choose_rig(rig_name);
  if (!rig) return {complain(rig.error()), {}};
  auto answer = control::ask(*rig, request);
  if (!answer) return {complain(answer.error()), {}};
  return {kExitDone, std::move(*answer)};
}

/// The pauses of streams in an answer: "; paused for: camera 2 ms, landmarks 8 ms". "" if there are
/// none.
std::string print_pauses(const nlohmann::json& answer) {
  std::vector<std::string> parts;
  const auto pauses_ms = answer.value("pauses_ms", std::map<std::string, double>());
  parts.reserve(pauses_ms.size());
  for (const auto& [name, pause_ms] : pauses_ms)
    parts.push_back(fmt::format("{} {:.0f} ms", name, pause_ms));
  return parts.empty() ? "" : "; paused for: " + join(parts, ", ");
}

/// The back ends that `handcast swap` has set, in an answer: "; camera keeps 'file' (`handcast swap
/// camera twin` returns to the rig file's)". "" if there are none.
std::string print_swaps(const nlohmann::json& answer) {
  std::string text;
  const auto swaps = answer.value("swapped", nlohmann::json::object());
  for (const auto& [name, swap] : swaps.items())
    text += fmt::format("; {0} keeps '{1}' (`handcast swap {0} {2}` returns to the rig file's)",
                        name, swap.value("backend", ""), swap.value("in_file", ""));
  return text;
}

/// The answer to a reload as text: "reloaded: camera, landmarks restarted; pose, projector
/// untouched; paused for: camera 2 ms, landmarks 8 ms".
std::string print_reload(const nlohmann::json& answer) {
  std::vector<std::string> parts;
  for (const auto* what : {"restarted", "started", "stopped", "untouched"})
    if (const auto names = answer.value(what, std::vector<std::string>()); !names.empty())
      parts.push_back(join(names, ", ") + " " + what);
  const bool acted = !parts.empty() && (parts.size() > 1 ||
                                        answer.value("untouched", nlohmann::json::array()).empty());
  const auto done = acted || answer.value("changed", false)
                        ? "reloaded: " + join(parts, "; ") + print_pauses(answer)
                        : "nothing changed";
  return done + print_swaps(answer);
}

/// Runs a verb about a service. Prints `done` on success, with {0} for the service and {1} for the
/// back end.
int ask_about_service(CommandLine line, const Arguments& arguments, control::Verb verb,
                      const char* done) {
  control::Request request{.verb = verb, .service = {}, .backend = {}};
  std::string rig;
  line.add("SERVICE", request.service, "As `handcast status` lists it");
  if (verb == control::Verb::swap)
    line.add("BACKEND", request.backend,
             "config/REFERENCE.md lists them; a wrong word prints those of the service");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  const auto [exit_code, answer] = send(rig, request);
  if (exit_code != kExitDone) return exit_code;
  fmt::print("{}", fmt::format(fmt::runtime(done), request.service, request.backend));
  if (answer.contains("pause_ms"))
    fmt::print(" (the stream paused for {:.0f} ms)", answer["pause_ms"].get<double>());
  fmt::print("\n");
  return exit_code;
}

}  // namespace

int run_down(const Arguments& arguments) {
  auto line = command_line_of("down");
  std::string name;
  add_rig(line, name);
  if (const auto code = line.answered(arguments)) return *code;
  const auto rig = choose_rig_to_stop(name);
  if (!rig) return complain(rig.error());
  const auto stopped = stop_rig(*rig);
  if (!stopped) return complain(stopped.error());
  fmt::print("{}\n", describe(*stopped, *rig));
  return kExitDone;
}

int run_restart(const Arguments& arguments) {
  return ask_about_service(command_line_of("restart"), arguments, control::Verb::restart,
                           "{0} is ready again");
}

int run_swap(const Arguments& arguments) {
  return ask_about_service(command_line_of("swap"), arguments, control::Verb::swap,
                           "{0} is ready with '{1}'");
}

int run_reload(const Arguments& arguments) {
  auto line = command_line_of("reload");
  std::string rig;
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  const auto [exit_code, answer] =
      send(rig, {.verb = control::Verb::reload, .service = {}, .backend = {}});
  if (exit_code == kExitDone) fmt::print("{}\n", print_reload(answer));
  return exit_code;
}

int run_status(const Arguments& arguments) {
  auto line = command_line_of("status");
  std::string rig;
  bool as_json = false;
  line.add("--json", as_json, "The same as JSON");
  add_rig(line, rig);
  if (const auto code = line.answered(arguments)) return *code;
  auto [exit_code, answer] =
      send(rig, {.verb = control::Verb::status, .service = {}, .backend = {}});
  if (exit_code != kExitDone) return exit_code;
  const auto& status = answer["status"];
  if (as_json) return fmt::print("{}\n", status.dump(2)), kExitDone;
  const auto figures = figures_in(status);
  const auto now = config::LiveBoard::open(figures.rig).and_then([](const auto& board) {
    return board.rig_now();
  });
  if (const auto why = now ? config::why_dark(now->light) : ""; !why.empty())
    fmt::print("the light is off: {}\n\n", why);
  fmt::print("{}", print_status(figures));
  return kExitDone;
}

}  // namespace handcast::supervisor
