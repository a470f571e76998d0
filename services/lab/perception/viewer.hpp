// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

/// What people see of light that is late, as a model of a viewer. `docs/method.md#viewer` explains
/// it and says what it cannot know.
namespace handcast::perception {

/// From where people look at hands: arm's length, m.
inline constexpr double kArmsLength_m = 0.6;

/// The speed of a point at arm's length as the eye sees it.
double degrees_per_s(double speed_m_s);

/// What there is to see of late light.
struct Cues {
  /// The share of the hand's outline along which the edge of the light is seen inside the hand,
  /// 0..1: 1 without a fill, 0 if all of the hand is lit.
  double edges = 1;
  /// Contrast (Michelson) of what tells a place of the skin from another. Default: measured in
  /// pictures of real hands.
  double skin_contrast = 0.045;
};

/// The delay of light that a viewer notices in 75 % of the comparisons with light that is not late,
/// ms. `speeds_deg_s`: of places of the hand, at all times alike; infinity if none moves. Two cues
/// are pooled over all of them by probability summation (Quick 1974): the gap at the edge of the
/// light, and the slip of the picture over the skin.
double jnd_ms(std::span<const double> speeds_deg_s, const Cues& cues);

/// How likely the viewer is to pick the late one of two lights, 0.5 to 1, if the other is not late:
/// detectability grows in proportion to the delay (2IFC; Green and Swets 1966).
/// `lapse`: the share of answers that are given blindly.
double picks_late(double delay_ms, double jnd_ms, double lapse = 0);

}  // namespace handcast::perception
