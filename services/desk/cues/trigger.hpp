// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "ipc/base/result.hpp"
#include "services/desk/cues/cue_list.hpp"

namespace handcast::desk::cues {

/// Reads what starts a cue: "key g", "at 20:15" or "at 20:15:30", "left.appears", "idle 30", "idle"
/// (the event), "after 5". Errors: bad_config (a sentence).
Result<Trigger> read_trigger(std::string_view text);

}  // namespace handcast::desk::cues
