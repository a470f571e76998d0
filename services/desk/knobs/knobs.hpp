// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// The settings that hands turn: desk.gestures (knobs/gesture_list.hpp). At most 30 changes a
/// second, all of them one; the file is read again when it has changed. Null: desk.gestures is
/// empty. The panel outlives the result. Errors: bad_config (all faults of the file, each with its
/// line).
Result<std::unique_ptr<Surface>> open_knobs(const config::Rig& rig, Panel& panel);

}  // namespace handcast::desk
