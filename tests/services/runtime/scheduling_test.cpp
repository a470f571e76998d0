// SPDX-License-Identifier: Apache-2.0
// Each test in a process of its own: what is set cannot always be taken back.
#include "services/runtime/scheduling.hpp"

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

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

TEST(Scheduling, ByDefaultNothingChanges) {
  const auto notes = apply_scheduling({}, "pose");
  ASSERT_TRUE(notes);
  EXPECT_TRUE(notes->empty());
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

}  // namespace
}  // namespace handcast::service
