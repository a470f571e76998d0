// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/twin/image_faults.hpp"
#include "services/lab/twin/image_sensor.hpp"
#include "services/lab/twin/solid.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/lab/twin/true_hands.hpp"

namespace handcast::twin {

using msg::Side;
using renderer::JointFrames;

/// Returns the true joints of a hand in tracker space at a time since the epoch; empty if there is
/// no such hand.
using TruthAt = std::function<std::optional<JointFrames>(Side side, std::int64_t time_ns)>;

/// The images of the twin's infrared camera: hands, forearms and sleeves lit by a lamp beside the
/// lens, and by the sun, over a background, with motion blur, point spread, vignetting, noise and
/// faults. Reuses its buffers: not thread-safe.
class CameraScene {
 public:
  /// Copies the settings and the camera. `seed` selects the noise and the holes.
  CameraScene(const config::TwinImage& settings, int seed, const calib::PlacedCamera& camera);

  /// Sets one hand, which must outlive the scene. A hand that was not set is not drawn.
  void set_hand(Side side, const TrueHand& truth);

  /// Draws frame `k`, exposed for `exposure_ns` around `origin_ns` (ns since the epoch). `image`
  /// must have the size of the camera's image.
  void draw(std::uint64_t k, std::int64_t origin_ns, std::int64_t exposure_ns, const TruthAt& truth,
            renderer::View<std::uint8_t> image);

 private:
  struct Hand {
    const TrueHand* truth = nullptr;
    Forearm forearm;
    std::vector<float> holes;    ///< brightness of each vertex; empty without holes
    std::vector<float> pattern;  ///< see skin_pattern()
  };
  /// One lit surface, projected at one instant of the exposure.
  struct Shot {
    const std::vector<std::array<std::uint16_t, 3>>* triangles = nullptr;
    ScreenVertices screen;
    std::vector<float> grey;
  };

  Shot& next_shot(std::size_t& count);
  void shoot(Shot& shot, glm::vec2 within_pixel);
  /// Appends the hands at one instant to shots_[0 .. count); returns their bounds in the image.
  renderer::Rect shoot_hands(std::int64_t time_ns, const TruthAt& truth, glm::vec2 within_pixel,
                             std::size_t& count);
  void shoot_hand(const Hand& hand, const JointFrames& joints, glm::vec2 within_pixel,
                  std::size_t& count);
  void shoot_solid(const Solid& solid, const glm::mat4& camera_from_solid, float brightness,
                   glm::vec2 within_pixel, std::size_t& count);
  void shoot_reflector(const glm::vec3& tip_m, glm::vec2 within_pixel, std::size_t& count);
  renderer::Rect shoot_face(std::int64_t time_ns, glm::vec2 within_pixel, std::size_t& count);
  void draw_shots(std::size_t first, std::size_t last, float front, const renderer::Rect& region);
  void copy_background(const renderer::Rect& region);
  void finish_background();
  void add_bystander();
  renderer::Rect draw_mirror_image(std::int64_t time_ns, const TruthAt& truth);
  void start_sum(const renderer::Rect& region, const renderer::Rect& done, int instants);
  void expose(std::size_t shots, const renderer::Rect& region);

  config::TwinImage settings_;
  int seed_;
  calib::CameraModel camera_;
  glm::mat4 camera_from_tracker_;
  std::array<Hand, 2> hands_;
  Solid face_;           ///< empty without a face
  Solid object_;         ///< that the hands hold, in the axes of the palm joint; empty without it
  Solid reflector_;      ///< on the index finger tips, in camera axes; empty without it
  bool faulty_ = false;  ///< the frame being drawn has the image faults

  renderer::Image<float> background_;  ///< before the point spread
  ImageSensor sensor_;                 ///< has no empty scene before the first frame
  PointSpread table_spread_;
  renderer::Rect mirrored_;  ///< where mirror_image_ is not 0
  bool in_mirror_ = false;   ///< shoot() reflects the surface in the table
  std::vector<Shot> shots_;
  std::vector<glm::vec3> positions_, normals_;  ///< of the surface for shoot(), camera space
  renderer::Image<float> inverse_depth_, instant_, sum_, mirror_image_;
};

}  // namespace handcast::twin
