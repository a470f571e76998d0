// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "config/sections/twin/shape.hpp"
#include "ipc/base/result.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/lab/twin/texture_map.hpp"

namespace handcast::twin {

using renderer::JointFrames;

/// A true hand: flesh on the bones of a person. It need not be the mesh that the cascade draws, and
/// it need not follow its bones in the same way.
struct TrueHand {
  renderer::HandMesh mesh;  ///< at rest, with the skin weights of its own model
  config::TwinSkinning skinning = config::TwinSkinning::linear;
  /// By vertex: the joint at whose bend it bulges, 0: none, and how far it moves along its normal
  /// at 90 degrees. Empty: nothing bulges.
  /// @{
  std::vector<std::uint8_t> bulge_joint;
  std::vector<float> bulge_m;
  /// @}
};

/// The differences of a person's flesh from its model, all factors 1 for none.
struct Flesh {
  std::array<float, msg::kJoints> width{};      ///< by joint: across the bone
  std::array<float, msg::kJoints> thickness{};  ///< by joint: from back to front, besides `width`
  std::array<float, 5> roll_rad{};              ///< by finger: about its bones, 0 for none
  float bulge = 0;                              ///< share of a joint's radius at 90 degrees

  /// The model itself.
  static Flesh of_model();
  /// Draws a person.
  static Flesh draw(const config::TwinShape& settings, int seed);
};

/// Puts the flesh of `model` on the bones of a person: `rest` are the joints of the same side in
/// the person's rest pose, `size` the person's widths relative to the model's. The length of a bone
/// is that of the person; the skin of a fingertip ends at the person's tip joint.
TrueHand flesh_on_bones(const renderer::HandMesh& model, const JointFrames& rest, float size,
                        const Flesh& flesh, config::TwinSkinning skinning);

/// The positions of the ground-truth mesh in the space of `joints`, m, by vertex of the mesh; unit
/// normals if `normals` is not empty. The joints may be anywhere, with axes of unit length.
void pose(const TrueHand& hand, const JointFrames& joints, std::span<glm::vec3> positions,
          std::span<glm::vec3> normals = {});

using msg::Side;

/// The true hands of one person. They take up to a second to make and are therefore made on first
/// use: the camera and the judge need them, the tracker and the detector do not. Any thread.
class TrueHands {
 public:
  /// Loads the models. `seen`: the sides that the motion has. Errors: those of
  /// load_ground_truth_mesh() and of loading the drawn hands (bad_config).
  static Result<std::unique_ptr<TrueHands>> create(const config::Rig& rig, std::array<bool, 2> seen,
                                                   const renderer::HandShape& person);
  virtual ~TrueHands() = default;

  /// The ground-truth mesh of one hand.
  virtual const TrueHand& of(Side side) const = 0;
  /// The mesh that the cascade draws, as it is loaded.
  virtual const renderer::HandMesh& drawn(Side side) const = 0;
  /// Where each vertex of the drawn mesh is on the ground-truth mesh.
  virtual const std::vector<SurfacePoint>& texture(Side side) const = 0;
  /// The ground-truth mesh for reports: as `twin.shape.mesh`, or what took its place and why.
  virtual std::string mesh_name() const = 0;
};

}  // namespace handcast::twin
