// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "config/settings/field.hpp"
#include "ipc/base/wait.hpp"

namespace handcast::config {

/// How one service runs as a process: the same settings for each of them.
struct Process {
  ipc::Wait wait = ipc::Wait::predictive;
  bool standby = false;
  int priority = 0;
  std::vector<double> cores;
  bool lock_memory = false;
};

template <class Visitor>
void describe(Visitor& visitor, Process& process) {
  visitor.field("wait", process.wait,
                "How it waits for its inputs: spin (a core for 1 us), predictive (some 5 % of a "
                "core for 1 us on a regular stream), futex "
                "(30 to 60 us), eventfd (as futex, by epoll).");
  visitor.field("standby", process.standby,
                "Keep a second process of this service, started and idle, that takes over when the "
                "first one dies.");
  visitor.field("priority", process.priority, between(0, 99),
                "Real-time priority (SCHED_FIFO); 0: as every other program. Needs CAP_SYS_NICE or "
                "an rtprio limit.");
  visitor.field("cores", process.cores, between(0, 1023),
                "The processor cores it may run on; empty: all.");
  visitor.field("lock_memory", process.lock_memory,
                "Keep all its memory out of swap (mlockall). Needs a memlock limit.");
}

}  // namespace handcast::config
