// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/base/image.hpp"

namespace handcast::projector {

/// What the sensors say, as the cascade wants it: every pose and every detection in order, of the
/// images only the newest.
class Inputs {
 public:
  Inputs(ipc::Reader<msg::CameraFrame> frames, ipc::Reader<msg::HandPoses> poses,
         ipc::Reader<msg::Landmarks> landmarks)
      : frames_(std::move(frames)), poses_(std::move(poses)), landmarks_(std::move(landmarks)) {}

  /// Pushes what arrived since the last call into `pipeline` (anything with renderer::Pipeline's
  /// push). Waits for a new image until the deadline, for nothing else. Errors: bad_data (a ring
  /// does not make sense). That nothing arrived is no error.
  template <class Pipeline>
  Result<void> deliver(Pipeline& pipeline, Deadline image_deadline) {
    const auto taken = take_image(image_deadline);
    if (auto pushed = push_all(poses_, pipeline); !pushed) return pushed;
    if (auto pushed = push_all(landmarks_, pipeline); !pushed) return pushed;
    return taken;
  }

  /// The newest; none before the first.
  renderer::TimedImage image() const;

 private:
  template <class Message, class Pipeline>
  static Result<void> push_all(ipc::Reader<Message>& reader, Pipeline& pipeline) {
    for (;;) {
      const auto message = reader.next(Deadline::now());
      if (!message && message.error().code == Errc::timeout) return {};
      if (!message) return tl::make_unexpected(message.error());
      pipeline.push(now_ns(), **message);
    }
  }
  Result<void> take_image(Deadline deadline);

  ipc::Reader<msg::CameraFrame> frames_;
  ipc::Reader<msg::HandPoses> poses_;
  ipc::Reader<msg::Landmarks> landmarks_;
  std::optional<ipc::Sample<msg::CameraFrame>> image_;
};

}  // namespace handcast::projector
