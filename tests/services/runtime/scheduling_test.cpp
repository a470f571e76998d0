// SPDX-License-Identifier: Apache-2.0
// Each test in a process of its own: what is set cannot always be taken back.
#include "services/runtime/scheduling.hpp"

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <string>

namespace handcast::service {
namespace {

using testing::ExitedWithCode;

void expect(bool holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "%s\n", what);
  _exit(1);
}

void lose_all_rights() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  setrlimit(RLIMIT_MEMLOCK, &none);
  if (geteuid() == 0) expect(seteuid(65534) == 0, "cannot become nobody");
}

/// How the kernel runs this process.
struct Treatment {
  cpu_set_t cores{};
  int policy = sched_getscheduler(0);
  sched_param parameters{};
  std::string locked_memory;  ///< the line "VmLck: ... kB"

  Treatment() {
    sched_getaffinity(0, sizeof cores, &cores);
    sched_getparam(0, &parameters);
    std::ifstream status("/proc/self/status");
    while (std::getline(status, locked_memory))
      if (locked_memory.starts_with("VmLck:")) break;
  }
};

cpu_set_t all_cores() {
  cpu_set_t set;
  memset(&set, 0xff, sizeof set);
  return set;
}

cpu_set_t last_core() {
  const Treatment now;
  int core = CPU_SETSIZE - 1;
  while (!CPU_ISSET(core, &now.cores)) --core;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  return set;
}

void expect_no_change_from(const cpu_set_t& cores, int policy) {
  const sched_param none{};
  expect(sched_setaffinity(0, sizeof cores, &cores) == 0, "the cores are denied");
  expect(sched_setscheduler(0, policy, &none) == 0, "the policy is denied");
  const Treatment before;
  const auto notes = apply_scheduling({}, "pose");
  const Treatment after;
  expect(notes && notes->empty(), "refused");
  expect(CPU_EQUAL(&after.cores, &before.cores), "other cores");
  expect(after.policy == before.policy, "another policy");
  expect(after.parameters.sched_priority == before.parameters.sched_priority, "another priority");
  expect(after.locked_memory == before.locked_memory, "memory is locked");
}

TEST(Scheduling, ByDefaultNothingChanges) {
  const auto from_two_states = [] {
    expect_no_change_from(all_cores(), SCHED_OTHER);
    expect_no_change_from(last_core(), SCHED_BATCH);
    _exit(0);
  };
  EXPECT_EXIT(from_two_states(), ExitedWithCode(0), "");
}

TEST(Scheduling, AProcessRunsOnlyOnItsCores) {
  const auto on_one_core = [] {
    cpu_set_t set;
    sched_getaffinity(0, sizeof set, &set);
    int core = 0;
    while (!CPU_ISSET(core, &set)) ++core;
    const auto notes = apply_scheduling({.cores = {static_cast<double>(core)}}, "pose");
    expect(notes && notes->empty(), "refused");
    sched_getaffinity(0, sizeof set, &set);
    expect(CPU_COUNT(&set) == 1 && CPU_ISSET(core, &set), "elsewhere");
    _exit(0);
  };
  EXPECT_EXIT(on_one_core(), ExitedWithCode(0), "");
}

TEST(Scheduling, CoresThatAreNotThereAreASentence) {
  for (const double core : {1000.0, 0.5}) {
    const auto notes = apply_scheduling({.cores = {0, core}}, "pose");
    ASSERT_FALSE(notes) << core;
    EXPECT_EQ(notes.error().code, Errc::bad_config);
    EXPECT_THAT(notes.error().what, testing::StartsWith("pose.process.cores: there is no core"));
  }
}

TEST(Scheduling, WhatIsNotPermittedIsANoteAndNotAFailure) {
  const auto without_rights = [] {
    lose_all_rights();
    const auto notes = apply_scheduling({.priority = 50, .lock_memory = true}, "pose");
    expect(notes.has_value(), "failed");
    expect(notes->size() == 2, "one note each");
    expect(notes->at(0).find("CAP_SYS_NICE") != std::string::npos, "says what is missing");
    expect(notes->at(1).find("CAP_IPC_LOCK") != std::string::npos, "says what is missing");
    _exit(0);
  };
  EXPECT_EXIT(without_rights(), ExitedWithCode(0), "");
}

/// The nice value of the session's autogroup; empty without autogroups.
std::string nice_of_session() {
  std::ifstream file("/proc/self/autogroup");
  std::string name, word, value;
  file >> name >> word >> value;
  return value;
}

TEST(Scheduling, AServiceGivesWayWithItsSessionAndAnotherProcessAlone) {
  if (nice_of_session().empty()) GTEST_SKIP() << "this kernel has no autogroups";
  const auto member = [] {
    const auto before = nice_of_session();
    give_way();
    expect(getpriority(PRIO_PROCESS, 0) == 10, "the process keeps its priority");
    expect(nice_of_session() == before, "the session of somebody else is slower now");
    _exit(0);
  };
  EXPECT_EXIT(member(), ExitedWithCode(0), "");
  const auto leader = [] {
    expect(setsid() == getpid(), "no session");
    give_way();
    expect(getpriority(PRIO_PROCESS, 0) == 10, "the process keeps its priority");
    expect(nice_of_session() == "10", "other sessions still wait as long for this one");
    _exit(0);
  };
  EXPECT_EXIT(leader(), ExitedWithCode(0), "");
}

}  // namespace
}  // namespace handcast::service
