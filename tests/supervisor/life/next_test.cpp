// SPDX-License-Identifier: Apache-2.0
// What becomes of a service: no process, no clock but the test's.
#include "supervisor/life/next.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/supervisor/life/state_text.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Texts = Machine::Texts;
using Then = worker::Stopping::Then;

constexpr Exit kCrash{.signalled = true, .code = 11};
constexpr Exit kConfigExit{.code = 100};
constexpr Exit kSuccess{.code = 0};

std::int64_t s(double seconds) { return seconds_to_ns(seconds); }

// Everything in the table happens at 100 s, to a worker that was started at 90 s.
constexpr double kNow_s = 100;
const Life kLife{.started_ns = seconds_to_ns(90)};
const Life kOnTrial{.started_ns = seconds_to_ns(90), .on_trial = true};
const worker::Starting kStarting{.life = kLife, .late_ns = s(105)};
const worker::Starting kTrial{.life = kOnTrial, .late_ns = s(105)};
const worker::AwaitingMessage kAwaiting{.life = kLife, .looked_ns = s(99), .dry_ns = s(4)};
const worker::Ready kReady{.life = kLife, .ready_ns = s(95), .quiet_from_ns = s(95)};
const worker::Killed kKilled{.life = kLife, .ready_ns = s(95)};
const worker::Stopping kStopping{.life = kLife, .kill_ns = s(102)};
const worker::Stopping kRestarting{.life = kLife, .kill_ns = s(102), .then = Then::start};
const worker::Waiting kWaiting{.due_ns = s(101)};

const event::Tick kHeard{.last_sign_ns = s(99.9)};
const Texts kStopped{"read last words", "tell stopped"};
const Texts kNothing{};

struct Row {
  Worker before;
  Event event;
  std::string after;
  Texts actions;
};

void expect(const std::vector<Row>& table) {
  for (const auto& row : table) {
    Machine machine{.state = {.worker = row.before}};
    SCOPED_TRACE(fmt::format("{} + event {}", text_of(row.before), row.event.index()));
    EXPECT_EQ(machine.at(kNow_s, row.event), row.actions);
    EXPECT_EQ(machine.worker(), row.after);
  }
}

TEST(Next, AServiceBegins) {
  expect({
      {worker::Stopped{}, event::Hold{}, "held", kNothing},
      {worker::Stopped{}, event::Start{}, "starting until 110", {"spawn"}},
      {worker::Held{}, event::Start{}, "starting until 110", {"spawn"}},
      {worker::Held{}, event::Tick{}, "held", kNothing},
      {kStarting, event::Start{}, "starting until 105", kNothing},
      {kReady, event::Hold{}, "ready since 95, quiet from 95", kNothing},
      {worker::Stopped{}, event::Inherited{State::failed, 2}, "failed", kNothing},
      {worker::Stopped{}, event::Inherited{State::stopped, 2}, "stopped", kNothing},
      {worker::Stopped{},
       event::Adopted{s(7)},
       "ready since 100, quiet from 100, adopted",
       {"tell ready"}},
  });
}

TEST(Next, AServiceThatPublishesNothingIsReadyWhenItSaysSo) {
  expect({
      {kStarting, event::SaidReady{}, "ready since 100, quiet from 100", {"tell ready"}},
      {kTrial, event::SaidReady{}, "ready since 100, quiet from 100", {"tell ready"}},
      {kStopping, event::SaidReady{}, "stopping until 102", kNothing},
      {kKilled, event::SaidReady{}, "killed", kNothing},
  });
}

TEST(Next, AServiceThatPublishesIsReadyWithItsFirstMessage) {
  Machine machine{.state = {.worker = kStarting}};
  machine.rules.publishes = true;
  EXPECT_THAT(machine.at(100, event::SaidReady{.published = false}), IsEmpty());
  EXPECT_EQ(machine.worker(), "awaiting its message, dry for 0");
  EXPECT_THAT(machine.at(101, event::Tick{.published = false}), IsEmpty());
  EXPECT_THAT(machine.at(102, event::Tick{.published = true}), ElementsAre("tell ready"));

  machine.state.worker = kStarting;
  EXPECT_THAT(machine.at(100, event::SaidReady{.published = true}), ElementsAre("tell ready"));
}

