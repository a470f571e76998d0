// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/msg/test_picture.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/pipeline/frame.hpp"

namespace handcast::projector {

/// The test pictures that a program outside the rig shows in place of hands. One thread.
class TestPictures {
 public:
  /// Takes the reader of the ring calibration.pictures. The sizes are those of the projector.
  TestPictures(ipc::Reader<msg::TestPicture> pictures, int width_px, int height_px)
      : pictures_(std::move(pictures)), image_(width_px, height_px) {}

  /// The frame that shows the picture of this time, CLOCK_MONOTONIC, lit at `target_ns`; null if
  /// there is none. Valid until the next call. A picture of another size than the projector's is
  /// left out.
  const renderer::Frame* at(std::int64_t time_ns, std::int64_t target_ns);

 private:
  bool take_newest();

  ipc::Reader<msg::TestPicture> pictures_;
  renderer::Texture image_;
  renderer::Frame frame_;
  msg::StageMark mark_;        ///< of frame_
  std::int64_t until_ns_ = 0;  ///< when the picture in image_ has lasted long enough
};

}  // namespace handcast::projector
