// SPDX-License-Identifier: Apache-2.0
// What becomes of a service'at_s spare, and what it does for the service.
#include <gmock/gmock.h>

#include "tests/supervisor/life/state_text.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Exit kSpareCrash{.signalled = true, .code = 9};

std::int64_t at_s(double seconds) { return seconds_to_ns(seconds); }

event::Tick spare_beating_at(double time_s) { return {.last_sign_ns = at_s(time_s)}; }

/// A service that keeps a spare, ready since 10 at_s.
Machine ready_machine(Spare spare = spare::None{}) {
  Machine machine{.state = {.worker = worker::Ready{.life = {.started_ns = at_s(9)},
                                                    .ready_ns = at_s(10),
                                                    .quiet_from_ns = at_s(10)},
                            .spare = spare}};
  machine.rules.wants_standby = true;
  return machine;
}

const spare::Prepared kSparePrepared{.prepared_ns = at_s(11), .sign_ns = at_s(20)};

TEST(NextSpare, ItIsStartedWhenTheWorkerIsReadyAndPreparedWhenItSpeaks) {
  Machine machine;
  machine.rules.wants_standby = true;
  machine.at(1, event::Start{});
  EXPECT_EQ(machine.spare(), "none");
  machine.at(2, event::SaidReady{});
  EXPECT_EQ(machine.spare(), "due at 2");
  EXPECT_THAT(machine.at(2.05, spare_beating_at(2)), ElementsAre("spawn spare"));
  EXPECT_EQ(machine.spare(), "preparing until 12.05");
  machine.at(3, event::SpareSpoke{});
  machine.at(4, event::SpareSpoke{});
  EXPECT_EQ(machine.spare(), "prepared, heard at 4");
}

TEST(NextSpare, ItTakesOverWhenTheWorkerDiesHoweverOftenThatWas) {
  auto machine = ready_machine(kSparePrepared);
  machine.state.past.deaths.streak = 5;
  EXPECT_THAT(machine.at(20, event::Ended{kSpareCrash}),
              ElementsAre("promote", "read last words",
                          "warn: pose died (signal 9 (Killed)); its spare goes on"));
  EXPECT_EQ(machine.worker(), "starting until 30, promoted");
  EXPECT_EQ(machine.spare(), "none");
  machine.at(21, event::SaidReady{});
  EXPECT_EQ(machine.spare(), "due at 22") << "the new worker has the machine for a second";
}

TEST(NextSpare, OneThatIsNotPreparedDoesNotTakeOver) {
  for (const Spare& spare :
       {Spare(spare::Preparing{.late_ns = at_s(30)}), Spare(spare::Killed{.prepared_ns = at_s(11)}),
        Spare(spare::Leaving{})}) {
    auto machine = ready_machine(spare);
    EXPECT_EQ(machine.at(20, event::Ended{kSpareCrash}).front(), "spawn") << text_of(spare);
    EXPECT_EQ(machine.spare(), text_of(spare));
  }
}

TEST(NextSpare, AStormOfDeathsIsNotFedWithSpares) {
  auto machine = ready_machine(kSparePrepared);
  for (int i = 11; i < 20; ++i) machine.state.past.deaths.recent_ns.push_back(at_s(i));
  machine.at(20, event::Ended{kSpareCrash});
  EXPECT_EQ(shown(machine.state.worker), State::degraded);
  EXPECT_EQ(machine.spare(), "prepared, heard at 20");
}

TEST(NextSpare, OneThatIsLateOrSilentIsKilledAndReplaced) {
  auto late = ready_machine(spare::Preparing{.late_ns = at_s(20)});
  EXPECT_THAT(late.at(19.9, spare_beating_at(19.9)), IsEmpty());
  EXPECT_THAT(
      late.at(20, spare_beating_at(20)),
      ElementsAre("warn: the spare of pose was not prepared within 10 s; killed", "kill spare"));
  auto silent = ready_machine(kSparePrepared);
  EXPECT_THAT(silent.at(21.9, spare_beating_at(21.9)), IsEmpty());
  EXPECT_THAT(silent.at(22, spare_beating_at(22)),
              ElementsAre("warn: the spare of pose has given no sign of life for 2 s; killed",
                          "kill spare"));
  EXPECT_THAT(silent.at(30, spare_beating_at(30)), IsEmpty());
  EXPECT_THAT(
      silent.at(30, event::SpareEnded{kSpareCrash}),
      ElementsAre("warn: the spare of pose ended (signal 9 (Killed)); another one in 0 ms"));
  EXPECT_EQ(silent.spare(), "due at 30");
}