TEST(Next, AStopEndsEveryStateAndWhatHasNoProcessHasStoppedAtOnce) {
  expect({
      {worker::Stopped{}, event::Stop{}, "stopped", {"tell stopped"}},
      {worker::Failed{}, event::Stop{}, "stopped", {"tell stopped"}},
      {worker::Held{}, event::Stop{}, "stopped", {"tell stopped"}},
      {kWaiting, event::Stop{}, "stopped", {"tell stopped"}},
      {kStarting, event::Stop{}, "stopping until 103", {"ask to stop for good"}},
      {kAwaiting, event::Stop{}, "stopping until 103", {"ask to stop for good"}},
      {kReady, event::Stop{}, "stopping until 103", {"ask to stop for good"}},
      {kKilled, event::Stop{}, "stopping until 103", {"ask to stop for good"}},
      {kStopping, event::Stop{}, "stopping until 102", kNothing},
      {kRestarting, event::Stop{}, "stopping until 102", kNothing},
      {kStopping, event::Ended{kSuccess}, "stopped", kStopped},
      {kStopping, event::Ended{kCrash}, "stopped", kStopped},
  });
}

TEST(Next, ARestartIsAStopAndAStart) {
  expect({
      {kReady, event::Restart{}, "stopping until 103, then start", {"ask to stop"}},
      {kReady, event::Restart{true}, "stopping until 103, then start on trial", {"ask to stop"}},
      {kStopping, event::Restart{}, "stopping until 102, then start", kNothing},
      {kRestarting, event::Ended{kSuccess}, "starting until 110", {"read last words", "spawn"}},
      {worker::Stopping{.life = kLife, .kill_ns = {}, .then = Then::start_on_trial},
       event::Ended{kCrash},
       "starting until 110, on trial",
       {"read last words", "spawn"}},
      {worker::Failed{}, event::Restart{}, "starting until 110", {"spawn"}},
      {worker::Stopped{}, event::Restart{true}, "starting until 110, on trial", {"spawn"}},
      {kWaiting, event::Restart{}, "starting until 110", {"spawn"}},
  });
}

TEST(Next, WhatDoesNotStopIsKilledWhenItsTimeIsOverOrSomebodyIsInAHurry) {
  const worker::Stopping late{.life = kLife, .kill_ns = s(100)};
  const worker::Stopping killed{.life = kLife};
  expect({
      {kStopping, event::Tick{}, "stopping until 102", kNothing},
      {late, event::Tick{}, "stopping, killed", {"warn: pose does not stop; killed", "kill"}},
      {killed, event::Tick{}, "stopping, killed", kNothing},
      {killed, event::Ended{kCrash}, "stopped", kStopped},
      {kStopping, event::Hurry{}, "stopping, killed", {"kill"}},
      {kReady, event::Hurry{}, "ready since 95, quiet from 95", kNothing},
  });
}

TEST(Next, ADeathThatNobodyAskedForIsFollowedByAStartAtOnce) {
  const Texts again{"spawn", "read last words",
                    "warn: pose died (signal 11 (Segmentation fault)); started again after 0 ms"};
  expect({
      {kStarting, event::Ended{kCrash}, "starting until 110", again},
      {kAwaiting, event::Ended{kCrash}, "starting until 110", again},
      {kReady, event::Ended{kCrash}, "starting until 110", again},
      {kKilled, event::Ended{kCrash}, "starting until 110", again},
      {worker::Stopped{}, event::Ended{kCrash}, "stopped", kNothing},
  });
}

TEST(Next, ADeathOnTrialIsFinalWhateverItsExitCode) {
  const auto failed = [](const char* end) {
    return Texts{"read last words",
                 fmt::format("warn: pose ended ({}) and is not started again", end), "tell failed"};
  };
  expect({
      {kTrial, event::Ended{{.code = 111}}, "failed", failed("exit 111")},
      {kTrial, event::Ended{kSuccess}, "failed", failed("exit 0")},
      {kReady, event::Ended{kConfigExit}, "failed", failed("exit 100")},
      {kStarting, event::Ended{kConfigExit}, "failed", failed("exit 100")},
      {kStarting, event::NotStarted{kConfigExit}, "failed", failed("exit 100")},
      {kReady,
       event::Ended{kSuccess},
       "stopped",
       {"read last words", "warn: pose ended (exit 0) and is not started again", "tell stopped"}},
  });
}

TEST(Next, AProcessThatCannotBeHadIsTriedAgainAtTheNextTickNotAtOnce) {
  expect({{kStarting,
           event::NotStarted{{.code = 111}},
           "waiting until 100",
           {"read last words",
            "warn: pose cannot start, and is tried again until it can, at least every 7 s; "
            "`handcast devices` lists what is attached"}},
          {worker::Waiting{.due_ns = s(100)}, event::Tick{}, "starting until 110", {"spawn"}},
          {kWaiting, event::Tick{}, "waiting until 101", kNothing}});
}

