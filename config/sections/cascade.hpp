// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "config/settings/field.hpp"

/// The settings of the cascade: one section for each step.
namespace handcast::config {

/// How a pose is extrapolated to the time of the light (docs/method.md#predict).
enum class PredictMethod {
  hold,          ///< the newest pose, unchanged
  velocity,      ///< constant velocity of the two newest samples
  acceleration,  ///< and the part of the acceleration that exceeds the noise
};
constexpr std::array<std::string_view, 3> words_of(PredictMethod) {
  return {"hold", "velocity", "acceleration"};
}

/// [cascade.predict]
struct Predict {
  PredictMethod method = PredictMethod::acceleration;
  double limit_ms = 40;
  double still_mm_s = 8;
};

template <class Visitor>
void describe(Visitor& visitor, Predict& predict) {
  visitor.field("method", predict.method,
                "hold: the newest pose, unchanged. velocity: extrapolated to the time of the light "
                "at the constant velocity of the two newest samples. acceleration: like velocity, "
                "with the part of the acceleration that exceeds the tracker's noise.");
  visitor.field("limit_ms", predict.limit_ms, between(0, 200, "ms"),
                "Longest extrapolation beyond the newest sample; later the pose is held.");
  visitor.field("still_mm_s", predict.still_mm_s, between(0, 1000, "mm/s"),
                "A joint slower than this is not extrapolated but rests at its recent mean, so "
                "that the light on a still hand is still.");
}

/// [cascade.skin]
struct Skin {
  bool fit = true;
  bool widths = true;
};

template <class Visitor>
void describe(Visitor& visitor, Skin& skin) {
  visitor.field("fit", skin.fit,
                "true: aim and stretch each bone of the drawn hand so that it reaches the "
                "tracker's next joint. false: move each bone rigidly with its own joint.");
  visitor.field(
      "widths", skin.widths,
      "With fit: estimate the widths of the person's fingers from the mask of the camera image.");
}

/// How landmarks Q of an older image are carried to the time of the light; P are the joints of the
/// tracker in the image (docs/method.md#filter, docs/method.md#estimate).
enum class FilterMethod {
  none,         ///< landmarks are not used
  naive,        ///< Q, unchanged
  kalman,       ///< a constant-velocity Kalman filter on Q
  paper,        ///< Q + P_now - P_then (paper, "Moving Least Squares Deformation")
  articulated,  ///< the most likely hand, by one estimate of the tracker's errors
  ideal,        ///< the true landmarks; only in the simulator
};
constexpr std::array<std::string_view, 6> words_of(FilterMethod) {
  return {"none", "naive", "kalman", "paper", "articulated", "ideal"};
}

/// [cascade.filter]
struct Filter {
  FilterMethod method = FilterMethod::articulated;
  double motion_process = 3e6;
  double noise_px = 1.14;
  double blend_ms = 6;
  double blend_px = 8;
  double lost_ms = 300;

