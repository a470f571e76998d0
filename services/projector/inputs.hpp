// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/base/image.hpp"
#include "services/projector/contents.hpp"

namespace handcast::projector {

/// The inputs of the cascade: all poses and detections in order, the newest image, and what is
/// painted. One thread.
class Inputs {
 public:
  /// Takes the readers of the rings. `calibration`: the id of the one in use.
  Inputs(ipc::Reader<msg::CameraFrame> frames, ipc::Reader<msg::HandPoses> poses,
         ipc::Reader<msg::Landmarks> landmarks, Contents contents, std::uint32_t calibration)
      : frames_(std::move(frames)),
        poses_(std::move(poses)),
        landmarks_(std::move(landmarks)),
        contents_(std::move(contents)),
        calibration_(calibration) {}

  /// Takes the newest image, and passes all poses and detections since the last call to
  /// pipeline.push(), and new content to pipeline.wear() (renderer::Pipeline, or a type with the
  /// same functions). Waits only for a new image, until the deadline. It is no error if nothing
  /// arrived. Errors: those of ipc::Reader, except timeout; bad_data (something of another
  /// calibration arrived, and was left out).
  template <class Pipeline>
  Result<void> deliver(Pipeline& pipeline, Deadline image_deadline) {
    auto taken = take_image(image_deadline);
    for (const auto& pushed :
         {push_all(poses_, pipeline), push_all(landmarks_, pipeline), contents_.deliver(pipeline)})
      if (!pushed && taken) taken = pushed;
    return taken;
  }

  /// The newest image; empty before the first one. Valid until the next deliver().
  renderer::TimedImage image() const;

 private:
  template <class Message, class Pipeline>
  Result<void> push_all(ipc::Reader<Message>& reader, Pipeline& pipeline) const {
    Result<void> ours;
    while (reader.await(Deadline::now())) {
      const auto message = reader.next(Deadline::now());
      if (!message && message.error().code == Errc::timeout) return ours;
      if (!message) return tl::make_unexpected(message.error());
      if (auto fits = msg::check_calibration(**message, calibration_); !fits)
        ours = fits;
      else
        pipeline.push(now_ns(), **message);
    }
    return ours;
  }
  Result<void> take_image(Deadline deadline);

  ipc::Reader<msg::CameraFrame> frames_;
  ipc::Reader<msg::HandPoses> poses_;
  ipc::Reader<msg::Landmarks> landmarks_;
  Contents contents_;
  std::uint32_t calibration_;
  std::optional<ipc::Sample<msg::CameraFrame>> image_;
};

}  // namespace handcast::projector
