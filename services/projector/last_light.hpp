// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "services/projector/brightness.hpp"
#include "services/runtime/context.hpp"

namespace handcast::projector {

/// Decides when the loop of the projector ends: as soon as it is asked to stop if another projector
/// takes over; otherwise the light fades first, and the last frame is black. One thread.
class LastLight {
 public:
  /// Both must outlive the object.
  LastLight(service::Context& context, Brightness& brightness)
      : context_(context), brightness_(brightness) {}

  /// True while frames are to be drawn. Call it as service::Context::running().
  bool goes_on() {
    if (context_.running()) return true;
    if (!context_.may_finish() || is_black_) return false;
    const std::int64_t time_ns = now_ns(),
                       stop_ns = seconds_to_ns(context_.rig().supervisor.stop_s);
    if (asked_ns_ == 0) asked_ns_ = time_ns;
    brightness_.fall(asked_ns_, stop_ns / 2);
    return time_ns - asked_ns_ < stop_ns / 4 * 3;
  }
  /// Notes that a frame of the brightness that was asked for last is lit.
  void presented() { is_black_ = brightness_.has_fallen(); }

 private:
  service::Context& context_;
  Brightness& brightness_;
  std::int64_t asked_ns_ = 0;  ///< when the rig's stop was noticed; 0: not yet
  bool is_black_ = false;
};

}  // namespace handcast::projector
