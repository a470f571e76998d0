// SPDX-License-Identifier: Apache-2.0
// Daemons of a few lines, run in a process of their own, judged by their exit codes and last words.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ipc/base/exit_code.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/runtime/context.hpp"

namespace handcast::service {
namespace {

using testing::ElementsAre;
using testing::ExitedWithCode;
using testing::HasSubstr;

ipc::Segment make_ring(const ipc::RingSpec& spec) { return ipc::Segment::create(spec).value(); }

class Run : public testing::Test {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "fast");
    char name[] = "/tmp/handcast-runtime-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder_ = name;
    rig_ = (folder_ / "rig.toml").string();
    write_rig("name = \"desk\"\n");
    for (const char* variable : daemon::kHandoverVariables) unsetenv(variable);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write_rig(const std::string& text) { std::ofstream(rig_) << text; }
  int daemon(const std::function<void(Context&)>& body, std::vector<std::string> arguments = {}) {
    if (arguments.empty()) arguments = {"--config", rig_};
    arguments.insert(arguments.begin(), "handcast-pose");
    std::vector<char*> pointers;
    for (auto& argument : arguments) pointers.push_back(argument.data());
    return run({.name = "pose",
                .summary = "Samples the hand tracker.",
                .paced_by = "its device",
                .publishes = {"pose.hands"},
                .settings = {"hand"},
                .backends = {{"twin", "Models one."}, {"replay", "Plays one."}}},
               static_cast<int>(pointers.size()), pointers.data(), body);
  }
  static void give_rings(const ipc::Segment& poses, const ipc::Segment& marks) {
    setenv("HANDCAST_RINGS",
           fmt::format("pose.hands={},marks.pose={}", poses.fd(), marks.fd()).c_str(), 1);
  }

  std::filesystem::path folder_;
  std::string rig_;
  ipc::Segment poses_ = make_ring(ipc::RingSpec::of<msg::HandPoses>("pose.hands", 8, true));
  ipc::Segment marks_ = make_ring(ipc::RingSpec::of<msg::StageMarks>("marks.pose", 64, true));
};

void do_nothing(Context&) {}

/// A daemon whose marks are kept, those of frames and beats alike.
class Heart : public Run {
 protected:
  std::vector<msg::StageMarks> marks_of(const std::function<void(Context&)>& body) {
    give_rings(poses_, marks_);
    auto reader = ipc::Reader<msg::StageMarks>::attach(std::move(marks_)).value();
    daemon(body);
    std::vector<msg::StageMarks> messages;
    while (const auto message = reader.next(Deadline::now())) messages.push_back(**message);
    return messages;
  }
};

TEST_F(Run, ADaemonThatIsAskedToStopEndsWithZero) {
  const auto until_told = [](Context& context) {
    context.ready();
    raise(SIGTERM);
    while (context.running()) FAIL() << "still running after SIGTERM";
  };
  EXPECT_EXIT(_exit(daemon(until_told)), ExitedWithCode(0), "stopped");
}

TEST_F(Run, OnlyADaemonThatIsStoppedForGoodMayFinishAndOnlyUntilItIsAskedAgain) {
  const auto stopped_by = [this](std::initializer_list<int> signals, bool may_finish) {
    const auto body = [&](Context& context) {
      EXPECT_FALSE(context.may_finish());
      for (const int number : signals) raise(number);
      EXPECT_FALSE(context.running());
      _exit(context.may_finish() == may_finish && !HasFailure() ? 5 : 6);
    };
    EXPECT_EXIT(daemon(body), ExitedWithCode(5), "");
  };
  stopped_by({SIGINT}, true);
  stopped_by({SIGTERM}, false);
  stopped_by({SIGINT, SIGTERM}, false);
  stopped_by({SIGINT, SIGINT}, false);
  stopped_by({SIGTERM, SIGINT}, false);
}

TEST_F(Run, AWriteIntoAClosedPipeDoesNotEndADaemon) {
  const auto write_to_nobody = [](Context&) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    close(ends[0]);
    EXPECT_EQ(write(ends[1], "x", 1), -1);
  };
  EXPECT_EXIT(_exit(daemon(write_to_nobody)), ExitedWithCode(0), "");
}

