// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/field.hpp"

namespace handcast::config {

/// [pose.handover]
struct Handover {
  double patience_ms = 60;
  double return_ms = 500;
  double blend_ms = 300;
};

template <class Visitor>
void describe(Visitor& visitor, Handover& handover) {
  visitor.field("patience_ms", handover.patience_ms, between(10, 5000, "ms"),
                "The second source takes over after so long without a usable hand of the first.");
  visitor.field("return_ms", handover.return_ms, between(0, 60000, "ms"),
                "The first source takes over again after so long with usable hands.");
  visitor.field("blend_ms", handover.blend_ms, between(0, 5000, "ms"),
                "How long the difference of the two sources is blended out. 0: the hand jumps.");
}

}  // namespace handcast::config
