// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

/// Random numbers without state: each number is a pure function of (seed, stream, index), so that
/// several processes can draw any sample in any order and agree.
namespace handcast::twin {

/// The purpose of a random number. Numbers of different streams are independent.
enum class Stream : std::uint64_t {
  person,            ///< shape of the true hands
  tracker_time,      ///< jitter of the sample times
  tracker_age,       ///< delay of a sample
  tracker_loss,      ///< lost samples
  tracker_place,     ///< constant offset and rotation
  tracker_drift,     ///< frequencies and phases of the drift
  tracker_noise,     ///< white noise of the joints
  detector_age,      ///< delay of a detection
  detector_loss,     ///< detections without a hand
  detector_noise,    ///< white noise of the landmarks
  image_noise,       ///< noise of the pixels
  detector_outlier,  ///< displaced landmarks
  image_holes,       ///< dark blobs on the hands
  flesh,             ///< widths, thickness and roll of the true flesh
  geometry,          ///< errors of the calibration
  frame_time,        ///< time that a frame takes
  image_texture,     ///< noise of the skin
  image_clutter,     ///< things behind the hands
  tracker_joints,    ///< where the tracker sees the joints of the person
  tracker_fingers,   ///< frequencies and phases of the drift of whole fingers
  tracker_guess,     ///< flexion of hidden fingers
  tracker_snap,      ///< sudden wrong flexions of a finger
  tracker_clock,     ///< errors of the tracker's stamps
  tracker_burst,     ///< samples that arrive with the next one
  camera_loss,       ///< lost frames
  camera_burst,      ///< frames that arrive with the next one
  camera_clock,      ///< errors of the camera's stamps
  detector_near,     ///< landmarks that are displaced by a little
  detector_bias,     ///< error of the landmarks that depends on the pose
  board,             ///< where the calibration board is held
};

/// The splitmix64 step (Steele, Lea, Flood 2014): a bijection that scrambles all 64 bits.
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// The numbers of one stream, each selected by an index (a, b).
class Random {
 public:
  /// The numbers of `stream` that belong to `seed`.
  Random(int seed, Stream stream)
      : key_(mixed(mixed(static_cast<std::uint64_t>(seed)) ^ static_cast<std::uint64_t>(stream))) {}

  /// 64 random bits.
  std::uint64_t bits(std::uint64_t a, std::uint64_t b = 0) const {
    return mixed(mixed(key_ ^ a) + b);
  }
  /// Uniform in [0, 1).
  double uniform(std::uint64_t a, std::uint64_t b = 0) const {
    return static_cast<double>(bits(a, b) >> 11) * 0x1p-53;
  }
  /// Uniform in [-1, 1).
  double spread(std::uint64_t a, std::uint64_t b = 0) const { return 2 * uniform(a, b) - 1; }
  /// Standard normal (Box and Muller 1958).
  double normal(std::uint64_t a, std::uint64_t b = 0) const {
    const std::uint64_t first = bits(a, b);
    const double radius =
        std::sqrt(-2 * std::log((static_cast<double>(first >> 11) + 0.5) * 0x1p-53));
    return radius *
           std::cos(2 * std::numbers::pi * static_cast<double>(mixed(first) >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t key_;
};

}  // namespace handcast::twin
