// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// OSC in and out, and its description by OSCQuery, as set in [desk.osc]. Messages that come in set
/// the panel from a thread of its own, at once and at most 60 times a second. `camera`: whose
/// image TUIO's coordinates are of. `cues`: null if there is no cue list. Both outlive the result.
/// Null: nothing is set in [desk.osc]. Errors: bad_config (no address, too many), unavailable (a
/// port is in use).
Result<std::unique_ptr<Surface>> open_osc(const config::Rig& rig, const calib::CameraModel& camera,
                                          Panel& panel, CueDeck* cues);

}  // namespace handcast::desk
