// SPDX-License-Identifier: Apache-2.0
// What becomes of a service'at_s standby, and what it does for the service.
#include <gmock/gmock.h>

#include "tests/supervisor/life/state_text.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Exit kStandbyCrash{.signalled = true, .code = 9};

std::int64_t at_s(double seconds) { return seconds_to_ns(seconds); }

event::Tick standby_beating_at(double time_s) { return {.last_sign_ns = at_s(time_s)}; }

/// A service that keeps a standby, ready since 10 at_s.
Machine ready_machine(Standby standby = standby::None{}) {
  Machine machine{.state = {.worker = worker::Ready{.life = {.started_ns = at_s(9)},
                                                    .ready_ns = at_s(10),
                                                    .quiet_from_ns = at_s(10)},
                            .standby = standby}};
  machine.rules.wants_standby = true;
  return machine;
}

const standby::Prepared kStandbyPrepared{.prepared_ns = at_s(11), .sign_ns = at_s(20)};

TEST(NextStandby, ItIsStartedWhenTheWorkerIsReadyAndPreparedWhenItSpeaks) {
  Machine machine;
  machine.rules.wants_standby = true;
  machine.at(1, event::Start{});
  EXPECT_EQ(machine.standby(), "none");
  machine.at(2, event::SaidReady{});
  EXPECT_EQ(machine.standby(), "due at 2");
  EXPECT_THAT(machine.at(2.05, standby_beating_at(2)), ElementsAre("spawn standby"));
  EXPECT_EQ(machine.standby(), "preparing until 12.05");
  machine.at(3, event::StandbySpoke{});
  machine.at(4, event::StandbySpoke{});
  EXPECT_EQ(machine.standby(), "prepared, heard at 4");
}

TEST(NextStandby, ItTakesOverWhenTheWorkerDiesHoweverOftenThatWas) {
  auto machine = ready_machine(kStandbyPrepared);
  machine.state.past.deaths.streak = 5;
  EXPECT_THAT(machine.at(20, event::Ended{kStandbyCrash}),
              ElementsAre("promote", "read last words",
                          "warn: pose died (signal 9 (Killed)); its standby goes on"));
  EXPECT_EQ(machine.worker(), "starting until 30, promoted");
  EXPECT_EQ(machine.standby(), "none");
  machine.at(21, event::SaidReady{});
  EXPECT_EQ(machine.standby(), "due at 22") << "the new worker has the machine for a second";
}

TEST(NextStandby, OneThatIsNotPreparedDoesNotTakeOver) {
  for (const Standby& standby :
       {Standby(standby::Preparing{.late_ns = at_s(30)}),
        Standby(standby::Killed{.prepared_ns = at_s(11)}), Standby(standby::Leaving{})}) {
    auto machine = ready_machine(standby);
    EXPECT_EQ(machine.at(20, event::Ended{kStandbyCrash}).front(), "spawn") << text_of(standby);
    EXPECT_EQ(machine.standby(), text_of(standby));
  }
}

TEST(NextStandby, AStormOfDeathsIsNotFedWithStandbys) {
  auto machine = ready_machine(kStandbyPrepared);
  for (int i = 11; i < 20; ++i) machine.state.past.deaths.recent_ns.push_back(at_s(i));
  machine.at(20, event::Ended{kStandbyCrash});
  EXPECT_EQ(shown(machine.state.worker), State::degraded);
  EXPECT_EQ(machine.standby(), "prepared, heard at 20");
}

TEST(NextStandby, OneThatIsLateOrSilentIsKilledAndReplaced) {
  auto late = ready_machine(standby::Preparing{.late_ns = at_s(20)});
  EXPECT_THAT(late.at(19.9, standby_beating_at(19.9)), IsEmpty());
  EXPECT_THAT(late.at(20, standby_beating_at(20)),
              ElementsAre("warn: the standby of pose was not prepared within 10 s; killed",
                          "kill standby"));
  auto silent = ready_machine(kStandbyPrepared);
  EXPECT_THAT(silent.at(21.9, standby_beating_at(21.9)), IsEmpty());
  EXPECT_THAT(silent.at(22, standby_beating_at(22)),
              ElementsAre("warn: the standby of pose has given no sign of life for 2 s; killed",
                          "kill standby"));
  EXPECT_THAT(silent.at(30, standby_beating_at(30)), IsEmpty());
  EXPECT_THAT(
      silent.at(30, event::StandbyEnded{kStandbyCrash}),
      ElementsAre("warn: the standby of pose ended (signal 9 (Killed)); another one in 0 ms"));
  EXPECT_EQ(silent.standby(), "due at 30");
}

