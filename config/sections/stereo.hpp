// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/field.hpp"

namespace handcast::config {

/// [pose.stereo]
struct PoseStereo {
  double hand_length_mm = 0;
  double pair_ms = 8;
  double wait_ms = 6;
  double one_view_s = 1;
};

template <class Visitor>
void describe(Visitor& visitor, PoseStereo& stereo) {
  visitor.field("hand_length_mm", stereo.hand_length_mm, between(0, 300, "mm"),
                "From the wrist to the tip of the middle finger, to begin with; the lengths of all "
                "bones are learned. 0: the length of handcast's hand.");
  visitor.field("pair_ms", stereo.pair_ms, between(0, 100, "ms"),
                "Images of the two cameras that are at most so far apart make one sample.");
  visitor.field("wait_ms", stereo.wait_ms, between(0, 100, "ms"),
                "So long the landmarks of one camera wait for those of the other; then they make a "
                "sample alone.");
  visitor.field("one_view_s", stereo.one_view_s, between(0, 60, "s"),
                "So long a hand is followed that only one camera sees.");
}

}  // namespace handcast::config
