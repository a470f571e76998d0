// SPDX-License-Identifier: Apache-2.0
// How a worker that works is replaced.
#include <gmock/gmock.h>

#include "tests/supervisor/life/state_text.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Exit kReplacementCrash{.signalled = true, .code = 9};
const standby::Prepared kReplacementPrepared{.prepared_ns = seconds_to_ns(11),
                                             .sign_ns = seconds_to_ns(20)};

event::Tick beating_at(double time_s) { return {.last_sign_ns = seconds_to_ns(time_s)}; }

/// A service that keeps a standby, ready since 10 s.
Machine replaceable_machine(Standby standby = standby::None{}) {
  Machine machine{.state = {.worker = worker::Ready{.life = {.started_ns = seconds_to_ns(9)},
                                                    .ready_ns = seconds_to_ns(10),
                                                    .quiet_from_ns = seconds_to_ns(10)},
                            .standby = std::move(standby)}};
  machine.rules.wants_standby = true;
  return machine;
}

/// A service without standby, ready since 10 s, whose replacement was started at 20 s.
Machine replacing_machine(Replacement how = {}) {
  auto machine = replaceable_machine();
  machine.rules.wants_standby = false;
  machine.at(20, event::Prepare{.how = how});
  machine.at(20, beating_at(20));
  return machine;
}

TEST(NextReplacement, TheWorkerGoesOnUntilItIsPreparedThenTheyChangePlaces) {
  auto machine = replaceable_machine();
  machine.rules.wants_standby = false;
  EXPECT_THAT(machine.at(20, event::Prepare{}), IsEmpty());
  EXPECT_THAT(machine.at(20, beating_at(20)), ElementsAre("spawn standby"));
  EXPECT_THAT(machine.at(21, event::HandOver{}), IsEmpty()) << "it is not prepared";
  EXPECT_THAT(machine.at(22, event::StandbySpoke{}), IsEmpty());
  EXPECT_EQ(machine.worker(), "ready since 10, quiet from 10");
  EXPECT_THAT(machine.at(22, event::HandOver{}), ElementsAre("hand over"));
  EXPECT_EQ(machine.worker(), "starting until 32, promoted");
  EXPECT_EQ(machine.standby(), "leaving until 25") << "the old worker";
  EXPECT_THAT(machine.at(22.1, event::SaidReady{}), ElementsAre("tell ready"));
  EXPECT_THAT(machine.at(22.2, event::StandbyEnded{{.code = 0}}), IsEmpty());
  EXPECT_EQ(machine.standby(), "none");
  EXPECT_FALSE(machine.state.replacement);
  EXPECT_EQ(machine.state.past.restarts, 0);
}

TEST(NextReplacement, AnOldWorkerThatDoesNotStopIsKilled) {
  auto machine = replacing_machine();
  machine.at(22, event::StandbySpoke{});
  machine.at(22, event::HandOver{});
  EXPECT_THAT(machine.at(24.9, event::Tick{}), IsEmpty());
  EXPECT_THAT(machine.at(25, event::Tick{}), ElementsAre("kill standby"));
}

TEST(NextReplacement, OneThatNeedsTheWorkersDeviceGetsItsTurnWhenTheWorkerHasEnded) {
  auto machine = replacing_machine({.on_trial = true, .alone = true});
  machine.at(22, event::StandbySpoke{});
  EXPECT_THAT(machine.at(22, event::HandOver{}), ElementsAre("ask to stop"));
  EXPECT_EQ(machine.worker(), "stopping until 25, then hand over");
  EXPECT_THAT(machine.at(22.1, event::Ended{{.code = 0}}),
              ElementsAre("read last words", "promote"));
  EXPECT_EQ(machine.worker(), "starting until 32.1, promoted, on trial");
  EXPECT_EQ(machine.standby(), "none");
}

TEST(NextReplacement, OneThatDiesWhileItWaitsForTheDeviceLeavesTheServiceToItsOldSettings) {
  auto machine = replacing_machine({.alone = true});
  machine.at(22, event::StandbySpoke{});
  machine.at(22, event::HandOver{});
  machine.at(22.1, event::StandbyEnded{kReplacementCrash});
  EXPECT_THAT(machine.at(22.2, event::Ended{{.code = 0}}), ElementsAre("read last words", "spawn"));
}

