// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "ipc/msg/projection.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/brightness.hpp"
#include "services/projector/inputs.hpp"
#include "services/projector/live_light.hpp"
#include "services/projector/other_light.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/test_pictures.hpp"
#include "services/runtime/context.hpp"

namespace handcast::projector {

/// What the service works with.
struct Show {
  config::Projector settings;             ///< of this projector
  const calib::Calibration& calibration;  ///< as this projector has it
  renderer::Pipeline& pipeline;
  Inputs& inputs;
  TestPictures& test_pictures;
  Projector& projector;
  Brightness& brightness;
  LiveLight& live;
  std::optional<OtherLight> other;  ///< empty if there is one projector
  ipc::Writer<msg::Projection> projections;

  /// Takes what is new for a frame that begins now; waits for an image until the deadline. Errors:
  /// those of Inputs::deliver().
  Result<void> take_inputs(Deadline image_deadline) {
    if (other) pipeline.set_beside(other->share(now_ns()));
    return inputs.deliver(pipeline, image_deadline);
  }
};

/// Draws and presents one frame per projector period and publishes it, until the service ends.
/// Calls context.ready().
void show_frames(service::Context& context, Show show);

/// The same with projector.packing: draws the sub-frames of each output frame (SubFramePlan),
/// packs them (renderer::Packer), hands the output frame over and publishes a message for each
/// sub-frame.
void show_sub_frames(service::Context& context, Show show);

}  // namespace handcast::projector
