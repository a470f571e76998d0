// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/mask/hand_mask.hpp"
#include "services/tools/preview/scene/drawing.hpp"
#include "services/tools/preview/scene/hands.hpp"
#include "services/tools/preview/scene/scene.hpp"

namespace handcast::preview {

/// What the messages of a rig refer to: its geometry, its settings and the meshes that it draws.
struct World {
  calib::Calibration calibration;                        ///< of camera, tracker and projector
  config::Mask mask;                                     ///< settings of the mask
  config::Predict predict;                               ///< settings of the prediction
  std::array<renderer::HandMesh, msg::kMaxHands> hands;  ///< by side
};

/// Reads the files that a rig names. Errors: bad_config.
Result<World> load_world(const config::Rig& rig);

/// The map from pixels of the camera's image to pixels of the projector (lens distortion and
/// homography), as a table that is computed once per calibration.
class FromCamera {
 public:
  /// Computes the table.
  explicit FromCamera(const calib::Calibration& calibration);

  /// The projector pixel that lights this position of the image. Positions outside of the image
  /// are continued.
  glm::vec2 operator()(glm::vec2 image_px) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<glm::vec2> table_;  ///< every 8th pixel of every 8th row; bilinear in between
};

/// Turns the messages of a rig into scenes. Messages come from rings, so no number in them is
/// trusted. The mask is found as the projector does it (renderer/mask), with the landmarks nearest
/// to the image; the drawing before the fill is computed from the landings. One thread.
class SceneMaker {
 public:
  /// Takes the world, which may be empty: then only images are shown.
  explicit SceneMaker(std::optional<World> world);

  /// Takes a message; call it in the order of the stream.
  /// @{
  void push(const msg::HandPoses& poses);
  void push(const msg::Landmarks& landmarks);
  /// @}

  /// The scene at the exposure of `frame`. Either may be null. Best if the poses of the time of
  /// the light are known already, i.e. some 30 ms after it.
  Scene make(const msg::CameraFrame* frame, const msg::Projection* projection);

  /// The id of the world's calibration; 0 without a world.
  std::uint32_t calibration() const { return world_ ? world_->calibration.id : 0; }

 private:
  /// A hand that is tracked, between the exposure and the light.
  struct Motion {
    msg::Side side;
    glm::vec2 centre_px;                      ///< in the image
    renderer::Similarity to_light, to_image;  ///< image px at the exposure to those at the light
  };

  bool fits(const msg::CameraFrame& frame) const;
  void add_hands(const msg::CameraFrame& frame, Scene& scene) const;
  std::vector<Motion> motions(const Scene& scene, std::int64_t image_ns,
                              std::int64_t light_ns) const;
  void find_mask(const msg::CameraFrame& frame);
  void add_light(const msg::Projection& projection, const std::vector<Motion>& motions,
                 Scene& scene);
  void add_drawing(const msg::Projection& projection, const std::vector<Motion>& motions,
                   Scene& scene) const;

  std::optional<World> world_;
  std::optional<Hands> hands_;
  std::optional<renderer::HandMask> mask_;
  std::optional<FromCamera> from_camera_;
  renderer::GreyView hand_px_;  ///< the mask of the image that is shown; null: none
};

}  // namespace handcast::preview