TEST(NextReplacement, AStandbyOfTheSameSettingsIsOneAtOnceAndAnotherIsReplaced) {
  auto same = replaceable_machine(kReplacementPrepared);
  EXPECT_THAT(same.at(20, event::Prepare{.how = {}, .may_use_standby = true}), IsEmpty());
  EXPECT_THAT(same.at(20, event::HandOver{}), ElementsAre("hand over"));
  same.at(20.1, event::SaidReady{});
  EXPECT_EQ(same.standby(), "leaving until 23, next at 21.1") << "a new standby follows";

  auto other = replaceable_machine(kReplacementPrepared);
  EXPECT_THAT(other.at(20, event::Prepare{}), ElementsAre("ask standby to stop"));
  EXPECT_THAT(other.at(20, event::HandOver{}), IsEmpty());
  other.at(20.2, event::StandbyEnded{{.code = 0}});
  EXPECT_THAT(other.at(20.25, beating_at(20.25)), ElementsAre("spawn standby"));
}

TEST(NextReplacement, OneThatFailsIsReportedAndTheWorkerGoesOn) {
  const auto expect_failure = [](const Event& event, const char* failure) {
    auto machine = replacing_machine();
    EXPECT_THAT(machine.at(21, event),
                ElementsAre(HasSubstr("warn: the replacement of pose failed"), failure));
    EXPECT_EQ(machine.worker(), "ready since 10, quiet from 10");
    EXPECT_EQ(machine.standby(), "none");
    EXPECT_FALSE(machine.state.replacement);
  };
  expect_failure(event::StandbyEnded{{.code = 100}}, "replacement failed by itself: exit 100");
  expect_failure(event::StandbyNotStarted{"no process"}, "replacement failed: no process");

  auto late = replacing_machine();
  EXPECT_THAT(late.at(30, beating_at(30)), testing::Contains("kill standby"));
  EXPECT_THAT(late.at(30.1, event::StandbyEnded{kReplacementCrash}),
              testing::Contains("replacement failed: was not prepared within 10 s"));
}

TEST(NextReplacement, ItsFailureBringsTheStandbyBack) {
  auto machine = replaceable_machine(kReplacementPrepared);
  machine.at(20, event::Prepare{});
  machine.at(20.1, event::StandbyEnded{{.code = 0}});
  machine.at(20.2, beating_at(20.2));
  machine.at(20.3, event::StandbyEnded{{.code = 100}});
  EXPECT_EQ(machine.standby(), "due at 20.3");
}

TEST(NextReplacement, AWorkerThatDiesMeanwhileIsStartedAgainAndThenReplaced) {
  auto machine = replacing_machine();
  machine.at(22, event::StandbySpoke{});
  EXPECT_EQ(machine.at(22.5, event::Ended{kReplacementCrash}).front(), "spawn")
      << "only its owner lets the replacement take over";
  EXPECT_EQ(machine.at(22.6, event::HandOver{}), Machine::Texts{"hand over"});
  EXPECT_EQ(machine.worker(), "starting until 32.6, promoted");
}

TEST(NextReplacement, ItTakesOverFromAWorkerThatWaitsOrHasGivenUp) {
  auto waiting = replacing_machine();
  waiting.state.past.deaths.streak = 3;
  waiting.at(21, event::Ended{kReplacementCrash});
  ASSERT_THAT(waiting.worker(), HasSubstr("waiting"));
  auto given_up = replacing_machine();
  given_up.at(21, event::Ended{{.code = 100}});
  ASSERT_EQ(given_up.worker(), "failed");
  for (auto* machine : {&waiting, &given_up}) {
    machine->at(21.01, event::StandbySpoke{});
    EXPECT_EQ(machine->at(21.02, event::HandOver{}), Machine::Texts{"promote"});
    EXPECT_EQ(machine->worker(), "starting until 31.02, promoted");
  }
}

TEST(NextReplacement, AStopAndASecondThoughtEndIt) {
  auto stopped = replacing_machine();
  EXPECT_THAT(stopped.at(21, event::Stop{}),
              ElementsAre("ask standby to stop", "ask to stop for good"));
  EXPECT_FALSE(stopped.state.replacement);
  stopped.at(21.1, event::StandbySpoke{});
  EXPECT_THAT(stopped.at(21.2, event::HandOver{}), IsEmpty());

  auto abandoned = replacing_machine();
  EXPECT_THAT(abandoned.at(21, event::Abandon{}), ElementsAre("ask standby to stop"));
  EXPECT_EQ(abandoned.worker(), "ready since 10, quiet from 10");
}

TEST(NextReplacement, AStopWhileItWaitsForTheDeviceStopsBoth) {
  auto machine = replacing_machine({.alone = true});
  machine.at(22, event::StandbySpoke{});
  machine.at(22, event::HandOver{});
  EXPECT_THAT(machine.at(22.1, event::Stop{}), ElementsAre("ask standby to stop"));
  machine.at(22.2, event::Ended{{.code = 0}});
  EXPECT_EQ(machine.worker(), "awaiting its standby");
}

}  // namespace
}  // namespace handcast::supervisor
