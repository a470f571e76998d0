// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/light_source.hpp"
#include "renderer/output/light.hpp"
#include "renderer/pipeline/frame.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::projector {

/// The times of a presented frame, CLOCK_MONOTONIC.
struct PresentTimes {
  std::int64_t handed_ns = 0;   ///< when the projector took the frame
  std::int64_t display_ns = 0;  ///< the middle of the time it is lit
  msg::LightNote note;          ///< who said when it is lit
  /// When the projector can take the next frame, if it has a rhythm of its own; 0: frames are drawn
  /// at projector.rate_hz.
  std::int64_t next_ns = 0;
};

/// Turns frames into light. One thread.
class Projector {
 public:
  virtual ~Projector() = default;

  /// Where present() finds images of a GPU (Frame::device); none if it needs them in memory.
  virtual renderer::ShareGroup share_group() const { return {}; }

  /// Hands a frame over, whose levels the table turns into those of the projector. If frames come
  /// faster than the projector takes them, waits until the deadline. The frame may be reused when
  /// the call returns. Errors: timeout (this frame is not shown), bad_data (a frame could not be
  /// written), disconnected.
  virtual Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t frame_id,
                                       const renderer::LightTable& light, Deadline deadline) = 0;
};

/// A back end, opened with the rig and its calibration.
using ProjectorBackend = service::Backend<Projector, config::Rig, calib::Calibration>;
/// Of a back end that is a file of its own: projector/NAME.so.
extern "C" const service::LoadedBackEnd<ProjectorBackend> handcast_projector_back_end;

/// All back ends of this build.
std::span<const ProjectorBackend> projector_backends();

/// Opens the back end rig.projector.backend. With `projector.packing`, it gets the settings and the
/// image size of output frames; `calibration` is that for a sub-frame. Errors: bad_config (unknown
/// back end, or its settings are wrong), and those of the back end.
Result<std::unique_ptr<Projector>> open_projector(const config::Rig& rig,
                                                  const calib::Calibration& calibration);

}  // namespace handcast::projector
