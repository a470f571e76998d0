// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/control/desk_address.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/midi_learner.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/page/programs.hpp"

namespace handcast::desk {

/// What a page may ask for with POST: what it is called, and who may ask.
struct Action {
  std::string_view path;
  control::Role least;
};

/// The action of a path; null if there is none.
const Action* find_action(std::string_view path);

/// What the actions work on; `cues` and `midi` may be null.
struct Worked {
  std::string rig;
  Panel& panel;
  CueDeck* cues;
  MidiLearner* midi;
  Programs& programs;
};

/// Does what a page asks for. `body`: JSON as the page sends it. `source`: for the log. Errors:
/// bad_data (the body makes no sense), bad_config (it cannot be), unavailable. Restarts and swaps
/// take as long as the services do.
Result<void> act(const Worked& worked, const Action& action, const std::string& body,
                 const std::string& source);

}  // namespace handcast::desk
