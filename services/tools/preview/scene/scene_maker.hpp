// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/similarity.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/mask/hand_mask.hpp"
#include "renderer/output/light.hpp"
#include "renderer/predict/hand_track.hpp"
#include "services/tools/preview/scene/from_camera.hpp"
#include "services/tools/preview/scene/scene.hpp"

namespace handcast::preview {

/// The meshes of both hands, by side.
using Meshes = std::array<renderer::HandMesh, msg::kMaxHands>;

/// True if size and region of the projector's image make sense; they come from a ring.
bool is_sound(const msg::Projection& projection);

/// The pixels of the projector that the drawn hands cover before the fill: 255, all others 0.
/// Computed from the landings in the message. Hands whose vertices are not those of their mesh, and
/// triangles that are absurdly large or not finite, are left out. `projection`: see is_sound().
renderer::Image<std::uint8_t> coverage(const msg::Projection& projection, const Meshes& meshes);

/// The edges of the drawn hand `hand` of the projection whose triangles face the camera, in
/// pixels of the camera's image at the time of the light. Leaves out what coverage() does.
std::vector<std::pair<glm::vec2, glm::vec2>> visible_edges(const msg::ProjectedHand& hand,
                                                           const Meshes& meshes,
                                                           const FromCamera& from_camera);

/// The whole image of the projector at a brightness 0..1, as levels of a screen: black and
/// transparent outside of the lit region, and everywhere if the brightness is 0.
renderer::Texture whole_light(const msg::Projection& projection, double brightness);

/// The motion of the hands by the tracker, and the newest landmarks. One thread.
class Hands {
 public:
  /// Without messages. Copies both arguments.
  Hands(const config::Predict& predict, const calib::Calibration& calibration);

  /// Adds a message. Poses and landmarks that cannot be those of a hand are left out.
  /// @{
  void push(const msg::HandPoses& poses);
  void push(const msg::Landmarks& landmarks);
  /// @}

  /// The pose of a hand at a time, tracker space. Empty without a sample in the 0.2 s before it.
  std::optional<msg::HandPose> pose_at(msg::Side side, std::int64_t time_ns) const;
  /// How far the landmarks of a hand are from those of the tracker, undistorted camera px. Empty
  /// if either is unknown.
  std::optional<renderer::LandmarkPoints> offset_at(msg::Side side, std::int64_t time_ns) const;
  /// The motion of a hand in the image between two times. Empty if it is unknown.
  std::optional<renderer::Similarity> motion(msg::Side side, std::int64_t from_ns,
                                             std::int64_t to_ns) const;
  /// Joints and landmarks of a hand at a time. Empty if it has neither.
  std::optional<ShownHand> at(msg::Side side, std::int64_t time_ns) const;

 private:
  const renderer::HandTrack& track_of(msg::Side side) const {
    return tracks_[static_cast<std::size_t>(side)];
  }
  const msg::Landmarks* detection_near(msg::Side side, std::int64_t time_ns) const;
  void show_joints(const msg::HandPose& pose, ShownHand& hand) const;
  void show_landmarks(std::int64_t time_ns, ShownHand& hand) const;

  calib::Calibration calibration_;
  std::array<renderer::HandTrack, msg::kMaxHands> tracks_;  ///< by side
  std::deque<msg::Landmarks> detections_;                   ///< oldest first
};

/// What the messages of a rig refer to: its geometry, its settings and the meshes that it draws.
struct World {
  calib::Calibration calibration;                        ///< of camera, tracker and projector
  config::Mask mask;                                     ///< settings of the mask
  config::Predict predict;                               ///< settings of the prediction
  std::array<renderer::HandMesh, msg::kMaxHands> hands;  ///< by side
  double brightness = 1;                                 ///< projector.brightness
};

/// Reads the files that a rig names. `projector`: whose light is shown. Errors: bad_config (a file
/// cannot be used, the rig has no second projector).
Result<World> load_world(const config::Rig& rig, config::Viewpoint projector);

/// Where the mask cuts a forearm off (renderer::HandHint), image px.
struct ForearmCut {
  glm::vec2 wrist;       ///< on the line of the cut
  glm::vec2 to_elbow;    ///< unit
  float half_width = 0;  ///< of the arm
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

  /// How bright the light is from now on, 0..1.
  void set_brightness(double brightness) {
    if (world_) world_->brightness = brightness;
  }

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
  bool is_forearm(glm::vec2 px) const;
  void place_hands(const Scene& scene, const std::vector<Motion>& motions);
  void add_light(const msg::Projection& projection, const std::vector<Motion>& motions,
                 Scene& scene);
  void add_drawing(const msg::Projection& projection, const std::vector<Motion>& motions,
                   Scene& scene) const;

  std::optional<World> world_;
  std::optional<Hands> hands_;
  std::optional<renderer::HandMask> mask_;
  std::optional<FromCamera> from_camera_;
  renderer::GreyView hand_px_;    ///< the mask of the image that is shown; null: none
  std::vector<ForearmCut> cuts_;  ///< of the hands in it
};

}  // namespace handcast::preview
