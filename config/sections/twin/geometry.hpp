// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/settings/field.hpp"

namespace handcast::config {

/// [twin.geometry]
struct TwinGeometry {
  double projector_offset_mm = 0;
  double plane_mm = 0;
  double homography_px = 0;
  double tracker_mm = 0;
  double tracker_deg = 0;
  double lens_px = 0;
  std::string calibration;
};

template <class Visitor>
void describe(Visitor& visitor, TwinGeometry& geometry) {
  visitor.field(
      "projector_offset_mm", geometry.projector_offset_mm, between(0, 500, "mm"),
      "Distance of the projector's optical centre from the camera's, in a direction drawn "
      "from the seed. The homography is right at one distance only.");
  visitor.field("plane_mm", geometry.plane_mm, between(-500, 500, "mm"),
                "That distance, relative to 730 mm: positive is farther.");
  visitor.field("homography_px", geometry.homography_px, between(0, 50, "px"),
                "Error of the homography at each corner of the image: RMS, projector px.");
  visitor.field(
      "tracker_mm", geometry.tracker_mm, between(0, 100, "mm"),
      "Error of the tracker's position in the camera's axes, in a direction drawn from the "
      "seed.");
  visitor.field("tracker_deg", geometry.tracker_deg, between(0, 20, "deg"),
                "Error of the tracker's rotation, about an axis through the middle of the hand's "
                "working volume, drawn from the seed.");
  visitor.field("lens_px", geometry.lens_px, between(0, 20, "px"),
                "Error of the lens's model in the corners of the image.");
  visitor.field("calibration", geometry.calibration,
                "Calibration file of the true rig, before these errors: for a rig whose own "
                "calibration was measured on the twin. Empty: the rig's own.");
}

}  // namespace handcast::config