TEST_F(Run, ABrokenRigFileIsExitHundredWithItsLine) {
  write_rig("[camera]\nrate_hz = -5\n");
  EXPECT_EXIT(_exit(daemon(do_nothing)), ExitedWithCode(kExitConfig), "rig.toml:2.*rate_hz");
  EXPECT_EXIT(_exit(daemon(do_nothing, {"--config", "/nowhere/rig.toml"})),
              ExitedWithCode(kExitConfig), "/nowhere/rig.toml");
}

TEST_F(Run, SettingsOfTheCommandLineWin) {
  const auto expect_rate = [](Context& context) {
    _exit(context.rig().camera.rate_hz == 77 ? 5 : 6);
  };
  EXPECT_EXIT(_exit(daemon(expect_rate, {"--config", rig_, "--set", "camera.rate_hz=77"})),
              ExitedWithCode(5), "");
}

TEST_F(Run, StartedByHandTheSentenceNamesTheCommandThatWorks) {
  const auto open_ring = [](Context& context) {
    must(context.writer<msg::HandPoses>("pose.hands"));
  };
  EXPECT_EXIT(_exit(daemon(open_ring)), ExitedWithCode(kExitConfig), "handcast up");
}

TEST_F(Run, WhatRestartingMayHelpIsExitHundredAndEleven) {
  const auto fail_with = [](Errc code) {
    return [code](Context&) { must(Result<int>(fail(code, "the tracker is unplugged"))); };
  };
  EXPECT_EXIT(_exit(daemon(fail_with(Errc::disconnected))), ExitedWithCode(kExitRetry),
              "the tracker is unplugged");
  EXPECT_EXIT(_exit(daemon(fail_with(Errc::unavailable))), ExitedWithCode(kExitRetry), "");
  EXPECT_EXIT(_exit(daemon(fail_with(Errc::bad_config))), ExitedWithCode(kExitConfig), "");
}

TEST_F(Run, ADamagedFileAtStartUpIsExitHundredForItStaysDamaged) {
  const auto open_recording = [](Context&) {
    must(Result<int>(fail(Errc::bad_data, "joints_left.npy: its header is cut off")));
  };
  EXPECT_EXIT(_exit(daemon(open_recording)), ExitedWithCode(kExitConfig), "its header is cut off");
}

TEST_F(Run, AnExceptionIsASentenceAndExitHundredAndEleven) {
  const auto throws = [](Context&) { throw std::runtime_error("a library's own words"); };
  EXPECT_EXIT(_exit(daemon(throws)), ExitedWithCode(kExitRetry), "error.*a library's own words");
}

TEST_F(Run, TimeoutsAndBadItemsAreToleratedAndALostDeviceIsNot) {
  const auto body = [](Context& context) {
    for (int i = 0; i < 1000; ++i) context.tolerate({Errc::timeout, "no frame"});
    context.tolerate({Errc::bad_data, "half a frame"});
    context.tolerate({Errc::disconnected, "camera gone"});
  };
  EXPECT_EXIT(_exit(daemon(body)), ExitedWithCode(kExitRetry), "camera gone");
}

TEST_F(Run, AThousandTimeoutsAreOneLineOfLog) {
  const auto body = [](Context& context) {
    for (int i = 0; i < 1000; ++i) context.tolerate({Errc::timeout, "no frame"});
  };
  testing::internal::CaptureStderr();
  daemon(body);
  const auto log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.find("no frame"), log.rfind("no frame"));
  EXPECT_THAT(log, HasSubstr("no frame"));
}

TEST_F(Run, ReadyIsOneNewlineOnTheReadyDescriptor) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  setenv("HANDCAST_READY_FD", std::to_string(ends[1]).c_str(), 1);
  daemon([](Context& context) {
    context.ready();
    context.ready();
  });
  char bytes[8];
  EXPECT_EQ(read(ends[0], bytes, sizeof bytes), 1) << "and then the end: the descriptor is closed";
  EXPECT_EQ(bytes[0], '\n');
  EXPECT_EQ(read(ends[0], bytes, sizeof bytes), 0);
  close(ends[0]);
}