  bool operator==(const Filter&) const = default;  ///< compares all members
};

template <class Visitor>
void describe(Visitor& visitor, Filter& filter) {
  visitor.field(
      "method", filter.method,
      "How landmarks Q of an older image are carried to the time of the light; P are the "
      "tracker's joints in the image. none: landmarks are not used. naive: Q, unchanged. "
      "kalman: a constant-velocity Kalman filter on Q, without the tracker. paper: Q + "
      "P_now - P_then for each joint. articulated: the hand is drawn without the tracker's most "
      "likely errors, or as by kalman while they are not known. ideal: the true landmarks, which "
      "only the simulator knows.");
  visitor.field(
      "motion_process", filter.motion_process, between(0, 1e12, "px^2/s^3"),
      "kalman, articulated: process noise, the spectral density of a landmark's acceleration.");
  visitor.field(
      "noise_px", filter.noise_px, between(0.01, 50, "px"),
      "kalman, articulated: measurement noise, the standard deviation of a landmark per axis.");
  visitor.field("blend_ms", filter.blend_ms, between(0, 50, "ms"),
                "Time constant with which the jump caused by a new tracker sample or detection is "
                "blended in: larger is steadier, smaller is faster. 0: no blending.");
  visitor.field("blend_px", filter.blend_px, between(0, 100, "px"),
                "The largest part of a jump that is blended in; the rest is shown at once, so that "
                "fast motion is not delayed.");
  visitor.field("lost_ms", filter.lost_ms, between(1, 10000, "ms"),
                "Landmarks older than this fade out; then the tracker is used alone.");
}

/// How the drawing is moved onto the landmarks (docs/method.md#correct).
enum class CorrectMethod {
  none,      ///< not at all
  grid,      ///< moving least squares on a grid over the image
  vertices,  ///< similarities of the bones, applied to the vertices
};
constexpr std::array<std::string_view, 3> words_of(CorrectMethod) {
  return {"none", "grid", "vertices"};
}

/// The landmarks that control the grid.
enum class GridPoints {
  all,       ///< all 21
  released,  ///< the 16 of the program that the paper's authors released
};
constexpr std::array<std::string_view, 2> words_of(GridPoints) { return {"all", "released"}; }

/// [cascade.correct]
struct Correct {
  CorrectMethod method = CorrectMethod::vertices;
  double alpha = 1.0;
  int grid_columns = 21;
  int grid_rows = 21;
  GridPoints grid_points = GridPoints::all;
  int grid_hands = 2;
  double bone_short_px = 8;
  double bone_long_px = 24;
  bool outline = true;
};

template <class Visitor>
void describe(Visitor& visitor, Correct& correct) {
  visitor.field("method", correct.method,
                "How the drawing is moved onto the landmarks. none: not at all. grid: similarity "
                "moving least squares on a grid over the whole image, as in the paper. vertices: "
                "the similarities of the bones, blended by skin weights; moving least squares for "
                "bones that are foreshortened.");
  visitor.field("alpha", correct.alpha, between(0.1, 4),
                "Moving least squares: the weights are distance^(-2 alpha).");
  visitor.field("grid_columns", correct.grid_columns, between(3, 201),
                "grid: number of nodes across the image.");
  visitor.field("grid_rows", correct.grid_rows, between(3, 201),
                "grid: number of nodes down the image.");
  visitor.field(
      "grid_points", correct.grid_points,
      "grid: the landmarks that control it. released: 16, as in the program that the "
      "paper's authors released: not the thumb's root, nor the middle joints of the other "
      "fingers.");
  visitor.field(
      "grid_hands", correct.grid_hands, between(1, 2),
      "grid: the drawing is corrected while there are at most so many hands; 1 as in that "
      "program.");
  visitor.field(
      "bone_short_px", correct.bone_short_px, between(0, 200, "px"),
      "vertices: a bone whose image is shorter than this is moved by moving least squares.");
  visitor.field("bone_long_px", correct.bone_long_px, between(1, 400, "px"),
                "vertices: a bone whose image is longer than this is moved by its similarity; "
                "between the two lengths both are blended.");
  visitor.field("outline", correct.outline,
                "vertices: move the fingers sideways, and their tips along them, until the drawn "
                "outline lies on that of the mask.");
}

/// [cascade.mask]
struct Mask {
  double threshold = 0;
  double forearm_mm = 14;
  bool advance = true;
};

template <class Visitor>
void describe(Visitor& visitor, Mask& mask) {
  visitor.field("threshold", mask.threshold, between(0, 255),
                "Grey value above which a pixel can belong to the hand. 0: chosen for each image.",
                Effect::live);
  visitor.field(
      "forearm_mm", mask.forearm_mm, between(-100, 400, "mm"),
      "Where the hand ends on the forearm, measured from the wrist joint towards the elbow.");
  visitor.field(
      "advance", mask.advance,
      "Move the mask with the hand from the time of the exposure to the time of the light.",
      Effect::live);
}

/// The method of late registration (docs/method.md#register).
enum class RegisterMethod {
  none,  ///< off
  mask,  ///< the outline of the hand is searched in the newest image
};
constexpr std::array<std::string_view, 2> words_of(RegisterMethod) { return {"none", "mask"}; }

/// [cascade.register]
struct Registration {
  RegisterMethod method = RegisterMethod::mask;
  double limit_px = 24;
};

template <class Visitor>
void describe(Visitor& visitor, Registration& registration) {
  visitor.field("method", registration.method,
                "Late registration. none: off. mask: the outline of the hand at the tracker's "
                "newest sample is searched in the newest image; its motion beyond that of the "
                "tracker is applied to the landmarks.");
  visitor.field("limit_px", registration.limit_px, between(1, 200, "px"),
                "An outline that moved further than this is rejected.");
}

/// How far hands are corrected: msg::Rung (docs/method.md#ladder).
enum class RungChoice {
  hold,
  predict,
  shift,
  similarity,
  fingers,
  landmarks,
  registered,
};
constexpr std::array<std::string_view, 7> words_of(RungChoice) {
  return {"hold", "predict", "shift", "similarity", "fingers", "landmarks", "register"};
}

/// [cascade.ladder]
struct Ladder {
  RungChoice rung = RungChoice::registered;
};

template <class Visitor>
void describe(Visitor& visitor, Ladder& ladder) {
  visitor.field("rung", ladder.rung,
                "How far hands are corrected, the least first; each rung does what the one before "
                "it does, and more. All but register are there to be compared with it.");
}

/// How light beside the hand and parts of the hand without light are treated (docs/method.md#fill).
enum class FillMethod {
  none,     ///< not at all; the drawing is not masked either
  reflect,  ///< filled from the nearest lit pixel, with reflected texture coordinates
};
constexpr std::array<std::string_view, 2> words_of(FillMethod) { return {"none", "reflect"}; }

/// [cascade.fill]
struct Fill {
  FillMethod method = FillMethod::reflect;
  int reach_px = 32;
  double fade_px = 8;
  double seam_uv = 0.04;
};

template <class Visitor>
void describe(Visitor& visitor, Fill& fill) {
  visitor.field("method", fill.method,
                "none: the drawing, not masked by the camera image. reflect: light beside the hand "
                "is removed, and parts of the hand without light are filled from the nearest lit "
                "pixel with reflected texture coordinates.");
  visitor.field("reach_px", fill.reach_px, between(1, 32, "px"),
                "The largest distance of the lit pixel from which a pixel is filled.");
  visitor.field("fade_px", fill.fade_px, between(0, 32, "px"),
                "The last part of that distance, over which the fill fades to dark.");
  visitor.field("seam_uv", fill.seam_uv, between(0, 1),
                "A reflected step in texture coordinates larger than this crosses a seam of the "
                "texture; then the coordinates of the lit pixel are used.");
}

/// [cascade]
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
  visitor.section("predict", cascade.predict,
                  "Prediction of the hand's pose at the time of the light.", Effect::live);
  visitor.section("skin", cascade.skin, "Fit of the drawn hand to the pose.", Effect::live);
  visitor.section("filter", cascade.filter, "Prediction of the landmarks at the time of the light.",
                  Effect::live);
  visitor.section("correct", cascade.correct, "Motion of the drawing onto the landmarks.",
                  Effect::live);
  visitor.section("mask", cascade.mask, "The pixels of the camera image that show the hand.");
  visitor.section("register", cascade.registration,
                  "Late registration with the newest camera image.", Effect::live);
  visitor.section("fill", cascade.fill,
                  "Removal of light beside the hand, and fill of parts without light.",
                  Effect::live);
  visitor.section("ladder", cascade.ladder, "Choice of the cheapest correction that suffices.",
                  Effect::live);
}

}  // namespace handcast::config
