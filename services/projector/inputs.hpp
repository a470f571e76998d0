#pragma once
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/pipeline.hpp"

namespace handcast::projector {

/// What the sensors say, as the cascade wants it: every pose and every detection in order, of the images only the newest.
class Inputs {
 public:
  Inputs(ipc::Reader<msg::CameraFrame> frames, ipc::Reader<msg::HandPoses> poses, ipc::Reader<msg::Landmarks> landmarks)
      : frames_(std::move(frames)), poses_(std::move(poses)), landmarks_(std::move(landmarks)) {}

  /// Hands over what arrived since the last call. Waits for a new image until the deadline, for nothing else.
  /// Errors: bad_data (a ring does not make sense); that nothing arrived is none.
  Result<void> deliver(renderer::Pipeline& pipeline, Deadline image_deadline);

  renderer::GreyView image() const;  ///< the newest; data is null before the first
  msg::Header image_header() const { return image_ ? (*image_)->header : msg::Header{}; }

 private:
  ipc::Reader<msg::CameraFrame> frames_;
  ipc::Reader<msg::HandPoses> poses_;
  ipc::Reader<msg::Landmarks> landmarks_;
  std::optional<ipc::Sample<msg::CameraFrame>> image_;
};

}  // namespace handcast::projector
