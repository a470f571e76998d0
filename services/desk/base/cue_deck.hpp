// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// The cue list as it runs, for those who show it.
struct CuePlace {
  std::vector<std::string> names;  ///< of all cues, in their order
  int current = -1;                ///< the cue that was started last; -1: none yet
  int next = 0;                    ///< the one that go() starts; names.size(): the list is over
  bool is_held = false;            ///< hold() was called
  double faded = 1;                ///< how much of the fades of `current` is done, 0..1
};

/// The commands of the cue list, for whatever a person presses: the page, OSC, MIDI, a key. Any
/// thread; they take effect at the next turn of the desk's main thread and do not block.
class CueDeck {
 public:
  virtual ~CueDeck() = default;

  /// Starts the next cue. At the end of the list nothing happens.
  virtual void go() = 0;
  /// Starts the cue before the current one again.
  virtual void back() = 0;
  /// Stops the fades and all triggers where they are; once more, or go(): they go on.
  virtual void hold() = 0;
  /// Starts the cue with a name, or a number from 1. Errors: bad_config (there is none).
  virtual Result<void> jump(std::string_view cue) = 0;
  /// Starts the cues whose trigger is this key. No key of a cue: nothing happens.
  virtual void key(std::string_view key) = 0;
  /// Where the list is.
  virtual std::shared_ptr<const CuePlace> place() const = 0;
};

}  // namespace handcast::desk
