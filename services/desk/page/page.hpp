// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// The page in a browser, at desk.page.listen; null if that is empty. `panel` and `cues` (may be
/// null) outlive it. It has threads of its own, at low priority. Errors: bad_config (the address is
/// none of this computer alone, the calibration), unavailable (no port, or no folder for the file
/// that `handcast desk` reads).
Result<std::unique_ptr<Surface>> open_page(const config::Rig& rig, Panel& panel,
                                           CueDeck* cues = nullptr);

}  // namespace handcast::desk
