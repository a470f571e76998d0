// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

/// The rectangle of a board in its own axes (FlatPicture), m.
struct BoardOutline {
  glm::dvec2 from_m{0};  ///< the corner at the top left
  glm::dvec2 to_m{0};    ///< the corner at the bottom right
};

/// A camera that sees a board.
struct BoardViewer {
  calib::CameraModel camera;
  glm::dmat4 from_first{1};  ///< from the space of the first viewer's camera to its own; rigid
};

/// How a person holds a calibration board in front of the camera: still at one place after the
/// other, with a hand's tremor, and on to the next. The places are all over the images of all
/// viewers, near and far, every fifth about facing the camera and the others tilted in all
/// directions. After the last place the first one follows. A pure function of the arguments.
class HeldBoard {
 public:
  static constexpr int kPlaces = 30;
  static constexpr double kMove_s = 0.8;     ///< from one place to the next
  static constexpr double kMost_deg = 40;    ///< largest angle to the image plane
  static constexpr double kTremor_m = 1e-4;  ///< amplitude of each of two waves per axis

  /// `hold_s`: time at each place, above 0. The places depend on the fields of view of `viewers`
  /// (at least one) and on the size of the board, which is farther away if it does not fit into an
  /// image.
  HeldBoard(std::span<const BoardViewer> viewers, const BoardOutline& board, int seed,
            double hold_s);
  /// The same for one viewer.
  HeldBoard(const calib::CameraModel& camera, const BoardOutline& board, int seed, double hold_s);

  /// The pose of the board's axes in the space of the first viewer at a time since the epoch.
  glm::dmat4 camera_from_board(double seconds) const;

 private:
  struct Place {
    glm::dvec3 centre_m;  ///< of the board, in camera space
    glm::dquat turn;
  };
  glm::dquat turn_at(std::uint64_t i) const;
  Place make_place(std::uint64_t i, std::span<const BoardViewer> viewers) const;
  glm::dvec3 tremor_m(double seconds) const;

  Random random_;
  double hold_s_;
  glm::dvec2 centre_m_, half_m_;  ///< of the board, in its axes
  std::vector<Place> places_;
};

}  // namespace handcast::twin
