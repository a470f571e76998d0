// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/actions.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "ipc/base/log.hpp"
#include "ipc/control/control_client.hpp"

namespace handcast::desk {
namespace {

using control::Role;
using nlohmann::json;

constexpr std::array kActions{
    Action{"/api/set", Role::operator_},         Action{"/api/undo", Role::operator_},
    Action{"/api/redo", Role::operator_},        Action{"/api/show", Role::operator_},
    Action{"/api/cue", Role::operator_},         Action{"/api/preset/load", Role::operator_},
    Action{"/api/preset/store", Role::owner},    Action{"/api/save", Role::owner},
    Action{"/api/service/restart", Role::owner}, Action{"/api/service/swap", Role::owner},
    Action{"/api/midi/learn", Role::owner},      Action{"/api/midi/stop", Role::owner},
    Action{"/api/midi/forget", Role::owner},     Action{"/api/record/start", Role::owner},
    Action{"/api/record/stop", Role::owner},     Action{"/api/doctor", Role::owner},
};
constexpr std::size_t kMostAssignments = 500;

/// A text of the body. Errors: bad_data (there is none).
Result<std::string> text_in(const json& body, const char* name) {
  const auto found = body.find(name);
  if (found != body.end() && found->is_string()) return found->get<std::string>();
  return fail(Errc::bad_data, fmt::format("The request has no text \"{}\".", name));
}

Result<void> set(Panel& panel, const json& body, const std::string& source) {
  const auto found = body.find("set");
  std::vector<std::string> assignments;
  if (found != body.end() && found->is_array())
    for (const auto& one : *found)
      if (one.is_string()) assignments.push_back(one);
  if (assignments.empty() || assignments.size() != found->size() ||
      assignments.size() > kMostAssignments)
    return fail(Errc::bad_data,
                fmt::format("The request has no list \"set\" of 1 to {} texts \"path=value\".",
                            kMostAssignments));
  return panel.set(assignments, source);
}

Result<void> show(Panel& panel, const json& body, const std::string& source) {
  const auto hand = text_in(body, "hand"), content = text_in(body, "content");
  if (!hand) return tl::make_unexpected(hand.error());
  if (!content) return tl::make_unexpected(content.error());
  if (*hand != "left" && *hand != "right" && *hand != "both")
    return fail(Errc::bad_data, "The hand must be \"left\", \"right\" or \"both\".");
  return panel.show(*hand, *content, source);
}

Result<void> cue(CueDeck* cues, const json& body, const std::string& source) {
  if (!cues) return fail(Errc::bad_config, "The rig has no cue list: see desk.cues.");
  const auto what = text_in(body, "do");
  if (!what) return tl::make_unexpected(what.error());
  log::info("{}: cue {}", printable(source), printable(*what));
  if (*what == "go") return cues->go(), Result<void>();
  if (*what == "back") return cues->back(), Result<void>();
  if (*what == "hold") return cues->hold(), Result<void>();
  const auto cue = text_in(body, "cue"), key = text_in(body, "key");
  if (*what == "jump" && cue) return cues->jump(*cue);
  if (*what == "key" && key) return cues->key(*key), Result<void>();
  return fail(Errc::bad_data,
              "A cue must be \"go\", \"back\", \"hold\", \"jump\" to a \"cue\", or a \"key\".");
}

Result<void> preset(Panel& panel, const json& body, const std::string& source, bool stores) {
  const auto name = text_in(body, "name");
  if (!name) return tl::make_unexpected(name.error());
  return stores ? panel.store(*name) : panel.load(*name, source);
}

Result<void> change_service(const Worked& worked, const json& body, const std::string& source,
                            bool swaps) {
  const auto service = text_in(body, "service");
  if (!service) return tl::make_unexpected(service.error());
  // It would wait for the end of this very request.
  if (*service == "desk")
    return fail(Errc::bad_config,
                "The desk cannot restart itself; `handcast restart desk` does it.");
  control::Request request{.verb = swaps ? control::Verb::swap : control::Verb::restart,
                           .service = *service,
                           .backend = {}};
  if (swaps) {
    auto backend = text_in(body, "backend");
    if (!backend) return tl::make_unexpected(backend.error());
    request.backend = std::move(*backend);
  }
  log::info("{}: {} {} {}", printable(source), swaps ? "swap" : "restart", printable(*service),
            printable(request.backend));
  const auto answer = control::ask(worked.rig, request);
  return answer ? Result<void>() : tl::make_unexpected(answer.error());
}

Result<void> midi(MidiLearner* learner, const json& body, std::string_view what) {
  if (!learner)
    return fail(Errc::bad_config, "The rig has no MIDI controller: see desk.midi.device.");
  if (what == "/api/midi/stop") return learner->stop_learning(), Result<void>();
  const auto path = text_in(body, "path");
  if (!path) return tl::make_unexpected(path.error());
  if (what == "/api/midi/learn") return learner->learn(*path);
  return learner->forget(*path), Result<void>();
}

/// Starts and stops programs.
Result<void> run_program(Programs& programs, const json& body, const std::string& source,
                         std::string_view what) {
  log::info("{}: {}", printable(source), what.substr(5));
  if (what == "/api/doctor") return programs.start_doctor();
  if (what == "/api/record/stop") return programs.stop_recording();
  const auto name = text_in(body, "name");
  return name ? programs.start_recording(*name) : tl::make_unexpected(name.error());
}

}  // namespace

const Action* find_action(std::string_view path) {
  for (const auto& action : kActions)
    if (action.path == path) return &action;
  return nullptr;
}

Result<void> act(const Worked& worked, const Action& action, const std::string& text,
                 const std::string& source) {
  const auto body = json::parse(text, nullptr, false);
  if (!body.is_object()) return fail(Errc::bad_data, "The request is not a JSON object.");
  auto& panel = worked.panel;
  const auto what = action.path;
  if (what == "/api/set") return set(panel, body, source);
  if (what == "/api/undo") return panel.undo(source);
  if (what == "/api/redo") return panel.redo(source);
  if (what == "/api/show") return show(panel, body, source);
  if (what == "/api/cue") return cue(worked.cues, body, source);
  if (what == "/api/preset/load") return preset(panel, body, source, false);
  if (what == "/api/preset/store") return preset(panel, body, source, true);
  if (what == "/api/save") return panel.save();
  if (what.starts_with("/api/midi/")) return midi(worked.midi, body, what);
  if (what.starts_with("/api/record/") || what == "/api/doctor")
    return run_program(worked.programs, body, source, what);
  return change_service(worked, body, source, what == "/api/service/swap");
}

}  // namespace handcast::desk
