// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "renderer/pipeline/pipeline.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::simulate {

/// The part of a signal between 1 and 30 Hz, where people see trembling: a Butterworth high-pass
/// and a low-pass of second order each (bilinear transform). It starts in the steady state of its
/// first sample.
class BandPass {
 public:
  /// For samples at `rate_hz`, more than 60.
  explicit BandPass(double rate_hz);
  /// Takes the next sample and returns the output for it.
  glm::dvec2 operator()(glm::dvec2 sample);

 private:
  /// A filter of second order in direct form I; the feedback of y[n - 1] and y[n - 2] is `a`.
  struct Section {
    std::array<double, 3> b{};
    std::array<double, 2> a{};
    std::array<glm::dvec2, 2> x{}, y{};

    glm::dvec2 operator()(glm::dvec2 sample);
  };
  Section high_, low_;
  bool started_ = false;
};

/// RMS of the trembling of several points on each hand while the hand is slow. Points that are
/// absent for a sample start anew. One thread.
class JitterMeter {
 public:
  /// The displacements of the points of one hand from where they belong, px; empty: not seen.
  using Points = std::vector<std::optional<glm::dvec2>>;

  /// Adds one sample; samples must come in the order of their times. After a gap the hand starts
  /// anew. `speed_m_s`: of the hand; faster than kSlow_m_s it is not counted.
  void add(msg::Side side, std::int64_t time_ns, const Points& points, double speed_m_s);
  /// The RMS over all points and samples, px; empty if there are none, or if samples come too
  /// rarely for the band (60 Hz or less).
  std::optional<double> rms_px() const;

  /// Up to this speed of the hand people see trembling rather than motion.
  static constexpr double kSlow_m_s = 0.1;

 private:
  struct Hand {
    std::int64_t last_ns = 0, period_ns = 0;
    std::vector<std::optional<BandPass>> filters;  ///< by point
    std::vector<int> lengths;                      ///< samples since the filter's start
  };
  std::array<Hand, msg::kMaxHands> hands_;
  double square_px2_ = 0;
  std::int64_t samples_ = 0;
};

/// The displacements of the light by part of the hand; a part with few lit points is not seen.
JitterMeter::Points light_points(const twin::FrameScore::Hand& hand);
/// The displacements of the corrected landmarks from the true ones.
JitterMeter::Points landmark_points(const renderer::FrameHand& hand,
                                    const std::array<glm::vec2, msg::kLandmarks>& truth);

}  // namespace handcast::simulate
