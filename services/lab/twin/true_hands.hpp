// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <mutex>
#include <string>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/lab/twin/texture_map.hpp"
#include "services/lab/twin/true_hand.hpp"

namespace handcast::twin {

using msg::Side;

/// The true hands of one person. They take up to a second to make and are therefore made on first
/// use: the camera and the judge need them, the tracker and the detector do not. Any thread.
class TrueHands {
 public:
  /// Loads the models. `seen`: the sides that the motion has. Errors: those of load_flesh_model()
  /// and of loading the drawn hands (bad_config).
  static Result<std::unique_ptr<TrueHands>> create(const config::Rig& rig, std::array<bool, 2> seen,
                                                   const renderer::HandShape& person);
  virtual ~TrueHands() = default;

  /// The flesh of one hand.
  virtual const TrueHand& of(Side side) const = 0;
  /// The mesh that the cascade draws, as it is loaded.
  virtual const renderer::HandMesh& drawn(Side side) const = 0;
  /// Where each vertex of the drawn mesh is on the flesh.
  virtual const std::vector<SurfacePoint>& texture(Side side) const = 0;
  /// The mesh of the flesh for reports: as `twin.shape.mesh`, or what took its place and why.
  virtual std::string mesh_name() const = 0;
};

}  // namespace handcast::twin
