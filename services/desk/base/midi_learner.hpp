// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// The MIDI controller, for those who show it.
struct MidiState {
  std::string device;    ///< its name; empty: it is not there
  std::string learning;  ///< what the next knob or key that is moved will turn; empty: nothing
  /// What is turned ("light.master", "cue.go") and by what ("controller 7 of channel 1").
  std::vector<std::pair<std::string, std::string>> bindings;
};

/// Which knob, fader or key of a MIDI controller turns what. Any thread;
/// no function blocks for longer than those of the panel.
class MidiLearner {
 public:
  virtual ~MidiLearner() = default;

  /// Binds the next controller that is moved, or key that is pressed within 30 s, to a live setting
  /// ("light.master") or a command: "cue.go", "cue.back", "cue.hold", "cue.jump NAME", "cue.key K",
  /// "preset NAME", "undo", "redo". It replaces what turned it before. Errors: bad_config (no such
  /// setting or command, or a text that no knob can turn).
  virtual Result<void> learn(std::string_view path) = 0;
  /// Ends learn() without a binding.
  virtual void stop_learning() = 0;
  /// Removes the binding of a path.
  virtual void forget(std::string_view path) = 0;
  virtual MidiState state() const = 0;
};

}  // namespace handcast::desk
