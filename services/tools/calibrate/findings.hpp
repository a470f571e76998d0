// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "config/measured.hpp"
#include "services/tools/calibrate/options.hpp"

/// What a calibration has found out, and its report as JSON: scripts/pages/calibration makes the
/// page of it.
namespace handcast::calibrate {

/// A picture of the report. The page draws it; which numbers each kind has is in
/// scripts/pages/calibration/pictures.py.
struct Picture {
  std::string kind, caption;
  std::map<std::string, std::vector<double>> numbers{};
};

/// An image of this size with dots. Of very many dots, some are left out.
Picture dots_picture(int width_px, int height_px, std::span<const glm::dvec2> dots_px,
                     std::string caption);

/// Bars side by side, numbered from 1: the error of each image or view of a fit.
template <class Views>
Picture errors_picture(const Views& views, std::string caption) {
  Picture picture{"bars", std::move(caption)};
  for (const auto& view : views) {
    picture.numbers["rms_px"].push_back(view.rms_px);
    picture.numbers["is_left_out"].push_back(view.rejected.empty() ? 0 : 1);
  }
  return picture;
}

/// What a step has found out.
struct Outcome {
  std::string made;                   ///< one sentence for the calibration file: how good it is
  bool is_good = true;                ///< false: it must not take the place of what there is
  std::vector<std::string> findings;  ///< what a person should know or do, most important first
  std::vector<Picture> pictures{};    ///< for the report
  std::vector<config::MeasuredSetting> settings{};
  bool is_checked = true;  ///< false: a check could not measure anything, and says why
  std::string meaning{};   ///< for the report: what the figures of `made` are, and which are good
};

/// The outcome as JSON: what the report says of a step.
std::string print_outcome(const Outcome& outcome);

/// What a command must name to go on with a session.
struct NamedFiles {
  std::string rig_file;
  std::string board;     ///< empty: the usual one
  std::string folder;    ///< empty: the one beside the rig file
  std::string option{};  ///< "--second-projector"; else empty
};

/// A step that the rig has need of, in the report.
struct Reported {
  Step step;
  std::string made;  ///< what was measured, and when; may be empty
  bool is_done = false;
};

/// What the report says of the whole session, as JSON. `command`: for the commands in it.
std::string print_report(const std::string& rig, const NamedFiles& command,
                         std::span<const Reported> steps);

}  // namespace handcast::calibrate
