// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::service {

/// The rig as people have changed it since its start.
struct LiveRig {
  config::Rig rig;
  msg::LiveSettings settings;  ///< what it was made of
};

/// Follows the live settings of a rig. Messages are read and checked on a thread of its own, so
/// that the loop of a service only looks whether there is something new.
class LiveSettings {
 public:
  /// The rig with the newest message of a ring; that of the file if there is none, or it does not
  /// fit to the file (a sentence in the log).
  static LiveRig newest(const config::Rig& filed, ipc::Segment ring);

  /// `filed`: the rig of the file. Errors: those of ipc::Reader::attach().
  static Result<std::unique_ptr<LiveSettings>> follow(const config::Rig& filed, ipc::Segment ring);
  ~LiveSettings();

  /// The newest rig if it has changed since the last call, else null. Never waits. One thread.
  std::unique_ptr<const LiveRig> take() {
    return std::unique_ptr<const LiveRig>(fresh_.load(std::memory_order_relaxed)
                                              ? fresh_.exchange(nullptr, std::memory_order_acq_rel)
                                              : nullptr);
  }

 private:
  LiveSettings() = default;

  std::atomic<const LiveRig*> fresh_{
      nullptr};  ///< owned; released by its maker, acquired by take()
  std::jthread thread_;
};

/// Lets a back end use the newest live settings, if they have changed. `live`: null if it is not
/// adjustable.
template <class Adjustable>
void pass_on(LiveSettings* live, Adjustable& backend) {
  if (const auto changed = live ? live->take() : nullptr) backend.adjust(changed->rig);
}

}  // namespace handcast::service
