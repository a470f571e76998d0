// SPDX-License-Identifier: Apache-2.0
// `handcast record` of a running rig, and the recording played in another one.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>

#include "calib/calibration.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/recording/recording_reader.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using recording::StreamReader;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// The messages of a stream by their number, with their images.
template <class T>
struct Recorded {
  T message;
  std::vector<std::uint8_t> pixels;
  recording::IndexRow row;
};

class Recording : public SystemTest {
 protected:
  std::string in_scratch(const std::string& name) const {
    return (scratch_.path() / name).string();
  }
  Outcome record(const std::string& name, const Arguments& more) const {
    Arguments arguments{"record", in_scratch(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return handcast(arguments);
  }
  template <class T>
  std::map<std::uint64_t, Recorded<T>> read(const std::string& name, const char* stream) const {
    std::map<std::uint64_t, Recorded<T>> all;
    auto reader = StreamReader::open<T>(in_scratch(name), stream);
    EXPECT_TRUE(reader) << reader.error().what;
    for (std::size_t i = 0; reader && i < reader->rows().size(); ++i) {
      Recorded<T> one{{}, {}, reader->rows()[i]};
      one.pixels.resize(reader->shape_of(one.row).bytes());
      EXPECT_TRUE(reader->read(i, one.message, one.pixels));
      // Times that each rig has of its own.
      one.message.header.origin_ns = one.message.header.published_ns = 0;
      all.insert_or_assign(one.row.frame_id, std::move(one));
    }
    return all;
  }
  /// Compares the messages that are in both recordings. Returns how many there are; `shift_ns`:
  /// between their origins, the same for all.
  template <class T>
  int compare(const char* stream, std::int64_t& shift_ns) const {
    const auto first = read<T>("first", stream), second = read<T>("second", stream);
    int count = 0;
    for (const auto& [number, message] : second) {
      const auto found = first.find(number);
      if (found == first.end()) continue;  // of a later lap
      const auto shift = message.row.origin_ns - found->second.row.origin_ns;
      if (shift_ns == 0) shift_ns = shift;
      EXPECT_EQ(shift, shift_ns) << stream << " " << number;
      EXPECT_EQ(message.pixels, found->second.pixels) << stream << " " << number;
      EXPECT_EQ(std::memcmp(&message.message, &found->second.message, sizeof(T)), 0)
          << stream << " " << number;
      EXPECT_GE(message.row.published_ns - message.row.origin_ns,
                found->second.row.published_ns - found->second.row.origin_ns)
          << "never earlier than recorded";
      ++count;
    }
    return count;
  }
};

TEST_F(Recording, PlayedAndRecordedAgainItIsTheSame) {
  {
    const auto rig = up();
    wait_until_light();
    const auto outcome = record("first", {"--seconds", "6"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
    EXPECT_THAT(outcome.output, HasSubstr("projection.frames"));
    EXPECT_EQ(handcast({"down"}).exit_code, 0);
  }
  const Command rig(scratch_.path(), {"play", in_scratch("first")});
  ASSERT_TRUE(eventually([&] { return !status().is_null(); }));
  ASSERT_EQ(record("second", {"--seconds", "6", "--rings", "camera,pose,landmarks"}).exit_code, 0);
  std::int64_t shift_ns = 0;
  EXPECT_GT(compare<msg::CameraFrame>("camera.frames", shift_ns), 20);
  EXPECT_GT(compare<msg::HandPoses>("pose.hands", shift_ns), 40);
  EXPECT_GT(compare<msg::Landmarks>("landmarks.hands", shift_ns), 10);
}

TEST_F(Recording, IsPlayedWhereItsPicturesAndHandModelsAreNot) {
  ASSERT_EQ(handcast({"template", in_scratch("paint")}).exit_code, 0);
  fs::copy_file(renderer::default_hand_file(renderer::Side::left), in_scratch("mine.glb"));
  {
    const auto rig = up({"--set", "content.left=" + in_scratch("paint/left.png"), "--set",
                         "hand.left=" + in_scratch("mine.glb")});
    wait_until_light();
    const auto outcome = record("first", {"--seconds", "2"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
    EXPECT_EQ(handcast({"down"}).exit_code, 0);
  }
  fs::remove_all(in_scratch("paint"));
  fs::remove(in_scratch("mine.glb"));
  fs::rename(in_scratch("first"), in_scratch("elsewhere"));
  const Command rig(scratch_.path(), {"play", in_scratch("elsewhere")});
  EXPECT_TRUE(eventually([&] {
    const auto now = status();
    return !now.is_null() && now["rings"].contains("projection.frames") &&
           now["rings"]["projection.frames"]["count"] > 0;
  })) << rig.log();
}

TEST_F(Recording, TheRigKnowsNothingOfARecording) {
  const auto rig = up();
  wait_until_light();
  const Command recorder(scratch_.path(), {"record", in_scratch("a"), "--seconds", "4"});
  const auto top = handcast({"top", "--json"});
  EXPECT_THAT(top.output, HasSubstr("projection.frames"));
  EXPECT_THAT(top.output, testing::Not(HasSubstr("record"))) << "no place in a ring is taken";
}

TEST_F(Recording, EndsWhenTheRigIsGivenAnotherCalibration) {
  const auto calibration = scratch_.path() / "calibration.toml";
  const auto give = [&](double k1) {
    auto rig = calib::reference_rig();
    rig.camera.k1 = k1;
    std::ofstream(calibration) << calib::print_calibration(rig);
  };
  give(-0.28);
  const auto rig = up({"--set", "calibration=" + calibration.string()});
  wait_until_light();
  Command recorder(scratch_.path(), {"record", in_scratch("a"), "--seconds", "60"});
  ASSERT_TRUE(eventually([&] {
    return fs::exists(in_scratch("a/camera.frames.index")) &&
           fs::file_size(in_scratch("a/camera.frames.index")) > 0;
  }));
  give(-0.27);
  EXPECT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_EQ(recorder.wait(), 0) << recorder.log();
  EXPECT_THAT(recorder.output(), HasSubstr("the rig was given another calibration"));
  const auto kept = calib::load_calibration(in_scratch("a/calibration.toml"));
  ASSERT_TRUE(kept) << kept.error().what;
  for (const auto& [number, frame] : read<msg::CameraFrame>("a", "camera.frames"))
    EXPECT_EQ(frame.message.calibration, kept->id) << number;
}

TEST_F(Recording, CtrlCAndTheEndOfTheRigAreCleanEnds) {
  const auto rig = up();
  wait_until_light();
  Command stopped(scratch_.path(), {"record", in_scratch("a")});
  ASSERT_TRUE(eventually([&] {
    return fs::exists(in_scratch("a/pose.hands.index")) &&
           fs::file_size(in_scratch("a/pose.hands.index")) > 0;
  }));
  stopped.signal(SIGINT);
  EXPECT_EQ(stopped.wait(), 0) << stopped.log();
  EXPECT_TRUE(fs::exists(in_scratch("a/summary.json")));

  Command orphan(scratch_.path(), {"record", in_scratch("b")});
  ASSERT_TRUE(eventually([&] { return fs::exists(in_scratch("b/marks.pose.index")); }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(orphan.wait(), 0) << orphan.log();
  EXPECT_THAT(orphan.output(), HasSubstr("is no longer up"));
}

TEST_F(Recording, AfterSigkillItIsReadUpToTheLastWholeMessage) {
  const auto rig = up();
  wait_until_light();
  Command killed(scratch_.path(), {"record", in_scratch("a")});
  ASSERT_TRUE(eventually([&] {
    return fs::exists(in_scratch("a/camera.frames.index")) &&
           fs::file_size(in_scratch("a/camera.frames.index")) > 640;
  }));
  killed.signal(SIGKILL);
  killed.wait();
  EXPECT_GE(read<msg::CameraFrame>("a", "camera.frames").size(), 10u);
  EXPECT_GE(read<msg::HandPoses>("a", "pose.hands").size(), 1u);
}

/// Without the right to mount a file system there is nothing to fill.
TEST_F(Recording, AFullDiskEndsItWithASentenceAndARecordingThatCanBePlayed) {
  const auto mount = in_scratch("small");
  fs::create_directories(mount);
  if (std::system(("mount -t tmpfs -o size=8m none " + mount + " 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "a file system cannot be mounted here";
  const auto rig = up();
  wait_until_light();
  const auto outcome = record("small/full", {"--seconds", "60"});
  EXPECT_EQ(outcome.exit_code, 111);
  EXPECT_THAT(outcome.log, HasSubstr("the disk is full"));
  EXPECT_GT(read<msg::CameraFrame>("small/full", "camera.frames").size(), 5u);
  EXPECT_EQ(std::system(("umount " + mount).c_str()), 0);
}

TEST_F(Recording, WhatCannotBeDoneIsASentence) {
  EXPECT_THAT(record("a", {}).log, HasSubstr("no rig is up"));
  const auto rig = up();
  wait_until_light();
  const auto ring = record("a", {"--rings", "sound"});
  EXPECT_EQ(ring.exit_code, 100);
  EXPECT_THAT(ring.log, HasSubstr("no ring 'sound'; it has: "));
  EXPECT_FALSE(fs::exists(in_scratch("a")));
  fs::create_directories(in_scratch("mine"));
  std::ofstream(in_scratch("mine/file")) << "mine";
  const auto taken = record("mine", {});
  EXPECT_EQ(taken.exit_code, 100);
  EXPECT_THAT(taken.log, HasSubstr("not empty"));
  EXPECT_EQ(record("a", {"--seconds", "x"}).exit_code, 2);
  const auto played = handcast({"play", in_scratch("mine")});
  EXPECT_EQ(played.exit_code, 100);
  EXPECT_THAT(played.log, HasSubstr("mine/rig.toml is missing"));
  for (const std::string sensor : {"camera.backend = \"v4l2\"", "camera2.backend = \"v4l2\"",
                                   "pose.backend = \"leapc\"", "pose.second = \"leapc\""}) {
    std::ofstream(in_scratch("mine/rig.toml")) << "name = \"mine\"\n" << sensor << "\n";
    const auto live = handcast({"play", in_scratch("mine")});
    EXPECT_EQ(live.exit_code, 100);
    EXPECT_THAT(live.log, HasSubstr("(" + sensor + ") would run"));
  }
}

}  // namespace
}  // namespace handcast::system_test
