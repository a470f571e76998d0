// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "config/sections/light.hpp"
#include "config/sections/viewpoint.hpp"
#include "ipc/msg/test_picture.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/pipeline/frame.hpp"

namespace handcast::projector {

/// The test pictures that a program outside the rig shows in place of hands. One thread.
class TestPictures {
 public:
  /// Takes the reader of the ring calibration.pictures. The sizes are those of the projector.
  /// `at`: the pictures are for the first projector; the second one is black meanwhile.
  TestPictures(ipc::Reader<msg::TestPicture> pictures, int width_px, int height_px,
               config::Viewpoint at = config::Viewpoint::first)
      : pictures_(std::move(pictures)),
        is_black_(at == config::Viewpoint::second),
        image_(width_px, height_px) {}

  /// The frame that shows the picture of this time, CLOCK_MONOTONIC, lit at `target_ns`; null if
  /// there is none. Valid until the next call. A picture of another size than the projector's is
  /// left out. `flip`: it is shown so (light.flip), as a calibration is right with it.
  const renderer::Frame* at(std::int64_t time_ns, std::int64_t target_ns,
                            config::Flip flip = config::Flip::none);

 private:
  bool take_newest();
  void mirror(config::Flip flip);

  ipc::Reader<msg::TestPicture> pictures_;
  bool is_black_;  ///< whatever the picture is
  renderer::Texture image_;
  config::Flip flip_ = config::Flip::none;  ///< of image_
  renderer::Frame frame_;
  msg::StageMark mark_;        ///< of frame_
  std::int64_t until_ns_ = 0;  ///< when the picture in image_ has lasted long enough
};

}  // namespace handcast::projector
