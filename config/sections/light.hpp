// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/settings/field.hpp"

namespace handcast::config {

/// [light]
struct Light {
  bool blackout = false;
  bool freeze = false;
  double master = 1;
  double master_s = 0;
  std::vector<std::string> keep_out;
};

template <class Visitor>
void describe(Visitor& visitor, Light& light) {
  visitor.field("blackout", light.blackout, "No light at all, from the next frame on.");
  visitor.field("freeze", light.freeze, "The light stays as it is, wherever the hands go.");
  visitor.field("master", light.master, between(0, 1),
                "Share of projector.brightness that is shown.");
  visitor.field("master_s", light.master_s, between(0, 600, "s"),
                "How long `master` takes to a new value.");
  visitor.field("keep_out", light.keep_out,
                "Areas of the projector's picture that stay dark whatever is drawn, e.g. a "
                "painting: polygons of pixels, each \"x y, x y, x y\" with 3 to 32 corners, at "
                "most 16.");
}

}  // namespace handcast::config
