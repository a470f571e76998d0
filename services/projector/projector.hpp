// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::projector {

/// The times of a presented frame, CLOCK_MONOTONIC.
struct PresentTimes {
  std::int64_t handed_ns = 0;  ///< when the projector took the frame
  std::int64_t lit_ns = 0;     ///< the middle of the time it is lit
};

/// Turns frames into light. One thread.
class Projector {
 public:
  virtual ~Projector() = default;

  /// Hands a frame over. If frames come faster than the projector takes them, waits until the
  /// deadline. The frame may be reused when the call returns. Errors: timeout (this frame is not
  /// shown), bad_data (this frame could not be written), disconnected.
  virtual Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t frame_id,
                                       Deadline deadline) = 0;
};

/// A back end, opened with the rig.
using ProjectorBackend = service::Backend<Projector, config::Rig>;

/// All back ends of this build.
std::span<const ProjectorBackend> projector_backends();

/// Opens the back end rig.projector.backend. Errors: bad_config (unknown back end, or its settings
/// are wrong), and those of the back end.
Result<std::unique_ptr<Projector>> open_projector(const config::Rig& rig);

}  // namespace handcast::projector
