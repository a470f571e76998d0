// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/board/grey_view.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures the camera's lens from a board that a person shows; sets draft.camera. Ends when
/// enough was seen, Enter is pressed or the time is over. Errors: those of calib::fit_lens() and of
/// client::Stream.
Result<Outcome> measure_lens(Desk& desk);
/// The same for the second camera; sets draft.camera2->camera. Errors: also bad_config (the rig has
/// one camera).
Result<Outcome> measure_second_lens(Desk& desk);

/// What to do next. `wanted`: images that are enough; `place`: where the board was not seen yet, or
/// how it was not tilted; empty if it was everywhere.
std::string lens_advice(std::size_t views, std::size_t wanted, const std::string& place);

/// The image of a frame. Valid as long as the frame.
inline calib::GreyView view_of(const msg::CameraFrame& frame) {
  const auto width = static_cast<int>(frame.width_px);
  return {frame.pixels(), width, static_cast<int>(frame.height_px), width};
}

}  // namespace handcast::calibrate
