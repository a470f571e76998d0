// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "config/sections/projector.hpp"

namespace handcast::bench {

/// Sub-frames that were drawn in real time, as by the projector daemon: planned, rendered, packed
/// and handed over. Sensors and rings are left out.
struct SubFrameTimes {
  std::vector<double> pack_us;     ///< packing, all sub-frames of an output frame
  std::vector<double> last_us;     ///< packing, from the end of the last drawing on
  std::vector<double> drawing_us;  ///< rendering and packing one sub-frame
  std::vector<double> late_us;     ///< from the planned to the real time of handing over
  std::vector<double> lead_ms;     ///< of each sub-frame: from its drawing's begin to handing over
  int sub_frames = 0;
  /// Sub-frames without a drawing of their own, or in an output frame that was skipped or handed
  /// over 0.3 ms late or more, which a projector would not take in time.
  int missed = 0;
  int missed_with_frame = 0;  ///< of these, in such an output frame
  double output_hz = 0;       ///< output frames handed over per second
};

/// Draws `sub_frames` sub-frames with a hand that sways (SwayingHands, 0.73 m away).
SubFrameTimes draw_sub_frames(const config::Projector& settings, int sub_frames);

}  // namespace handcast::bench