TEST(Next, AMissingDeviceIsSaidOnceAndThatItIsThereOnce) {
  const Exit missing{.code = 111};
  Machine machine{.state = {.worker = kStarting}};
  EXPECT_THAT(machine.at(100, event::Ended{missing}),
              ElementsAre("spawn", "read last words", HasSubstr("pose cannot start")));
  for (double time_s = 101; time_s < 200; time_s += 10) {
    EXPECT_THAT(machine.at(time_s, event::Ended{missing}), ElementsAre("read last words"));
    EXPECT_THAT(machine.at(time_s + 8, event::Tick{}), ElementsAre("spawn"));
  }
  EXPECT_THAT(machine.at(300, event::SaidReady{true}),
              testing::Contains("warn: pose can start now"));
  EXPECT_THAT(machine.at(301, event::Ended{missing}),
              testing::Contains(HasSubstr("pose died (exit 111)")))
      << "it was ready: that is a death";
  machine.at(310, event::Tick{});
  EXPECT_THAT(machine.at(311, event::Ended{missing}),
              testing::Contains(HasSubstr("pose cannot start")));
  machine.at(320, event::Tick{});
  EXPECT_THAT(machine.at(321, event::Ended{kCrash}),
              testing::Contains(HasSubstr("died (signal 11")))
      << "another end is said";
}

TEST(Next, WhatIsNotReadyInTimeIsKilledAndThenFollowsWhatFollowsADeath) {
  const worker::Starting late{.life = kLife, .late_ns = s(100)};
  expect({
      {kStarting, event::Tick{}, "starting until 105", kNothing},
      {late, event::Tick{}, "killed", {"warn: pose was not ready within 10 s; killed", "kill"}},
      {kKilled, event::Tick{}, "killed", kNothing},
  });
}

TEST(Next, AFirstMessageMustComeWithinTheTimeThatItsNeedsAreReady) {
  Machine machine{.state = {.worker = kAwaiting}};  // it has been dry for 4 s, at 99 s
  EXPECT_THAT(machine.at(102, event::Tick{.needs_are_ready = true}), IsEmpty());
  EXPECT_EQ(machine.worker(), "awaiting its message, dry for 7");
  EXPECT_THAT(machine.at(502, event::Tick{.needs_are_ready = false}), IsEmpty());
  EXPECT_THAT(machine.at(504.9, event::Tick{.needs_are_ready = true}), IsEmpty());
  EXPECT_THAT(
      machine.at(505, event::Tick{.needs_are_ready = true}),
      ElementsAre("warn: pose reported ready, but published nothing for 10 s; killed", "kill"));
}

TEST(Next, TheWatchdogBitesAfterTwoSilentSecondsAndNotEarlier) {
  Machine machine{.state = {.worker = kReady}};
  EXPECT_THAT(machine.at(100, event::Tick{.last_sign_ns = s(98.001)}), IsEmpty());
  EXPECT_THAT(machine.at(100, event::Tick{.last_sign_ns = s(98)}),
              ElementsAre("warn: pose has given no sign of life for 2.0 s; killed", "kill"));
  EXPECT_EQ(machine.worker(), "killed");
  EXPECT_THAT(machine.at(200, event::Tick{.last_sign_ns = s(98)}), IsEmpty())
      << "that is said once";
}

TEST(Next, OneThatWasNeverHeardIsSilentSinceItWasReady) {
  Machine machine{.state = {.worker = kReady}};
  EXPECT_THAT(machine.at(96.9, event::Tick{}), IsEmpty());
  EXPECT_THAT(machine.at(97, event::Tick{}), ElementsAre(HasSubstr("no sign of life"), "kill"));
}

/// The first time, in s, at which a worker that is silent since 95 s and does this is killed. It is
/// looked at every 50 ms, as the rig does it.
double killed_at(Activity activity, double silent_s) {
  Machine machine{.state = {.worker = kReady}};
  machine.rules.silent_ns = s(silent_s);
  for (double time_s = 95; time_s < 500; time_s += 0.05) {
    const auto now_ns = s(time_s);
    const bool looks = is_suspicious(machine.state, std::nullopt, now_ns, machine.rules);
    machine.at(time_s, event::Tick{.activity = looks ? activity : Activity::unknown});
    if (machine.worker() == "killed") return time_s;
  }
  return 0;
}

