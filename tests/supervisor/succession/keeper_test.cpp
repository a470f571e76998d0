// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/keeper.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "supervisor/base/exit.hpp"
#include "supervisor/base/process.hpp"
#include "tests/supervisor/scope_scratch.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

bool eventually(const std::function<bool()>& done) {
  for (const auto limit = Deadline::in(std::chrono::seconds(30)); !limit.passed(); usleep(5000))
    if (done()) return true;
  return done();
}

/// A keeper process whose supervisor is a script. The script appends its notes to $NOTES.
class KeeperTest : public testing::Test {
 protected:
  void TearDown() override {
    for (const pid_t pid : {keeper_, pid_in("supervisor")})
      if (pid > 0) kill(pid, SIGKILL);
    if (keeper_ > 0) waitpid(keeper_, nullptr, 0);
  }

  void keep_script(const std::string& script, const std::string& program = "/bin/bash") {
    setenv("FOLDER", scratch_.path().c_str(), 1);
    setenv("NOTES", notes_file().c_str(), 1);
    keeper_ = fork();
    if (keeper_ != 0) return;
    freopen((scratch_.path() / "log").c_str(), "w", stderr);
    const auto option = program == "/bin/bash" ? "-c" : "-e";
    _exit(keep({program, option, script}));
  }
  int wait() {
    int status = 0;
    if (!eventually([&] { return waitpid(keeper_, &status, WNOHANG) == keeper_; })) return -1;
    keeper_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// Sends a signal to the keeper, and waits until it has taken it: two that wait would be one.
  void send(int number) const {
    kill(keeper_, number);
    EXPECT_TRUE(eventually([&] { return !is_pending(number); }));
  }
  bool is_pending(int number) const {
    std::ifstream file("/proc/" + std::to_string(keeper_) + "/status");
    for (std::string word; file >> word;)
      if (std::uint64_t signals = 0; word == "ShdPnd:" && file >> std::hex >> signals)
        return signals >> (number - 1) & 1;
    return false;
  }

  std::filesystem::path notes_file() const { return scratch_.path() / "notes"; }
  std::vector<std::string> notes() const {
    std::vector<std::string> lines;
    std::ifstream file(notes_file());
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(scratch_.path() / "log").rdbuf();
    return text.str();
  }
  pid_t pid_in(const std::string& file) const {
    pid_t pid = -1;
    std::ifstream(scratch_.path() / file) >> pid;
    return pid;
  }

  static pid_t child_of(pid_t pid) {
    pid_t child = -1;
    std::ifstream(fmt::format("/proc/{0}/task/{0}/children", pid)) >> child;
    return child;
  }

  ScopeScratch scratch_;
  pid_t keeper_ = -1;
};

TEST_F(KeeperTest, ItsSupervisorsExitCodeIsItsOwn) {
  keep_script("echo once >> $NOTES; exit 100");
  EXPECT_EQ(wait(), 100);
  EXPECT_THAT(notes(), ElementsAre("once"));
}

TEST_F(KeeperTest, AProgramThatIsNotThereIsASentence) {
  keep_script("", "/nowhere/handcast");
  EXPECT_EQ(wait(), kExitRetry);
  EXPECT_THAT(log(), HasSubstr("/nowhere/handcast"));
}

TEST_F(KeeperTest, ASupervisorThatIsKilledIsStartedAgainAndToldThatItIsASuccessor) {
  keep_script(
      "echo life $HANDCAST_SUCCESSOR >> $NOTES; [ $(wc -l < $NOTES) -ge 3 ] && exit 7; kill -9 $$");
  EXPECT_EQ(wait(), 7);
  EXPECT_THAT(notes(), ElementsAre("life", "life 1", "life 1"));
  EXPECT_THAT(log(), HasSubstr("signal 9"));
}

TEST_F(KeeperTest, ASuccessorThatCannotTakeOverNowIsTriedAgain) {
  keep_script(
      "echo life >> $NOTES; case $(wc -l < $NOTES) in 1) kill -9 $$;; 2) exit 111;; *) exit 7;; "
      "esac");
  EXPECT_EQ(wait(), 7);
  EXPECT_THAT(log(), HasSubstr("exit 111"));
}

TEST_F(KeeperTest, AFirstSupervisorThatCannotStartIsNotTriedAgain) {
  keep_script("echo life >> $NOTES; exit 111");
  EXPECT_EQ(wait(), kExitRetry);
  EXPECT_THAT(notes(), ElementsAre("life"));
}

TEST_F(KeeperTest, OneThatDiesAgainAndAgainIsGivenUpWithASentence) {
  keep_script("echo life >> $NOTES; kill -ABRT $$");
  EXPECT_EQ(wait(), kExitRetry);
  EXPECT_THAT(notes(), SizeIs(10));
  EXPECT_THAT(log(), HasSubstr("`handcast down` stops them"));
}

TEST_F(KeeperTest, TheSupervisorRunsInAProcessGroupOfItsOwn) {
  keep_script("ps -o pgid= -p $$ | tr -d ' ' >> $NOTES; echo $$ >> $NOTES");
  EXPECT_EQ(wait(), 0);
  ASSERT_THAT(notes(), SizeIs(2));
  EXPECT_EQ(notes()[0], notes()[1]);
}

constexpr auto kListens =
    "use POSIX; alarm 60; my $n; $SIG{TERM} = sub { $n .= 'T' }; $SIG{INT} = sub { $n .= 'I' }; "
    "$SIG{HUP} = sub { $n .= 'H' };"
    "sub note { open(my $f, '>>', $ENV{NOTES}); print $f \"$_[0]\\n\"; }"
    "note($$); sigprocmask(SIG_UNBLOCK, POSIX::SigSet->new(SIGTERM, SIGINT, SIGHUP));"
    "for (;;) { select(undef, undef, undef, 0.02); if ($n) { note($n); exit 5 if $n =~ /T/; $n = "
    "''; } }";

TEST_F(KeeperTest, StopSignalsAreHandedOnOnceEach) {
  keep_script(kListens, "/usr/bin/perl");
  for (const auto& [number, name] : {std::pair{SIGINT, "I"}, {SIGHUP, "H"}, {SIGTERM, "T"}}) {
    const auto before = notes().size();
    ASSERT_TRUE(eventually([&] { return before > 0 || !notes().empty(); }));
    const auto lines = notes().size();
    kill(keeper_, number);
    ASSERT_TRUE(eventually([&] { return notes().size() > lines; })) << name;
    EXPECT_EQ(notes().back(), name);
  }
  EXPECT_EQ(wait(), 5);
}

TEST_F(KeeperTest, AStopSignalReachesTheSuccessorOfASupervisorThatDiedOverIt) {
  keep_script(std::string("if (!$ENV{HANDCAST_SUCCESSOR}) { note('first'); select(undef, undef, "
                          "undef, 0.5); kill 9, $$; }") +
                  kListens,
              "/usr/bin/perl");
  ASSERT_TRUE(eventually([&] { return !notes().empty(); }));
  kill(keeper_, SIGTERM);
  EXPECT_EQ(wait(), 5);
  EXPECT_EQ(notes().back(), "T");
}

// The keeper also inherits the children of services when the supervisor dies, and reports their
// ends to the next supervisor.
TEST_F(KeeperTest, OrphansAreReapedAndTheirEndsToldToTheNextSupervisorEvenThoseThatDiedBetweenTwo) {
  keep_script(
      "if (!$ENV{HANDCAST_SUCCESSOR}) {"
      "  for my $what ('exit 42', 'kill 9, $$') { my $pid = fork(); if (!$pid) { select(undef, "
      "undef, undef, 0.1); eval $what; } "
      "    open(my $f, '>>', $ENV{NOTES}); print $f \"$pid\\n\"; }"
      "  kill 9, $$; }"
      "alarm 20; use Socket; open(my $s, '<&=', $ENV{HANDCAST_KEEPER_FD}) or die;"
      "for (1..2) { recv($s, my $report, 64, 0); open(my $f, '>>', $ENV{NOTES}); print $f join(' "
      "', unpack('i3', $report)), \"\\n\"; }",
      "/usr/bin/perl");
  EXPECT_EQ(wait(), 0);
  const auto lines = notes();
  ASSERT_THAT(lines, SizeIs(4));
  const auto exited = fmt::format("{} {} 42", lines[0], CLD_EXITED),
             killed = fmt::format("{} {} 9", lines[1], CLD_KILLED);
  EXPECT_THAT((std::vector{lines[2], lines[3]}), testing::UnorderedElementsAre(exited, killed));
}

/// Perl: beat(STOPPING) sends a beat of the rig "desk" to the keeper.
constexpr auto kBeats =
    "use Socket; open(my $s, '+<&=', $ENV{HANDCAST_KEEPER_FD}) or die;"
    "sub beat { send($s, pack('Ca108', $_[0], 'desk'), 0) }"
    "sub note { open(my $f, '>>', $ENV{NOTES}); print $f \"$_[0]\\n\"; }";

TEST_F(KeeperTest, ASupervisorThatSendsNoMoreBeatsIsReplaced) {
  keep_script(std::string(kBeats) +
                  "note('life'); exit 7 if $ENV{HANDCAST_SUCCESSOR}; beat(0); sleep 1000;",
              "/usr/bin/perl");
  EXPECT_EQ(wait(), 7);
  EXPECT_THAT(notes(), ElementsAre("life", "life"));
  EXPECT_THAT(log(), HasSubstr("no sign of life"));
}

TEST_F(KeeperTest, ASupervisorThatSendsBeatsIsLeftAlone) {
  keep_script(
      std::string(kBeats) + "for (1..30) { beat(0); select(undef, undef, undef, 0.1); } exit 7;",
      "/usr/bin/perl");
  EXPECT_EQ(wait(), 7);
  EXPECT_EQ(log(), "");
}

TEST_F(KeeperTest, AKeeperThatStoodStillDoesNotBlameItsSupervisor) {
  keep_script(std::string(kBeats) +
                  "for (1..60) { beat(0); note($_); select(undef, undef, undef, 0.1); } exit 7;",
              "/usr/bin/perl");
  ASSERT_TRUE(eventually([&] { return !notes().empty(); }));
  const pid_t supervisor = child_of(keeper_);
  kill(keeper_, SIGSTOP);
  kill(supervisor, SIGSTOP);
  usleep(2'500'000);
  kill(keeper_, SIGCONT);
  usleep(200'000);
  kill(supervisor, SIGCONT);
  EXPECT_EQ(wait(), 7);
  EXPECT_EQ(log(), "");
}

TEST_F(KeeperTest, ASignalThatWasIgnoredAtItsStartStopsNothing) {
  const auto before = signal(SIGHUP, SIG_IGN);  // as nohup(1) does
  keep_script(std::string(kBeats) +
                  "note('life'); exit 7 if $ENV{HANDCAST_SUCCESSOR}; beat(0);"
                  "select(undef, undef, undef, 1); kill 9, $$;",
              "/usr/bin/perl");
  signal(SIGHUP, before);
  ASSERT_TRUE(eventually([&] { return !notes().empty(); }));
  kill(keeper_, SIGHUP);
  EXPECT_EQ(wait(), 7) << "the rig was not to be stopped";
  EXPECT_THAT(notes(), ElementsAre("life", "life"));
}

TEST_F(KeeperTest, ASupervisorThatDiesWhileTheRigStopsHasNoSuccessor) {
  keep_script(std::string(kBeats) + "note('life'); beat(1); kill 9, $$;", "/usr/bin/perl");
  EXPECT_EQ(wait(), kExitBadResult);
  EXPECT_THAT(notes(), ElementsAre("life"));
  EXPECT_THAT(log(), HasSubstr("before rig 'desk' had stopped"));
}

TEST_F(KeeperTest, AStopBeforeTheFirstBeatEndsASupervisorThatHangsForGood) {
  keep_script("echo life >> $NOTES; trap '' TERM INT; while :; do sleep 0.1; done");
  ASSERT_TRUE(eventually([&] { return !notes().empty(); }));
  for (int i = 0; i < 3; ++i) send(SIGINT);
  EXPECT_EQ(wait(), kExitBadResult);
  EXPECT_THAT(notes(), ElementsAre("life"));
}

TEST_F(KeeperTest, TheThirdStopSignalKillsASupervisorThatDoesNotStop) {
  keep_script(std::string(kBeats) +
                  "$SIG{ALRM} = sub { beat(0); }; use Time::HiRes 'setitimer';"
                  "setitimer(Time::HiRes::ITIMER_REAL(), 0.1, 0.1); beat(0); note('life');"
                  "for (1..600) { select(undef, undef, undef, 0.1); }",
              "/usr/bin/perl");
  ASSERT_TRUE(eventually([&] { return !notes().empty(); }));
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(waitpid(keeper_, nullptr, WNOHANG), 0);
    send(SIGINT);
  }
  EXPECT_EQ(wait(), kExitBadResult);
}

TEST_F(KeeperTest, TheSupervisorGoesOnWhenTheKeeperDies) {
  keep_script("echo $$ > $FOLDER/supervisor; exec sleep 1000");
  ASSERT_TRUE(eventually([&] { return pid_in("supervisor") > 0; }));
  kill(keeper_, SIGKILL);
  wait();
  usleep(50'000);
  EXPECT_TRUE(start_ticks_of(pid_in("supervisor")));
}

}  // namespace
}  // namespace handcast::supervisor
