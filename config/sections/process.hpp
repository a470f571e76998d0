// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "config/settings/field.hpp"
#include "ipc/base/wait.hpp"

namespace handcast::config {

/// [SERVICE.process]: how a service runs as a process. Each service has these settings.
struct Process {
  ipc::Wait wait = ipc::Wait::predictive;
  bool standby = false;
  int priority = 0;
  std::vector<double> cores;
  bool lock_memory = false;
};

template <class Visitor>
void describe(Visitor& visitor, Process& process) {
  visitor.field(
      "wait", process.wait,
      "How the service waits for its inputs. spin: polls, sees an input within 1 us, uses one "
      "core. predictive: within 1 us on a regular stream, uses about 5 % of a core. futex: sleeps, "
      "is woken within 30 to 60 us. eventfd: like futex, through epoll.");
  visitor.field("standby", process.standby,
                "Keep a second process of the service started and idle; it takes over when the "
                "first one dies.");
  visitor.field("priority", process.priority, between(0, 99),
                "Real-time priority (SCHED_FIFO). 0: normal scheduling. Needs CAP_SYS_NICE or an "
                "rtprio limit.");
  visitor.field("cores", process.cores, between(0, 1023),
                "The processor cores on which the service may run. Empty: all.");
  visitor.field("lock_memory", process.lock_memory,
                "Lock the memory of the service in RAM (mlockall). Needs a memlock limit.");
}

}  // namespace handcast::config
