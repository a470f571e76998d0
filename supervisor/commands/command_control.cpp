// SPDX-License-Identifier: Apache-2.0
// The verbs that send a request to a running rig.
#include <fmt/format.h>

#include <map>

#include "ipc/base/join.hpp"
#include "ipc/control/control_client.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/choose_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/rig/status_text.hpp"
#include "supervisor/succession/stop_rig.hpp"

namespace handcast::supervisor {
namespace {

struct Outcome {
  int exit_code = kExitDone;
  nlohmann::json answer;
};

/// Chooses the rig and sends it a request. Prints errors.
Outcome send(const std::string& rig_name, const control::Request& request) {
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

/// Runs a verb whose arguments are `words`: SERVICE, and perhaps BACKEND. Prints `done` on success,
/// with {0} for the service and {1} for the back end.
int ask_with_words(const char* verb, const Arguments& arguments,
                   const std::vector<std::string_view>& words, control::Request request,
                   const char* done) {
  const auto options =
      sort_options(arguments, {.with_value = {"--rig"}, .flags = {}, .words = words});
  if (!options)
    return complain(kExitUsage,
                    fmt::format("{0}: {1}; `handcast help {0}`", verb, options.error().what));
  request.service = options->words[0];
  if (words.size() > 1) request.backend = options->words[1];
  const auto [exit_code, answer] = send(options->value("--rig"), request);
  if (exit_code != kExitDone) return exit_code;
  fmt::print("{}", fmt::format(fmt::runtime(done), request.service, request.backend));
  if (answer.contains("pause_ms"))
    fmt::print(" (the stream paused for {:.0f} ms)", answer["pause_ms"].get<double>());
  fmt::print("\n");
  return exit_code;
}

}  // namespace

int run_down(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--rig"}, .flags = {}});
  if (!options)
    return complain(kExitUsage, "down: " + options.error().what + "; `handcast help down`");
  const auto rig = choose_rig_to_stop(options->value("--rig"));
  if (!rig) return complain(rig.error());
  const auto stopped = stop_rig(*rig);
  if (!stopped) return complain(stopped.error());
  fmt::print("{}\n", describe(*stopped, *rig));
  return kExitDone;
}
int run_restart(const Arguments& arguments) {
  return ask_with_words("restart", arguments, {"SERVICE"},
                        {.verb = control::Verb::restart, .service = {}, .backend = {}},
                        "{0} is ready again");
}
int run_swap(const Arguments& arguments) {
  return ask_with_words("swap", arguments, {"SERVICE", "BACKEND"},
                        {.verb = control::Verb::swap, .service = {}, .backend = {}},
                        "{0} is ready with '{1}'");
}

int run_reload(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--rig"}, .flags = {}});
  if (!options)
    return complain(kExitUsage, "reload: " + options.error().what + "; `handcast help reload`");
  const auto [exit_code, answer] =
      send(options->value("--rig"), {.verb = control::Verb::reload, .service = {}, .backend = {}});
  if (exit_code == kExitDone) fmt::print("{}\n", print_reload(answer));
  return exit_code;
}

int run_status(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--rig"}, .flags = {"--json"}});
  if (!options)
    return complain(kExitUsage, "status: " + options.error().what + "; `handcast help status`");
  auto [exit_code, answer] =
      send(options->value("--rig"), {.verb = control::Verb::status, .service = {}, .backend = {}});
  if (exit_code != kExitDone) return exit_code;
  const auto& status = answer["status"];
  fmt::print("{}", options->has("--json") ? status.dump(2) + "\n" : print_status(status));
  return kExitDone;
}

}  // namespace handcast::supervisor
