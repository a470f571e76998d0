// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/midi_learner.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// What the page works; it outlives the page.
struct PageWorks {
  Panel& panel;
  CueDeck* cues = nullptr;         ///< null: there is no cue list
  MidiLearner* midi = nullptr;     ///< null: there is no controller
  std::filesystem::path rig_file;  ///< empty: not known
};

/// The page in a browser, at desk.page.listen, and, encrypted, for other computers at
/// desk.page.lan; null if the first is empty. It has threads of its own, at low priority. Errors:
/// bad_config (the address is none of this computer alone, the calibration), unavailable (no port,
/// or no folder for the file that `handcast desk` reads). If others cannot be served, `handcast
/// desk --lan` says why.
Result<std::unique_ptr<Surface>> open_page(const config::Rig& rig, const PageWorks& works);

}  // namespace handcast::desk
