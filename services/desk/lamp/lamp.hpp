// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <memory>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// How long the lamp is waited for.
struct LampPatience {
  std::chrono::nanoseconds answer = std::chrono::seconds(5);  ///< for one connection
  /// Until it is told again, after it did not answer, or because it warms up.
  std::chrono::nanoseconds again = std::chrono::seconds(5);
};

/// Tells the projector's lamp what light.lamp says, by a thread of its own, until the lamp does so:
/// projector.lamp. What does not work is in the log. Null: projector.lamp.pjlink is empty. The
/// panel outlives the result. Errors: those of lamp::place_of().
Result<std::unique_ptr<Surface>> open_lamp(const config::Rig& rig, Panel& panel,
                                           const LampPatience& patience = {});

}  // namespace handcast::desk