TEST(NextSpare, ItsDeathsWaitLikeAWorkersAndDoNotCount) {
  auto machine = ready_machine(kSparePrepared);
  for (const auto* wait : {"in 0 ms", "in 50 ms", "in 100 ms"}) {
    machine.state.spare = kSparePrepared;
    EXPECT_THAT(machine.at(20, event::SpareEnded{kSpareCrash}), ElementsAre(HasSubstr(wait)));
  }
  EXPECT_EQ(machine.spare(), "due at 20.1");
  EXPECT_EQ(machine.worker(), "ready since 10, quiet from 10");
  EXPECT_EQ(machine.state.past.restarts, 0);
  EXPECT_TRUE(machine.state.past.deaths.recent_ns.empty());
}

TEST(NextSpare, OneThatAPersonMustMendIsNotReplaced) {
  auto machine = ready_machine(spare::Preparing{.late_ns = at_s(30)});
  EXPECT_THAT(machine.at(20, event::SpareEnded{{.code = 100}}),
              ElementsAre("warn: the spare of pose ended (exit 100); pose has none until it is "
                          "started again"));
  EXPECT_EQ(machine.spare(), "none");
}

TEST(NextSpare, OneThatCannotBeStartedIsTriedAgain) {
  auto machine = ready_machine(spare::Preparing{.late_ns = at_s(30)});
  EXPECT_THAT(machine.at(20, event::SpareNotStarted{"no process to be had"}),
              ElementsAre("warn: the spare of pose could not be started: no process to be had",
                          "warn: the spare of pose ended (exit 111); another one in 0 ms"));
  EXPECT_EQ(machine.spare(), "due at 20");
}

TEST(NextSpare, AServiceHasStoppedWhenBothProcessesHave) {
  auto machine = ready_machine(kSparePrepared);
  EXPECT_THAT(machine.at(20, event::Stop{}),
              ElementsAre("ask spare to stop", "ask to stop for good"));
  EXPECT_THAT(machine.at(21, event::Ended{kSpareCrash}), ElementsAre("read last words"));
  EXPECT_EQ(machine.worker(), "awaiting its spare");
  EXPECT_THAT(machine.at(22, event::SpareEnded{kSpareCrash}), ElementsAre("tell stopped"));
  EXPECT_EQ(machine.worker(), "stopped");
}

TEST(NextSpare, OneThatDoesNotLeaveIsKilled) {
  auto machine = ready_machine(kSparePrepared);
  machine.at(20, event::Stop{});
  machine.at(21, event::Ended{kSpareCrash});
  auto hurried = machine;
  EXPECT_THAT(machine.at(22.9, event::Tick{}), IsEmpty());
  EXPECT_THAT(machine.at(23, event::Tick{}), ElementsAre("kill spare"));
  EXPECT_THAT(machine.at(24, event::Tick{}), IsEmpty());
  EXPECT_THAT(hurried.at(22, event::Hurry{}), ElementsAre("kill spare"));
}

TEST(NextSpare, OneOfOldSettingsIsReplacedWithTheWorker) {
  auto machine = ready_machine(kSparePrepared);
  EXPECT_THAT(machine.at(20, event::Restart{}), ElementsAre("ask spare to stop", "ask to stop"));
  EXPECT_THAT(machine.at(21, event::Ended{kSpareCrash}), ElementsAre("read last words", "spawn"));
  machine.at(22, event::SaidReady{});
  EXPECT_EQ(machine.spare(), "leaving until 23, next at 22");
  machine.at(22.5, event::SpareEnded{kSpareCrash});
  EXPECT_EQ(machine.spare(), "due at 22");
  EXPECT_THAT(machine.at(22.6, spare_beating_at(22.6)), ElementsAre("spawn spare"));
}

TEST(NextSpare, TheSettingsSwitchItOnAndOff) {
  auto machine = ready_machine(kSparePrepared);
  machine.rules.wants_standby = false;
  EXPECT_THAT(machine.at(20, event::SettingsChanged{}), ElementsAre("ask spare to stop"));
  machine.at(21, event::SpareEnded{kSpareCrash});
  EXPECT_EQ(machine.spare(), "none");
  machine.rules.wants_standby = true;
  machine.at(22, event::SettingsChanged{});
  EXPECT_EQ(machine.spare(), "due at 22");
  machine.rules.wants_standby = false;
  EXPECT_THAT(machine.at(22, event::SettingsChanged{}), IsEmpty());
  EXPECT_EQ(machine.spare(), "none");
}

TEST(NextSpare, AServiceThatGivesUpNeedsNone) {
  auto machine = ready_machine(kSparePrepared);
  EXPECT_EQ(machine.at(20, event::Ended{{.code = 100}}).front(), "ask spare to stop");
  EXPECT_EQ(machine.worker(), "failed");
}

TEST(NextSpare, AStandstillIsHeldAgainstItNeither) {
  auto machine = ready_machine(kSparePrepared);
  machine.at(50, event::StoodStill{at_s(29)});
  EXPECT_THAT(machine.at(50.5, spare_beating_at(50.5)), IsEmpty());
  EXPECT_EQ(machine.spare(), "prepared, heard at 49");
}

}  // namespace
}  // namespace handcast::supervisor