TEST(Next, AWorkerThatIsStoppedOrAsleepIsKilledEarlierThanOneThatWorks) {
  EXPECT_NEAR(killed_at(Activity::busy, 2), 97, 0.051);
  EXPECT_NEAR(killed_at(Activity::unknown, 2), 97, 0.051);
  EXPECT_NEAR(killed_at(Activity::asleep, 2), 96, 0.051);
  EXPECT_NEAR(killed_at(Activity::stopped, 2), 95.5, 0.051);
  EXPECT_NEAR(killed_at(Activity::stopped, 300), 95 + 75, 0.051) << "for a debugger";
  EXPECT_NEAR(killed_at(Activity::stopped, 0.4), 95.3, 0.051) << "three heartbeats are missing";
  EXPECT_NEAR(killed_at(Activity::asleep, 0.2), 95.2, 0.051) << "silent_s is the limit for all";
}

TEST(Next, AWorkerThatIsSeenAtWorkOnceInItsSilenceGetsTheWholeTime) {
  Machine machine{.state = {.worker = kReady}};
  for (double time_s = 95.3; time_s < 96.95; time_s += 0.05) {
    const bool works = static_cast<int>(time_s * 20) % 6 == 0;  // every 0.3 s
    ASSERT_THAT(
        machine.at(time_s, event::Tick{.activity = works ? Activity::busy : Activity::asleep}),
        IsEmpty())
        << time_s;
  }
  EXPECT_THAT(machine.at(97, event::Tick{.activity = Activity::busy}),
              ElementsAre("warn: pose has given no sign of life for 2.0 s; killed", "kill"));
}

TEST(Next, TimeWithoutAProcessorIsNoSilenceUntilReadyS) {
  Machine machine{.state = {.worker = kReady}};
  const auto wait = [&](double time_s, double held_up_s) {
    return machine.at(time_s, event::Tick{.activity = Activity::busy, .held_up_ns = s(held_up_s)});
  };
  EXPECT_THAT(wait(97.5, 1.5), IsEmpty()) << "it had a processor for 1 s of 2.5";
  EXPECT_THAT(wait(98.4, 0), IsEmpty());
  EXPECT_THAT(wait(98.5, 0), ElementsAre(HasSubstr("no sign of life for 3.5 s"), "kill"));

  machine.state = {.worker = kReady};
  EXPECT_THAT(wait(104.9, 9.9), IsEmpty());
  EXPECT_THAT(wait(105, 0.1), ElementsAre(HasSubstr("no sign of life for 10.0 s"), "kill"));
}

TEST(Next, OneLookIsNotEnoughToCallAWorkerHung) {
  Machine machine{.state = {.worker = kReady}};
  EXPECT_THAT(machine.at(96.5, event::Tick{.activity = Activity::stopped}), IsEmpty())
      << "the supervisor may have been away itself";
  EXPECT_THAT(machine.at(96.55, event::Tick{.last_sign_ns = s(96.52)}), IsEmpty());
  EXPECT_THAT(
      machine.at(97.2, event::Tick{.last_sign_ns = s(96.52), .activity = Activity::stopped}),
      IsEmpty())
      << "the earlier look does not count";
  EXPECT_THAT(
      machine.at(97.35, event::Tick{.last_sign_ns = s(96.52), .activity = Activity::stopped}),
      ElementsAre("warn: pose has given no sign of life for 0.8 s and is stopped; killed", "kill"));
}

TEST(Next, AStandstillIsHeldAgainstNobody) {
  const event::StoodStill forgiven{s(30)};
  expect({
      {kStarting, forgiven, "starting until 135", kNothing},
      {kReady, forgiven, "ready since 95, quiet from 100", kNothing},
      {kStopping, forgiven, "stopping until 132", kNothing},
      {kWaiting, forgiven, "waiting until 101", kNothing},
  });
  Machine machine{.state = {.worker = kAwaiting}};
  machine.at(129, forgiven);
  machine.at(130, event::Tick{});
  EXPECT_EQ(machine.worker(), "awaiting its message, dry for 5")
      << "31 s, of which 30 do not count";
}

/// The waits of deaths that follow each other, each at once after a start.
std::vector<double> waits_ms(int deaths, double first_s) {
  Machine machine;
  std::vector<double> waits;
  machine.at(first_s, event::Start{});
  for (double time_s = first_s; deaths-- > 0;) {
    machine.at(time_s, event::Ended{kCrash});
    const auto* waiting = std::get_if<worker::Waiting>(&machine.state.worker);
    waits.push_back(waiting ? ns_to_ms(waiting->due_ns - s(time_s)) : 0);
    if (waiting) time_s = ns_to_seconds(waiting->due_ns);
    machine.at(time_s, event::Tick{});
  }
  return waits;
}

