// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_process.hpp"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <utility>

namespace handcast::bench {
namespace {

void take_core(unsigned core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  ::sched_setaffinity(0, sizeof cores, &cores);
}

}  // namespace

void become_real_time() {
  const sched_param priority{.sched_priority = 40};
  ::sched_setscheduler(0, SCHED_FIFO, &priority);
}

Process::Process(unsigned core, const std::function<void()>& body) : pid_(::fork()) {
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  take_core(core);
  become_real_time();
  body();
  ::_exit(0);
}

Process::~Process() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
  join();
}

void Process::join() {
  if (pid_ > 0) ::waitpid(std::exchange(pid_, -1), nullptr, 0);
}

}  // namespace handcast::bench
