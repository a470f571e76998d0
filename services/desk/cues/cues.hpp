// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// The cue list as it runs: turn() fades and looks for triggers, the deck's commands come from any
/// thread.
class RunningCues : public Surface, public CueDeck {};

/// Seconds since 1970, for times of day.
using WallClock = std::function<double()>;
double wall_clock_s();

/// The cue list of desk.cues (cues/cue_list.hpp), at the place where it was when the process ended:
/// a cue whose fades were not over begins them again from the present values. `state_file`: where
/// the place is kept. Null: desk.cues is empty. The panel outlives the result. Errors: bad_config
/// (all faults of the list, each with its line).
Result<std::unique_ptr<RunningCues>> open_cues(const config::Rig& rig,
                                               const std::filesystem::path& state_file,
                                               Panel& panel, WallClock clock = wall_clock_s);

}  // namespace handcast::desk