TEST_F(Run, TheEpochIsTheSupervisors) {
  setenv("HANDCAST_EPOCH_NS", "123456789", 1);
  std::int64_t epoch_ns = 0;
  daemon([&](Context& context) { epoch_ns = context.epoch_ns(); });
  EXPECT_EQ(epoch_ns, 123456789);
}

TEST_F(Run, MessagesAndMarksArriveInTheRingsHandedOver) {
  give_rings(poses_, marks_);
  auto poses = ipc::Reader<msg::HandPoses>::attach(std::move(poses_)).value();
  auto marks = ipc::Reader<msg::StageMarks>::attach(std::move(marks_)).value();
  daemon([](Context& context) {
    auto writer = must(context.writer<msg::HandPoses>("pose.hands"));
    msg::HandPoses message;
    message.header = {.frame_id = 7, .origin_ns = 70};
    writer.publish(message);
    const msg::StageMark sample{
        .stage = msg::Stage::sample, .detail = 0, .begin_ns = 1, .end_ns = 2};
    context.mark(message.header, {&sample, 1});
  });
  const auto pose = poses.next(Deadline::now());
  ASSERT_TRUE(pose);
  EXPECT_EQ((*pose)->header.frame_id, 7u);
  const auto mark = marks.next(Deadline::now());
  ASSERT_TRUE(mark);
  EXPECT_EQ((*mark)->header.origin_ns, 70);
  EXPECT_EQ((*mark)->count, 1u);
  EXPECT_EQ((*mark)->marks[0].stage, msg::Stage::sample);
}

TEST_F(Heart, OfAnIdleDaemonBeatsOncePerPeriod) {
  std::int64_t began_ns = 0, ended_ns = 0;
  const auto messages = marks_of([&](Context& context) {
    began_ns = now_ns();
    context.running();
    const auto end_ns = now_ns() + daemon::kBeatEvery_ns;
    while (now_ns() < end_ns) context.running();
    context.running();
    ended_ns = now_ns();
  });
  for (const auto& message : messages) EXPECT_EQ(message.count, 0u);
  EXPECT_GE(std::ssize(messages), 2);
  EXPECT_LE(std::ssize(messages), 1 + (ended_ns - began_ns) / daemon::kBeatEvery_ns);
}

TEST_F(Heart, OfADaemonThatMarksItsFramesDoesNotBeat) {
  std::ptrdiff_t slow_turns = 0;  // in which the machine halted the process for a period
  const auto messages = marks_of([&](Context& context) {
    const auto end_ns = now_ns() + 2 * daemon::kBeatEvery_ns;
    while (now_ns() < end_ns) {
      const auto turn_ns = now_ns();
      const msg::StageMark sample{.stage = msg::Stage::sample, .begin_ns = 1, .end_ns = 2};
      context.mark({.origin_ns = turn_ns}, {&sample, 1});
      sleep_until_ns(turn_ns + daemon::kBeatEvery_ns / 10);
      context.running();
      if (now_ns() - turn_ns >= daemon::kBeatEvery_ns) ++slow_turns;
    }
  });
  const auto beats = std::ranges::count(messages, 0u, &msg::StageMarks::count);
  EXPECT_LE(beats, slow_turns);
  EXPECT_GT(std::ssize(messages), beats) << "the marks of the frames are missing";
}

TEST_F(Run, ARingOfAnotherTypeIsRefusedWithItsName) {
  setenv("HANDCAST_RINGS", fmt::format("pose.hands={}", marks_.fd()).c_str(), 1);
  const auto open_ring = [](Context& context) {
    must(context.writer<msg::HandPoses>("pose.hands"));
  };
  EXPECT_EXIT(_exit(daemon(open_ring)), ExitedWithCode(kExitConfig), "another type of message");
}

