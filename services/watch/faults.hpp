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

  /// Of a rig whose supervisor has answered just now. Times: CLOCK_MONOTONIC.
  Wrongs find(const RigStatus& status, double disk_free_gb, std::int64_t now_ns);
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
  void listen(const std::string& stream, std::uint64_t messages, bool is_ready, std::int64_t now_ns,
              Wrongs& wrongs);

  config::Alert settings_;
  std::map<std::string, Service> services_;
  std::map<std::string, Ring> rings_;
  std::int64_t answered_ns_ = 0;
};

}  // namespace handcast::watch