TEST(Next, RestartsWaitTwiceAsLongEachAndUpToAQuarterLonger) {
  const std::vector<double> least_ms{0, 50, 100, 200, 400, 800};
  std::vector<double> longest(least_ms.size(), 0);
  for (int i = 0; i < 2000; ++i) {
    const auto waits = waits_ms(6, 100 + 0.0000001 * i);
    for (std::size_t k = 0; k < waits.size(); ++k) {
      EXPECT_GE(waits[k], least_ms[k]);
      EXPECT_LE(waits[k], 1.25 * least_ms[k] + 1e-6);
      longest[k] = std::max(longest[k], waits[k]);
    }
  }
  for (std::size_t k = 1; k < longest.size(); ++k)
    EXPECT_GT(longest[k], 1.2 * least_ms[k]) << "jitter keeps those apart that died together";
}

TEST(Next, OneThatDiesTooOftenIsRetriedSlowly) {
  Machine machine;
  machine.at(100, event::Start{});
  for (int i = 1; i < 10; ++i) {
    machine.at(100 + 6.5 * i, event::Ended{kCrash});
    machine.at(100 + 6.5 * i + 6.4, event::Tick{});
    ASSERT_EQ(shown(machine.state.worker), State::starting) << i;
  }
  EXPECT_THAT(machine.at(165, event::Ended{kCrash}),
              ElementsAre("read last words", HasSubstr("died (signal 11 (Segmentation fault)), too "
                                                       "often; started again after")));
  EXPECT_EQ(shown(machine.state.worker), State::degraded);
  EXPECT_THAT(machine.at(169.9, event::Tick{}), IsEmpty());
  EXPECT_THAT(machine.at(171.3, event::Tick{}), ElementsAre("spawn"));
}

TEST(Next, ThirtySecondsOfHealthMakeTheNextRestartImmediate) {
  Machine machine{.state = {.worker = kReady, .past = {.deaths = {.streak = 3, .recent_ns = {}}}}};
  auto unhealthy = machine;
  EXPECT_THAT(unhealthy.at(124, event::Ended{kCrash}), testing::Not(testing::Contains("spawn")));
  EXPECT_THAT(machine.at(125, event::Ended{kCrash}), testing::Contains("spawn"));
}

TEST(Next, APlannedRestartDoesNotCountAsARestart) {
  Machine machine;
  machine.at(1, event::Start{});
  machine.at(2, event::SaidReady{});
  machine.at(3, event::Restart{});
  machine.at(4, event::Ended{kSuccess});
  EXPECT_EQ(machine.worker(), "starting until 14");
  EXPECT_EQ(machine.state.past.restarts, 0);
}

TEST(Next, EachStartAfterADeathIsARestart) {
  Machine machine;
  machine.at(1, event::Start{});
  EXPECT_EQ(machine.state.past.restarts, 0);
  EXPECT_EQ(machine.state.past.first_start_ns, s(1));
  machine.at(2, event::Ended{kCrash});
  EXPECT_EQ(machine.state.past.restarts, 1);
  EXPECT_EQ(machine.state.past.first_start_ns, s(1));
  EXPECT_EQ(machine.state.past.last_exit->code, 11);
  EXPECT_FALSE(machine.state.past.was_ready);
  machine.at(3, event::SaidReady{});
  EXPECT_TRUE(machine.state.past.was_ready);
}

TEST(Next, AnInheritedServiceCountsOn) {
  Machine machine;
  machine.at(1, event::Inherited{State::ready, 3});
  EXPECT_EQ(machine.state.past.restarts, 3);
  EXPECT_FALSE(machine.state.past.first_start_ns) << "it is to be begun, or adopted";
  machine.at(2, event::Adopted{s(0.5)});
  EXPECT_EQ(machine.state.past.restarts, 3);
  EXPECT_EQ(life_of(machine.state.worker)->started_ns, s(0.5));
  machine.at(3, event::Ended{kCrash});
  EXPECT_EQ(machine.state.past.restarts, 4);
}

TEST(Next, APersonSeesOneOfSixStates) {
  EXPECT_EQ(shown(worker::Held{}), State::starting);
  EXPECT_EQ(shown(kWaiting), State::starting);
  EXPECT_EQ(shown(worker::Waiting{.degraded = true}), State::degraded);
  EXPECT_EQ(shown(kAwaiting), State::starting);
  EXPECT_EQ(shown(kReady), State::ready);
  EXPECT_EQ(shown(kKilled), State::starting) << "about to be started again";
  EXPECT_EQ(shown(worker::AwaitingStandby{}), State::stopping);
}

}  // namespace
}  // namespace handcast::supervisor
