// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "config/sections/watch.hpp"
#include "services/watch/rig_status.hpp"

namespace handcast::watch {

/// What is seen to be wrong at a moment: a sentence by kind.
using Wrongs = std::map<std::string, std::string>;

/// Finds what is wrong with a rig: services that have been given up or die again and again, sensors
/// that are silent, a projector without frames, a full disk. One thread.
class FaultFinder {
 public:
  explicit FaultFinder(const config::Alert& settings) : settings_(settings) {}

  /// What is known at a moment.
  struct Seen {
    double disk_free_gb = 0;
    /// Sensors and projector may be silent: somebody has switched them off for the night.
    bool is_switched_off = false;
    std::int64_t now_ns = 0;  ///< CLOCK_MONOTONIC
  };
  /// Of a rig whose supervisor has answered just now.
  Wrongs find(const RigStatus& status, const Seen& seen);
  /// Of a rig whose supervisor does not answer.
  Wrongs find_without_status(std::int64_t now_ns);

 private:
  struct Service {
    int restarts = 0;
    std::deque<std::int64_t> restarted_ns{};  ///< the last ones
  };
  struct Ring {
    std::uint64_t messages = 0;
    std::int64_t heard_ns = 0;
  };
  void look_at(const std::string& name, const RigStatus::Service& service, std::int64_t now_ns,
               Wrongs& wrongs);
  void listen(const std::string& stream, std::uint64_t messages, bool must_send,
              std::int64_t now_ns, Wrongs& wrongs);

  config::Alert settings_;
  std::map<std::string, Service> services_;
  std::map<std::string, Ring> rings_;
  std::int64_t answered_ns_ = 0;
};

}  // namespace handcast::watch
