// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <functional>

namespace handcast::bench {

/// Gives this process, and what it starts, real-time priority: what else the machine does is not
/// measured. Where that is not allowed, nothing happens.
void become_real_time();

/// A child that runs `body` with real-time priority on a core of its own, as a rig's daemons do.
/// Killed with the object.
class Process {
 public:
  Process(unsigned core, const std::function<void()>& body);
  ~Process();
  Process(const Process&) = delete;

  void join();

 private:
  pid_t pid_;
};

}  // namespace handcast::bench
