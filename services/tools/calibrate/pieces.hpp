// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "services/tools/calibrate/session.hpp"

/// The report of a calibration: an HTML page and its pieces.
namespace handcast::calibrate {

/// The section of a step.
std::string piece_html(Step step, const Outcome& outcome);

/// A step that the rig has need of, in the report.
struct Reported {
  Step step;
  std::string made;  ///< what was measured, and when; may be empty
  bool is_done = false;
};
/// The page: whether all is measured and what to do next, one line for each step, and `pieces`, the
/// sections of the steps. `command`: for the commands in it.
std::string report_html(const std::string& rig, const NamedFiles& command,
                        std::span<const Reported> steps, const std::string& pieces);

}  // namespace handcast::calibrate
