// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// What is in front of the twin's camera in place of hands.
enum class TwinPropKind {
  none,   ///< nothing: hands are
  board,  ///< a calibration board that a person holds
};
constexpr std::array<std::string_view, 2> words_of(TwinPropKind) { return {"none", "board"}; }

/// Through the images of which cameras a person moves the board.
enum class TwinPropViews {
  first,   ///< that of [camera]
  second,  ///< that of [camera2]
  both,    ///< where both see it
};
constexpr std::array<std::string_view, 3> words_of(TwinPropViews) {
  return {"first", "second", "both"};
}

/// [twin.prop]
struct TwinProp {
  TwinPropKind kind = TwinPropKind::none;
  double hold_s = 2;
  std::string board = "charuco:11x8:20";
  TwinPropViews views = TwinPropViews::first;
  double light_late_ms = 0;
  double light_gamma = 0;
};

template <class Visitor>
void describe(Visitor& visitor, TwinProp& prop) {
  visitor.field("kind", prop.kind,
                "What is in front of the camera in place of hands. board: a calibration board "
                "that a person moves through the image.");
  visitor.field("hold_s", prop.hold_s, between(0.2, 60, "s"),
                "How long the board is held still at each place.");
  visitor.field("board", prop.board,
                "The board: KIND:COLUMNSxROWS:MM with the kinds charuco, checkerboard and circles, "
                "as for `handcast calibrate --board`.");
  visitor.field(
      "views", prop.views,
      "Through the images of which cameras the board is moved. second and both need a rig "
      "with two cameras.");
  visitor.field("light_late_ms", prop.light_late_ms, between(-100, 200, "ms"),
                "How much later than the projector reports its light falls on the board.");
  visitor.field("light_gamma", prop.light_gamma, between(0, 5),
                "The true projector turns a level 0..1 into the light level^light_gamma. 0: as in "
                "sRGB.");
}

}  // namespace handcast::config
