// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include "ipc/base/log.hpp"

namespace handcast::desk {

/// Gives this thread a low priority, whatever that of the process is: the light does not wait for
/// the page. (nice(2) is of one thread in Linux.)
inline void run_at_low_priority() {
  const sched_param none{};
  if (::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &none) != 0 || ::nice(10) == -1)
    log::debug("the priority of a thread cannot be lowered");
}

}  // namespace handcast::desk