TEST_F(Run, ARingThatItsDescriptionDoesNotNameIsRefused) {
  give_rings(poses_, marks_);
  const auto read = [](Context& context) { must(context.reader<msg::HandPoses>("pose.hands")); };
  EXPECT_EXIT(_exit(daemon(read)), ExitedWithCode(kExitConfig),
              "ring 'pose.hands' is not in the description of pose");
}

TEST_F(Run, ItsDescriptionIsCompletedWithWhatEveryDaemonReads) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(daemon(do_nothing, {"--describe"}), 0);
  const auto description =
      daemon::parse_description(testing::internal::GetCapturedStdout()).value();
  EXPECT_EQ(description.settings,
            (std::vector<std::string>{"hand", "calibration", "pose.backend", "pose.process"}));
  EXPECT_EQ(description.publishes, std::vector<std::string>{"pose.hands"});
}

TEST_F(Run, TheListOfBackEndsIsANameAndASentenceALine) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(daemon(do_nothing, {"--backends"}), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "twin    Models one.\nreplay  Plays one.\n");
}

/// A daemon that is started as a standby, and the supervisor's ends of its pipes.
class Standby : public Run {
 protected:
  void SetUp() override {
    Run::SetUp();
    ASSERT_EQ(pipe(ready_), 0);
    ASSERT_EQ(pipe(turn_), 0);
    setenv("HANDCAST_READY_FD", std::to_string(ready_[1]).c_str(), 1);
    setenv("HANDCAST_STANDBY_FD", std::to_string(turn_[0]).c_str(), 1);
  }
  int ready_[2], turn_[2];
};

TEST_F(Standby, PreparesItselfAndTakesWhatOnlyOneMayHaveInItsTurn) {
  give_rings(poses_, marks_);
  const auto again = [](const ipc::Segment& ring) {
    return ipc::Segment::open(UniqueFd(dup(ring.fd()))).value();
  };
  std::optional worker_poses(ipc::Writer<msg::HandPoses>::attach(again(poses_)).value());
  std::optional worker_marks(ipc::Writer<msg::StageMarks>::attach(again(marks_)).value());
  auto marks = ipc::Reader<msg::StageMarks>::attach(again(marks_)).value();

  std::thread standby([&] {
    daemon([](Context& context) {
      context.stand_by();
      must(context.writer<msg::HandPoses>("pose.hands")).publish({});
      context.ready();
      context.mark({.origin_ns = 7}, {});
    });
  });
  char byte = 0;
  EXPECT_EQ(read(ready_[0], &byte, 1), 1);
  EXPECT_EQ(byte, 's');
  worker_poses.reset();  // the worker dies
  worker_marks.reset();
  EXPECT_EQ(write(turn_[1], "1", 1), 1);
  while (byte == 's') ASSERT_EQ(read(ready_[0], &byte, 1), 1);
  EXPECT_EQ(byte, '\n');
  standby.join();
  const auto mark = marks.next(Deadline::now());
  ASSERT_TRUE(mark) << "its marks go into the ring that was the worker's";
  EXPECT_EQ((*mark)->header.origin_ns, 7);
}

TEST_F(Standby, SaysAgainAndAgainThatItIsThere) {
  std::thread standby([&] { daemon([](Context& context) { context.stand_by(); }); });
  char bytes[3];
  for (char& byte : bytes) EXPECT_EQ(read(ready_[0], &byte, 1), 1);
  EXPECT_EQ(std::string(bytes, 3), "sss");
  EXPECT_EQ(write(turn_[1], "1", 1), 1);
  standby.join();
}

TEST_F(Standby, ThatNeverStandsByWaitsAtItsFirstWriterOrWhenItIsReady) {
  close(turn_[1]);  // nobody will ever give it its turn
  give_rings(poses_, marks_);
  EXPECT_EXIT(
      {
        daemon([](Context& context) { must(context.writer<msg::HandPoses>("pose.hands")); });
        _exit(5);
      },
      ExitedWithCode(0), "");
  EXPECT_EXIT(
      {
        daemon([](Context& context) { context.ready(); });
        _exit(5);
      },
      ExitedWithCode(0), "");
}

