// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "config/settings/field.hpp"

/// The settings of the cascade: one section per step, in the order the steps run.
namespace handcast::config {

/// How a pose is taken to the time of the photons.
enum class PredictMethod {
  hold,          ///< the newest pose as it is
  velocity,      ///< constant velocity of the two newest samples
  acceleration,  ///< and as much of the acceleration as stands out of the noise
};
constexpr std::array<std::string_view, 3> words_of(PredictMethod) {
  return {"hold", "velocity", "acceleration"};
}

struct Predict {
  PredictMethod method = PredictMethod::acceleration;
  double limit_ms = 40;
  double still_mm_s = 8;
};

template <class Visitor>
void describe(Visitor& visitor, Predict& predict) {
  visitor.field("method", predict.method,
                "hold: the newest pose as it is. velocity: two-point constant velocity to the time "
                "of the photons. acceleration: the same "
                "and as much "
                "of the acceleration as stands out of the tracker's noise.");
  visitor.field("limit_ms", predict.limit_ms, between(0, 200, "ms"),
                "How far beyond the newest sample a pose is extrapolated; then it is held.");
  visitor.field(
      "still_mm_s", predict.still_mm_s, between(0, 1000, "mm/s"),
      "Below this speed a joint is held, not extrapolated: a still hand gives still light.");
}

struct Skin {
  bool fit = true;
  bool widths = true;
};

template <class Visitor>
void describe(Visitor& visitor, Skin& skin) {
  visitor.field("fit", skin.fit,
                "Aim and stretch every bone of the drawn hand to reach the tracker's next joint. "
                "false: move it stiffly with its own joint.");
  visitor.field("widths", skin.widths,
                "With fit: learn how wide the person's fingers are from the camera's mask.");
}

/// How old landmarks Q become landmarks at the time of the photons. P: the tracker's.
enum class FilterMethod {
  none,           ///< not at all
  naive,          ///< as they were seen
  kalman,         ///< a constant-velocity Kalman filter on Q
  paper,          ///< Q + P_now - P_then per joint
  one_euro,       ///< a one-euro filter on the offset Q - P
  offset_kalman,  ///< a constant-velocity Kalman filter on that offset
  ideal,          ///< where they truly are; the simulator only
};
constexpr std::array<std::string_view, 7> words_of(FilterMethod) {
  return {"none", "naive", "kalman", "paper", "one_euro", "offset_kalman", "ideal"};
}

struct Filter {
  FilterMethod method = FilterMethod::offset_kalman;
  double process = 3e3;
  double motion_process = 3e6;
  double noise_px = 1.14;
  double one_euro_cutoff_hz = 3;
  double one_euro_beta = 0.05;
  double blend_ms = 6;
  double blend_px = 8;
  bool hindsight = true;
  double lost_ms = 300;
};

template <class Visitor>
void describe(Visitor& visitor, Filter& filter) {
  visitor.field("method", filter.method,
                "How old landmarks Q become landmarks now. none: not at all. naive: as they were "
                "seen. kalman: a constant-velocity Kalman filter on "
                "Q, "
                "without the tracker. paper: Q + P_now - P_then per joint. one_euro: a one-euro "
                "filter on the offset Q - P. offset_kalman: a "
                "constant-velocity Kalman filter on that offset. ideal: where they truly are, "
                "which only the simulator knows.");
  visitor.field("process", filter.process, between(0, 1e9, "px^2/s^3"),
                "offset_kalman: how fast the offset may change.");
  visitor.field("motion_process", filter.motion_process, between(0, 1e12, "px^2/s^3"),
                "kalman: how fast a landmark's speed may change.");
  visitor.field("noise_px", filter.noise_px, between(0.01, 50, "px"),
                "kalman, offset_kalman: standard deviation of a landmark.");
  visitor.field("one_euro_cutoff_hz", filter.one_euro_cutoff_hz, between(0.01, 100, "Hz"),
                "one_euro: cutoff for an offset that rests.");
  visitor.field("one_euro_beta", filter.one_euro_beta, between(0, 10, "1/px"),
                "one_euro: how much the cutoff rises with the offset's speed.");
  visitor.field("blend_ms", filter.blend_ms, between(0, 50, "ms"),
                "The jump each new sample makes is blended in over this time: larger is stiller, "
                "smaller is quicker. 0: not at all.");
  visitor.field("blend_px", filter.blend_px, between(0, 100, "px"),
                "Of a jump no more than this is held back: fast motion is not delayed.");
  visitor.field("hindsight", filter.hindsight,
                "Take P at the landmarks' time from tracker samples that arrived since, not as it "
                "was predicted then.");
  visitor.field("lost_ms", filter.lost_ms, between(1, 10000, "ms"),
                "Landmarks older than this fade out and the tracker alone is used.");
}

/// How the drawing is moved onto the landmarks.
enum class CorrectMethod {
  none,      ///< not at all
  grid,      ///< moving least squares on a grid over the image
  vertices,  ///< per-bone similarities at the vertices
};
constexpr std::array<std::string_view, 3> words_of(CorrectMethod) {
  return {"none", "grid", "vertices"};
}

struct Correct {
  CorrectMethod method = CorrectMethod::vertices;
  double alpha = 1.0;
  int grid_columns = 21;
  int grid_rows = 21;
  double bone_short_px = 8;
  double bone_long_px = 24;
};

template <class Visitor>
void describe(Visitor& visitor, Correct& correct) {
  visitor.field("method", correct.method,
                "How the drawing is moved onto the landmarks. grid: similarity moving least "
                "squares on a grid over the whole image, as in the paper. "
                "vertices: per-bone similarities blended by skin weights, handing over to moving "
                "least squares where a bone is foreshortened.");
  visitor.field("alpha", correct.alpha, between(0.1, 4),
                "Moving least squares: weights fall with distance^(-2 alpha).");
  visitor.field("grid_columns", correct.grid_columns, between(3, 201),
                "grid: nodes across the image.");
  visitor.field("grid_rows", correct.grid_rows, between(3, 201), "grid: nodes down the image.");
  visitor.field("bone_short_px", correct.bone_short_px, between(0, 200, "px"),
                "vertices: a bone seen shorter than this is left to moving least squares.");
  visitor.field(
      "bone_long_px", correct.bone_long_px, between(1, 400, "px"),
      "vertices: a bone seen longer than this moves as a bone; between the two they are blended.");
}

struct Mask {
  double threshold = 0;
  double forearm_mm = 14;
  bool advance = true;
};

template <class Visitor>
void describe(Visitor& visitor, Mask& mask) {
  visitor.field("threshold", mask.threshold, between(0, 255),
                "Grey value above which a pixel may be hand. 0: chosen from every image.");
  visitor.field(
      "forearm_mm", mask.forearm_mm, between(-100, 400, "mm"),
      "Where the hand ends on the forearm, measured from the wrist joint towards the elbow.");
  visitor.field(
      "advance", mask.advance,
      "Move the mask on with the hand, from the image's exposure to the time of the photons.");
}

/// Late registration.
enum class RegisterMethod {
  none,  ///< not at all
  mask,  ///< the hand's outline is found again in the newest image
};
constexpr std::array<std::string_view, 2> words_of(RegisterMethod) { return {"none", "mask"}; }

struct Registration {
  RegisterMethod method = RegisterMethod::mask;
  double limit_px = 24;
};

template <class Visitor>
void describe(Visitor& visitor, Registration& registration) {
  visitor.field("method", registration.method,
                "Late registration: none: not at all. mask: the outline of the hand at the "
                "tracker's newest time is found again in the newest "
                "image, and what it moved beyond the tracker's motion moves the landmarks.");
  visitor.field("limit_px", registration.limit_px, between(1, 200, "px"),
                "An outline that moved further than this is not believed.");
}

/// The rung a frame is given: chosen frame by frame, or one that is held (ipc/msg/rung.hpp).
enum class RungChoice {
  automatic,
  hold,
  predict,
  shift,
  similarity,
  fingers,
  landmarks,
  registered,
};
constexpr std::array<std::string_view, 8> words_of(RungChoice) {
  return {"auto", "hold", "predict", "shift", "similarity", "fingers", "landmarks", "register"};
}

struct Ladder {
  RungChoice rung = RungChoice::automatic;
  double margin_percent = 5;
  double dwell_ms = 50;
};

template <class Visitor>
void describe(Visitor& visitor, Ladder& ladder) {
  visitor.field(
      "rung", ladder.rung,
      "How much of the cascade a frame is given. auto: the cheapest rung whose expected error is "
      "near the best. Others hold it there.");
  visitor.field(
      "margin_percent", ladder.margin_percent, between(0, 100, "%"),
      "auto: the cheapest rung is taken whose expected error is at most this much above the best.");
  visitor.field("dwell_ms", ladder.dwell_ms, between(0, 10000, "ms"),
                "auto: a cheaper rung must have been enough for this long before it is taken.");
}

/// What is done about light beside the hand and hand without light.
enum class FillMethod {
  none,     ///< nothing; the drawing is not masked either
  reflect,  ///< filled from the nearest lit pixel, its texture coordinates reflected
};
constexpr std::array<std::string_view, 2> words_of(FillMethod) { return {"none", "reflect"}; }

struct Fill {
  FillMethod method = FillMethod::reflect;
  int reach_px = 32;
  double fade_px = 8;
  double seam_uv = 0.04;
};

template <class Visitor>
void describe(Visitor& visitor, Fill& fill) {
  visitor.field("method", fill.method,
                "none: the drawing as it is, not even masked by the camera image. reflect: light "
                "off the hand is removed and hand without "
                "light is filled from the "
                "nearest lit pixel, its texture coordinates reflected.");
  visitor.field("reach_px", fill.reach_px, between(1, 32, "px"),
                "The longest way a pixel is filled from.");
  visitor.field("fade_px", fill.fade_px, between(0, 32, "px"),
                "The last stretch of the reach over which the fill fades to dark.");
  visitor.field("seam_uv", fill.seam_uv, between(0, 1),
                "A reflected step in texture coordinates larger than this crosses a seam: the "
                "seed's own are used.");
}

struct Cascade {
  Predict predict;
  Skin skin;
  Filter filter;
  Correct correct;
  Mask mask;
  Registration registration;
  Fill fill;
  Ladder ladder;
};

template <class Visitor>
void describe(Visitor& visitor, Cascade& cascade) {
  visitor.section("predict", cascade.predict, "Where is the hand when the light arrives?");
  visitor.section("skin", cascade.skin, "Pose the drawn hand.");
  visitor.section("filter", cascade.filter, "Where are the landmarks now?");
  visitor.section("correct", cascade.correct, "Move the drawing onto the landmarks.");
  visitor.section("mask", cascade.mask, "What of the camera image is hand?");
  visitor.section("register", cascade.registration, "Where does the newest image show the hand?");
  visitor.section("fill", cascade.fill, "No light beside the hand, no hand without light.");
  visitor.section("ladder", cascade.ladder, "No more of all this than the scene needs.");
}

}  // namespace handcast::config
