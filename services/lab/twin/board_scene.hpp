// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/flat_picture.hpp"
#include "services/lab/twin/held_board.hpp"
#include "services/lab/twin/image_sensor.hpp"
#include "services/lab/twin/true_geometry.hpp"

namespace handcast::twin {

/// The camera that sees a board: the rig's first one or its second one.
struct SceneView {
  calib::CameraModel camera;  ///< its true lens
  glm::dmat4 from_first{1};   ///< from the space of the rig's first camera to its own
  int seed = 0;               ///< of what its sensor adds
};

/// The images of one of the twin's infrared cameras while a person holds a calibration board: the
/// board, lit by the lamp at the lens, the sun and the projector, over the empty scene, with motion
/// blur and what the sensor adds. The background reflects the projector's light as it reflects the
/// lamp's, as a plane 1 m in front of the camera. The board throws no shadow on it.
///
/// The projector's light is `twin.image.leak` times as bright as the lamp's and reaches a surface
/// from the same side. Reuses its buffers: not thread-safe.
class BoardScene {
 public:
  /// Copies what it needs. `picture` must pass check().
  BoardScene(const config::Twin& settings, const TrueGeometry& geometry, const SceneView& view,
             const FlatPicture& picture);

  /// The true pose of the board's axes (FlatPicture) in the space of this camera at a time since
  /// the epoch.
  glm::dmat4 camera_from_board(std::int64_t time_ns) const;

  /// Draws frame `k`, exposed for `exposure_ns` around `origin_ns` (ns since the epoch). `light`:
  /// what the projector shows meanwhile; null: dark. `image` must have the size of the camera's
  /// image.
  void draw(std::uint64_t k, std::int64_t origin_ns, std::int64_t exposure_ns, const Light* light,
            renderer::View<std::uint8_t> image);

 private:
  void look_through_lens(const calib::CameraModel& camera);
  glm::dmat3 light_from_ray(const glm::dmat4& camera_from_plane) const;
  void take_samples(std::int64_t origin_ns, std::int64_t exposure_ns);
  renderer::Rect board_near(int y) const;
  renderer::Rect find_board();
  void draw_table(int y, const renderer::Rect& region, bool lit);
  void draw_board(int y, const renderer::Rect& board, bool lit);

  config::TwinImage settings_;
  TrueGeometry geometry_;
  SceneView view_;
  double metres_per_px_;  ///< of levels_[0]
  glm::dvec2 origin_px_;
  HeldBoard held_;
  glm::dmat4 view_from_held_;             ///< from the space of held_ to that of this camera
  std::vector<QuadImage> levels_;         ///< see make_levels()
  renderer::Image<float> ray_x_, ray_y_;  ///< by pixel: it looks along (x, y, 1)
  renderer::Image<float> white_;          ///< by pixel: grey value of white paper at lamp_on() = 1
  renderer::Image<float> background_;     ///< by pixel: lit by lamp and sun
  renderer::Image<float> table_;          ///< by pixel: the background lit by the lamp alone
  glm::mat3 light_on_table_;              ///< from rays to projector pixels
  ImageSensor sensor_;

  glm::dmat4 camera_from_board_{1};  ///< in the middle of the exposure
  glm::mat3 light_on_board_{1};      ///< from rays to projector pixels, at that time
  int level_ = 0;
  /// From rays to pixels of levels_[level_], at the instants of the exposure and for several
  /// positions within a pixel.
  std::vector<glm::mat3> samples_;
  std::vector<renderer::Rect> bands_;  ///< of a few rows each, that contain the board
  QuadImage light_;
  renderer::Image<float> sum_;
  /// By pixel of a row: one sample of the picture; the projector's light; the light on the board;
  /// the sums over the samples.
  std::vector<float> grey_, inside_, shine_, lamp_, reflected_, covered_;
};

}  // namespace handcast::twin
