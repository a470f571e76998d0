// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/tools/calibrate/keys.hpp"
#include "services/tools/calibrate/options.hpp"
#include "services/tools/calibrate/own_rig.hpp"
#include "services/tools/calibrate/session.hpp"
#include "services/tools/calibrate/test_screen.hpp"

namespace handcast::calibrate {

/// What a step works with: the rig that runs, and the person at the terminal and in the light.
struct Desk {
  const Options& options;
  const config::Rig& rig;
  const calib::Calibration& used;  ///< what the services of the rig work with
  calib::Calibration& draft;       ///< what is being measured
  OwnRig& own_rig;
  TestScreen& screen;
  Keys& keys;
};

/// Tells a person how a measurement goes: a line in the terminal that is written over, and text on
/// the projector.
class Progress {
 public:
  /// Begins with an instruction. Both must outlive the object.
  Progress(Desk& desk, std::string title);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  ///< Ends the line in the terminal.

  /// Shows how far it is (0..1) and what to do next.
  void show(double share, const std::string& advice);
  /// The same in the terminal alone, while the projector shows something else.
  void say(double share, const std::string& advice);
  /// A sentence on a line of its own in the terminal.
  void note(const std::string& sentence);
  /// False if the step must end: Enter was pressed or its time is over. Looks after the rig.
  Result<bool> goes_on();

 private:
  Desk& desk_;
  std::string title_;
  Deadline end_;
  std::int64_t printed_ns_ = 0;
  bool is_terminal_;
};

}  // namespace handcast::calibrate
