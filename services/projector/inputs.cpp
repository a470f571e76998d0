// SPDX-License-Identifier: Apache-2.0
#include "services/projector/inputs.hpp"

namespace handcast::projector {

Result<void> Inputs::take_image(Deadline deadline) {
  if (!frames_.await(deadline)) return {};
  auto newest = frames_.latest(Deadline::now());
  if (!newest && newest.error().code == Errc::timeout) return {};
  if (!newest) return tl::make_unexpected(newest.error());
  auto ours = msg::check_calibration(**newest, calibration_);
  if (ours)
    image_ = std::move(*newest);
  else
    image_.reset();
  return ours;
}

renderer::TimedImage Inputs::image() const {
  if (!image_) return {};
  const msg::CameraFrame& frame = **image_;
  const auto width = static_cast<int>(frame.width_px);
  return {{frame.pixels(), width, static_cast<int>(frame.height_px), width},
          frame.header.origin_ns,
          frame.header.frame_id};
}

}  // namespace handcast::projector
