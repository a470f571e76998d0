// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/screen/gray_code.hpp"
#include "calib/solve/screen/screen_fit.hpp"

/// A camera, projectors and boards of which all is known, and what the camera sees of them.
namespace handcast::calib::test {

inline constexpr int kProjectorWidth_px = 1024, kProjectorHeight_px = 768;
inline constexpr double kPlane_m = 0.73;

/// 720 x 540, f = 1162 px, k1 = -0.28.
CameraModel bent_camera();
/// The homography of the reference rig, at every depth.
ProjectorModel coaxial_screen();
/// A projector with its centre there in camera space, turned to the right or left to look at the
/// point in front of the camera at kPlane_m (exactly if the centre is on the x axis).
ProjectorModel screen_from(const glm::dvec3& centre_m);
/// screen_from() on the x axis, to the right of the camera.
ProjectorModel screen_beside(double baseline_m);
/// A board whose middle is at this depth, turned about the axis (1, 0.5, 0).
glm::dvec4 tilted_board(double depth_m, double tilt_rad = 0.2);
/// The depth of a plane along an undistorted pixel.
double depth_of(const glm::dvec4& plane, const CameraModel& camera, const glm::dvec2& px);

/// How the camera sees the light; in grey levels.
struct Scene {
  double contrast = 60, ambient = 40, noise = 3;
  double blur_px = 0.7;       ///< standard deviation
  double vignetting = 0.4;    ///< light missing in the corners of the image
  double squares_m = 0;       ///< printed on the board, every other one black; 0: it is white
  double print_right_m = 0;   ///< the print lies so far to the right, and as far down
  double board_right_m = 10;  ///< the board ends there; the background is dark
  unsigned seed = 1;
};

/// The images of bent_camera() of a plane board under the patterns of a projector.
class RenderedBoard {
 public:
  RenderedBoard(const ProjectorModel& screen, const glm::dvec4& plane, const Scene& scene = {});
  /// The image of a picture of the projector's size.
  std::vector<std::uint8_t> image_of(const std::vector<std::uint8_t>& picture);

 private:
  Scene scene_;
  std::vector<std::int32_t>
      lit_by_;                ///< the projector's pixel of each quarter of a pixel; -1: none
  std::vector<float> board_;  ///< brightness of each pixel under full light
  std::vector<float> noise_;
  std::mt19937 random_;
};

/// Images of all patterns of a code.
struct Shots {
  std::vector<std::vector<std::uint8_t>> images;
  int width_px = 0, height_px = 0;

  std::vector<GreyView> views() const;
};
Shots shoot(const GrayCode& code, RenderedBoard& board);

/// Correspondences of a board without images: on a grid of the camera's image, with noise in the
/// projector's pixels.
std::vector<Correspondence> seen_points(const CameraModel& camera, const ProjectorModel& screen,
                                        const glm::dvec4& plane, double noise_px, unsigned seed,
                                        int step_px = 20);
/// Replaces a share of the points by anything on the projector.
void spoil(std::vector<Correspondence>& points, double share, unsigned seed);

/// The largest error over the camera's image within 100 mm of kPlane_m, projector px.
double worst_px(const ProjectorModel& believed, const ProjectorModel& truth,
                const CameraModel& camera);

}  // namespace handcast::calib::test