TEST(NextStandby, ItsDeathsWaitLikeAWorkersAndDoNotCount) {
  auto machine = ready_machine(kStandbyPrepared);
  for (const auto* wait : {"in 0 ms", "in 50 ms", "in 100 ms"}) {
    machine.state.standby = kStandbyPrepared;
    EXPECT_THAT(machine.at(20, event::StandbyEnded{kStandbyCrash}), ElementsAre(HasSubstr(wait)));
  }
  EXPECT_EQ(machine.standby(), "due at 20.1");
  EXPECT_EQ(machine.worker(), "ready since 10, quiet from 10");
  EXPECT_EQ(machine.state.past.restarts, 0);
  EXPECT_TRUE(machine.state.past.deaths.recent_ns.empty());
}

TEST(NextStandby, OneThatAPersonMustMendIsNotReplaced) {
  auto machine = ready_machine(standby::Preparing{.late_ns = at_s(30)});
  EXPECT_THAT(machine.at(20, event::StandbyEnded{{.code = 100}}),
              ElementsAre("warn: the standby of pose ended (exit 100); pose has none until it is "
                          "started again"));
  EXPECT_EQ(machine.standby(), "none");
}

TEST(NextStandby, OneThatCannotBeStartedIsTriedAgain) {
  auto machine = ready_machine(standby::Preparing{.late_ns = at_s(30)});
  EXPECT_THAT(machine.at(20, event::StandbyNotStarted{"no process to be had"}),
              ElementsAre("warn: the standby of pose could not be started: no process to be had",
                          "warn: the standby of pose ended (exit 111); another one in 0 ms"));
  EXPECT_EQ(machine.standby(), "due at 20");
}

TEST(NextStandby, AServiceHasStoppedWhenBothProcessesHave) {
  auto machine = ready_machine(kStandbyPrepared);
  EXPECT_THAT(machine.at(20, event::Stop{}),
              ElementsAre("ask standby to stop", "ask to stop for good"));
  EXPECT_THAT(machine.at(21, event::Ended{kStandbyCrash}), ElementsAre("read last words"));
  EXPECT_EQ(machine.worker(), "awaiting its standby");
  EXPECT_THAT(machine.at(22, event::StandbyEnded{kStandbyCrash}), ElementsAre("tell stopped"));
  EXPECT_EQ(machine.worker(), "stopped");
}

TEST(NextStandby, OneThatDoesNotLeaveIsKilled) {
  auto machine = ready_machine(kStandbyPrepared);
  machine.at(20, event::Stop{});
  machine.at(21, event::Ended{kStandbyCrash});
  auto hurried = machine;
  EXPECT_THAT(machine.at(22.9, event::Tick{}), IsEmpty());
  EXPECT_THAT(machine.at(23, event::Tick{}), ElementsAre("kill standby"));
  EXPECT_THAT(machine.at(24, event::Tick{}), IsEmpty());
  EXPECT_THAT(hurried.at(22, event::Hurry{}), ElementsAre("kill standby"));
}

TEST(NextStandby, OneOfOldSettingsIsReplacedWithTheWorker) {
  auto machine = ready_machine(kStandbyPrepared);
  EXPECT_THAT(machine.at(20, event::Restart{}), ElementsAre("ask standby to stop", "ask to stop"));
  EXPECT_THAT(machine.at(21, event::Ended{kStandbyCrash}), ElementsAre("read last words", "spawn"));
  machine.at(22, event::SaidReady{});
  EXPECT_EQ(machine.standby(), "leaving until 23, next at 22");
  machine.at(22.5, event::StandbyEnded{kStandbyCrash});
  EXPECT_EQ(machine.standby(), "due at 22");
  EXPECT_THAT(machine.at(22.6, standby_beating_at(22.6)), ElementsAre("spawn standby"));
}

TEST(NextStandby, TheSettingsSwitchItOnAndOff) {
  auto machine = ready_machine(kStandbyPrepared);
  machine.rules.wants_standby = false;
  EXPECT_THAT(machine.at(20, event::SettingsChanged{}), ElementsAre("ask standby to stop"));
  machine.at(21, event::StandbyEnded{kStandbyCrash});
  EXPECT_EQ(machine.standby(), "none");
  machine.rules.wants_standby = true;
  machine.at(22, event::SettingsChanged{});
  EXPECT_EQ(machine.standby(), "due at 22");
  machine.rules.wants_standby = false;
  EXPECT_THAT(machine.at(22, event::SettingsChanged{}), IsEmpty());
  EXPECT_EQ(machine.standby(), "none");
}

TEST(NextStandby, AServiceThatGivesUpNeedsNone) {
  auto machine = ready_machine(kStandbyPrepared);
  EXPECT_EQ(machine.at(20, event::Ended{{.code = 100}}).front(), "ask standby to stop");
  EXPECT_EQ(machine.worker(), "failed");
}

TEST(NextStandby, AStandstillIsHeldAgainstItNeither) {
  auto machine = ready_machine(kStandbyPrepared);
  machine.at(50, event::StoodStill{at_s(29)});
  EXPECT_THAT(machine.at(50.5, standby_beating_at(50.5)), IsEmpty());
  EXPECT_EQ(machine.standby(), "prepared, heard at 49");
}

}  // namespace
}  // namespace handcast::supervisor
