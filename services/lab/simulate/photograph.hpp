// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/draw/painter.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::simulate {

/// Draws the scene as seen from the projector: the true hands in dim light, and the projector's
/// light on them and on the table behind them.
class Photographer {
 public:
  /// `twin` must outlive the object.
  Photographer(const twin::Twin& twin, const calib::Calibration& calibration);

  /// Draws the scene at the time of `projection`: RGBA8, in the size of the projector. Valid until
  /// the next call.
  renderer::View<const std::uint32_t> take(const msg::Projection& projection);

 private:
  struct Surface {
    std::vector<glm::vec3> position_m, normal;
    std::vector<glm::vec2> position_px;
    std::vector<float> depth_m, light;
  };
  renderer::Rect draw_truth(std::int64_t time_ns);
  void pose(const twin::TrueHand& hand, const twin::JointFrames& joints, Surface& surface) const;

  const twin::Twin& twin_;
  std::unique_ptr<renderer::Painter> painter_;
  std::array<Surface, msg::kMaxHands> surfaces_;
  renderer::Image<std::uint32_t> picture_;
};

}  // namespace handcast::simulate