TEST_F(Standby, ThatIsToldToStopWhileItWaitsEndsWithZero) {
  const auto told = [](Context& context) {
    raise(SIGTERM);
    context.stand_by();
    _exit(5);
  };
  EXPECT_EXIT(daemon(told), ExitedWithCode(0), "");
  const auto told_later = [](Context& context) {
    alarm(1);
    signal(SIGALRM, [](int) { raise(SIGTERM); });
    context.stand_by();
    _exit(5);
  };
  EXPECT_EXIT(daemon(told_later), ExitedWithCode(0), "");
}

TEST_F(Run, ACoreThatIsNotThereIsExitHundred) {
  write_rig("[pose.process]\ncores = [1000]\n");
  EXPECT_EXIT(_exit(daemon(do_nothing)), ExitedWithCode(kExitConfig),
              "pose.process.cores: there is no core 1000");
}

/// A program that is two services.
class Instances : public Run {
 protected:
  int program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "handcast-camera");
    std::vector<char*> pointers;
    for (auto& argument : arguments) pointers.push_back(argument.data());
    const auto instance = [](const std::string& name) {
      return Instance{{.name = name, .summary = "Sees.", .paced_by = "its device"},
                      [name](Context&) { log::info("this is {}", name); },
                      [name](const config::Rig&, const calib::Calibration&) -> Result<void> {
                        return fail(Errc::bad_config, name + " cannot see");
                      }};
    };
    return run(std::array{instance("camera"), instance("camera2")},
               static_cast<int>(pointers.size()), pointers.data());
  }
};

TEST_F(Instances, TheFirstOneRunsUnlessAnotherIsNamed) {
  EXPECT_EXIT(_exit(program({"--config", rig_})), ExitedWithCode(0),
              " camera +info +this is camera\n");
  EXPECT_EXIT(_exit(program({"--as", "camera2", "--config", rig_})), ExitedWithCode(0),
              " camera2 +info +this is camera2\n");
  EXPECT_EXIT(_exit(program({"--as", "camera", "--config", rig_})), ExitedWithCode(0),
              "this is camera\n");
}

TEST_F(Instances, EachHasItsOwnSchedulingCheckAndDescription) {
  write_rig("[camera2.process]\ncores = [1000]\n");
  testing::internal::CaptureStdout();
  EXPECT_EQ(program({"--as", "camera2", "--config", rig_, "--check"}), kExitConfig);
  const auto faults = testing::internal::GetCapturedStdout();
  EXPECT_THAT(faults, HasSubstr("camera2.process.cores: there is no core 1000"));
  EXPECT_THAT(faults, HasSubstr("camera2 cannot see"));
  testing::internal::CaptureStdout();
  EXPECT_EQ(program({"--as", "camera2", "--describe"}), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("\"camera2.process\""));
}

TEST_F(Instances, OneThatTheProgramIsNotIsRefusedWithThoseThatItIs) {
  EXPECT_EXIT(_exit(program({"--as", "camera3", "--config", rig_})), ExitedWithCode(kExitUsage),
              "--as: this program is camera or camera2, not .camera3.");
}

TEST(DescribeAt, TheSecondViewpointHasItsOwnRingsAndSettings) {
  const auto second = describe_at(config::Viewpoint::second,
                                  {.name = "landmarks",
                                   .summary = "Finds.",
                                   .paced_by = "camera.frames",
                                   .publishes = {"landmarks.hands"},
                                   .subscribes = {"camera.frames", "pose.hands"},
                                   .settings = {"landmarks.hands"},
                                   .backends = {{"a", "A.", {"camera.rate_hz", "twin"}}}});
  EXPECT_EQ(second.name, "landmarks2");
  EXPECT_EQ(second.paced_by, "camera2.frames");
  EXPECT_THAT(second.publishes, ElementsAre("landmarks2.hands"));
  EXPECT_THAT(second.subscribes, ElementsAre("camera2.frames", "pose.hands"));
  EXPECT_THAT(second.settings, ElementsAre("landmarks2.hands"));
  EXPECT_THAT(second.backends[0].settings, ElementsAre("camera2.rate_hz", "twin"));
}

}  // namespace
}  // namespace handcast::service
