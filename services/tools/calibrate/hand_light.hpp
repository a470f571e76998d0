// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/board/grey_view.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/tools/calibrate/findings.hpp"

namespace handcast::calibrate {

/// How often each grey value 0..255 was seen.
class GreyCount {
 public:
  void add(std::uint8_t grey) {
    ++counts_[grey];
    ++total_;
  }
  std::uint64_t total() const { return total_; }
  std::uint64_t of(int grey) const { return counts_[static_cast<std::size_t>(grey)]; }
  /// The least grey value that a share of all is at or below; 0 without any.
  int percentile(double share) const;
  /// The share of all that is at or above a grey value.
  double share_from(int grey) const;

 private:
  std::array<std::uint64_t, 256> counts_{};
  std::uint64_t total_ = 0;
};

/// What the projector did while an image was taken.
enum class Lighting { unknown, dark, full };

/// The camera's view of a hand: how bright the hand, its finger tips and what is behind it are, and
/// how steady that is. One thread.
class HandLight {
 public:
  explicit HandLight(const calib::CameraModel& camera) : camera_(camera) {}

  /// Adds an image with the landmarks that were found in it. Landmarks outside the image are left
  /// out. What lies beyond the wrist counts as neither: it is the forearm.
  void add(const calib::GreyView& image, const msg::HandLandmarks& hand, Lighting lighting);

  /// What was seen so far.
  /// @{
  const GreyCount& hand() const { return hand_; }
  const GreyCount& tips() const { return tips_; }
  const GreyCount& background() const { return background_; }
  std::size_t images() const { return means_.size(); }
  /// @}
  /// By how much the hand's brightness changes from one image to the next at the same lighting:
  /// robust standard deviation as a share of its mean. 0 with fewer than 10 images.
  double flicker() const;
  /// How much brighter the hand is in the projector's full light than in none: means of grey
  /// values; 0 if one of the two was not seen.
  double leak() const;

 private:
  struct Mean {
    double grey;
    Lighting lighting;
  };

  calib::CameraModel camera_;
  GreyCount hand_, tips_, background_;
  std::vector<Mean> means_;  ///< of the hand, in the order of the images
};

/// The settings on which advice depends.
struct CameraSettings {
  double exposure_ms = 0;          ///< camera.exposure_ms
  double longest_exposure_ms = 0;  ///< that the camera's rate permits
  double threshold = 0;            ///< cascade.mask.threshold; 0: chosen for each image
};

/// What a person should change so that the hand is seen well, most important first; one sentence
/// each. Empty if all is well.
std::vector<std::string> advice_on(const HandLight& light, const CameraSettings& settings);

/// A grey value between hand and background, in the middle between the brightest quarter of the
/// background and the darkest tenth of the finger tips.
int threshold_between(const HandLight& light);

/// A picture of the three histograms and the threshold.
Picture histograms_picture(const HandLight& light);

}  // namespace handcast::calibrate
