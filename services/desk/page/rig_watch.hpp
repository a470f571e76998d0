// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <mutex>
#include <thread>

#include "services/desk/base/surface.hpp"
#include "services/desk/page/actions.hpp"
#include "services/desk/page/board.hpp"

namespace handcast::desk {

/// Tells open pages how the rig is: the values of the controls 30 times a second, the hands,
/// the cues and the MIDI controller 10 times, services, content, the ages of the light and what was
/// started from the page twice. A thread of its own, which
/// sleeps while no page is open.
class RigWatch {
 public:
  /// Both outlive this.
  RigWatch(const Worked& worked, Board& board);
  /// Waits for the thread.
  ~RigWatch();
  RigWatch(const RigWatch&) = delete;
  RigWatch& operator=(const RigWatch&) = delete;

  /// What the hands do now; never blocks.
  void take(const Scene& scene);

 private:
  struct Streams;

  void watch();
  void tell_hands();
  void tell_cues();
  void tell_midi();
  void tell_status();
  void tell_content();
  void tell_ages();

  const Worked& worked_;
  Board& board_;
  std::unique_ptr<Streams> streams_;
  std::mutex mutex_;  ///< of `gestures_`
  std::array<Gesture, msg::kMaxHands> gestures_{};
  std::thread thread_;
};

}  // namespace handcast::desk
