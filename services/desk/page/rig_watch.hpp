// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "services/desk/base/cue_deck.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"
#include "services/desk/page/board.hpp"

namespace handcast::desk {

/// Tells open pages how the rig is: the values of the controls 30 times a second, the hands and the
/// cues 10 times, services, content and the ages of the light twice. A thread of its own, which
/// sleeps while no page is open.
class RigWatch {
 public:
  /// All outlive this; `cues` may be null.
  RigWatch(std::string rig, Panel& panel, CueDeck* cues, Board& board);
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
  void tell_status();
  void tell_content();
  void tell_ages();

  std::string rig_;
  Panel& panel_;
  CueDeck* cues_;
  Board& board_;
  std::unique_ptr<Streams> streams_;
  std::mutex mutex_;  ///< of `gestures_`
  std::array<Gesture, msg::kMaxHands> gestures_{};
  std::thread thread_;
};

}  // namespace handcast::desk
