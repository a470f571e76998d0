// SPDX-License-Identifier: Apache-2.0
// Commands that cannot work end at once with a sentence.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class Refusals : public SystemTest {
 protected:
  std::string rig_file(const std::string& text) const {
    const auto file = scratch_.path() / "rig.toml";
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(Refusals, ABrokenRigFileIsNamedWithItsLine) {
  const auto outcome = handcast({"up", rig_file("name = \"desk\"\n[camera]\nrate_hz = 0\n")});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("rig.toml:3"), HasSubstr("camera.rate_hz")));
  EXPECT_EQ(handcast({"config", "--check", (scratch_.path() / "rig.toml").string()}).exit_code,
            100);
}

TEST_F(Refusals, AMissingRigFileIsNamed) {
  const auto outcome = handcast({"up", "/nowhere/rig.toml"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, HasSubstr("/nowhere/rig.toml"));
}

TEST_F(Refusals, AMissingRecordingIsNamedAndNothingKeepsRunning) {
  const auto rig =
      up({"--set", "pose.backend=replay", "--set", "pose.replay.directory=/nowhere/recording"});
  EXPECT_EQ(rig->wait(), 100);
  EXPECT_THAT(rig->log(), HasSubstr("handcast: pose cannot start: "));
  EXPECT_THAT(rig->log(), HasSubstr("/nowhere/recording"));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Refusals, AMissingNetworkThatComesWithHandcastIsNamed) {
  const auto all = program_folder().parent_path() / "share" / "handcast",
             most = scratch_.path() / "assets";
  std::filesystem::create_directory(most);
  for (const auto& entry : std::filesystem::directory_iterator(all))
    if (entry.path().filename() != "landmarks")
      std::filesystem::create_symlink(entry.path(), most / entry.path().filename());
  const Variable assets("HANDCAST_ASSETS", most);
  const auto rig = up({"--set", "landmarks.backend=handcast"});
  EXPECT_EQ(rig->wait(), 100);
  EXPECT_THAT(rig->log(), AllOf(HasSubstr("handcast: landmarks cannot start: "),
                                HasSubstr("assets/landmarks/handcast.onnx"),
                                HasSubstr("which comes with handcast, is missing")));
}

TEST_F(Refusals, AnUnknownBackEndIsNamedBesideTheKnownOnes) {
  const auto rig = up({"--set", "camera.backend=polaroid"});
  EXPECT_EQ(rig->wait(), 100);
  EXPECT_THAT(rig->log(), AllOf(HasSubstr("handcast: camera cannot start: "),
                                HasSubstr("'polaroid'"), HasSubstr("twin, replay")));
}

TEST_F(Refusals, ASecondRigOfTheSameNameIsRefusedAndTheFirstGoesOn) {
  const auto first = up();
  wait_until_light();
  const auto second = up();
  EXPECT_EQ(second->wait(), 111);
  EXPECT_THAT(second->log(), HasSubstr("a rig named 'twin' is up already"));
  EXPECT_TRUE(first->running());
  expect_more_light();
}

TEST_F(Refusals, AnUnknownVerbIsAnsweredWithTheKnownOnes) {
  const auto outcome = handcast({"levitate"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("'levitate'"), HasSubstr("up, play, down, status")));
  EXPECT_THAT(handcast({"statsu"}).log, HasSubstr("'statsu' (did you mean 'status'?)"));
  EXPECT_EQ(handcast({"up"}).exit_code, 2);
  EXPECT_EQ(handcast({"up", "rig.toml", "--seconds", "soon"}).exit_code, 2);
}

TEST_F(Refusals, ConfigNamesEveryMissingFileAndUnknownBackEndThatTheRigUses) {
  const auto file = rig_file(
      "calibration = \"none.toml\"\n[camera]\nbackend = \"webcam\"\n"
      "[pose]\nbackend = \"replay\"\n[pose.replay]\ndirectory = \"tape\"\n"
      "[landmarks.replay]\ndirectory = \"unused\"\n");
  const auto outcome = handcast({"config", "--check", file});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("camera.backend: camera has no back end 'webcam'"),
                                 HasSubstr("none.toml: cannot be read: No such file"),
                                 HasSubstr("tape' is not a folder"), Not(HasSubstr("unused"))));
}

TEST_F(Refusals, ConfigOpensWhatTheServicesOpen) {
  const auto refusal = [&](const std::string& toml) {
    const auto outcome = handcast({"config", "--check", rig_file(toml)});
    EXPECT_EQ(outcome.exit_code, 100) << toml;
    return outcome.log;
  };
  std::ofstream(scratch_.path() / "odd.png") << "no picture";
  std::ofstream(scratch_.path() / "odd.glb") << "no mesh";
  std::ofstream(scratch_.path() / "odd.toml") << "[camera]\nwidth_px = 3\n";
  EXPECT_THAT(refusal("[content]\nleft = \"odd.png\""), HasSubstr("odd.png' is not a PNG"));
  EXPECT_THAT(refusal("[hand]\nright = \"odd.glb\""), HasSubstr("not a valid glTF file"));
  EXPECT_THAT(refusal("calibration = \"odd.toml\""), HasSubstr("odd.toml:2: camera.width_px"));
  EXPECT_THAT(refusal("[twin]\nmotion = \"builtin:jump\""), HasSubstr("built-in motion 'jump'"));
  EXPECT_THAT(refusal("[content]\nleft = \"builtin:x\""), HasSubstr("built-in content 'x'"));
  EXPECT_THAT(refusal("[pose.process]\ncores = [1023]"),
              HasSubstr("pose.process.cores: there is no core 1023"));
  EXPECT_THAT(refusal("[landmarks]\nbackend = \"handcast\"\nmodels = \"nowhere\""),
              HasSubstr("nowhere: there is no such folder of models"));
  std::ofstream(scratch_.path() / "cues.toml") << "[[cue]]\nset.light.mastre = 1\n";
  std::ofstream(scratch_.path() / "turn.toml") << "[[gesture]]\n";
  EXPECT_THAT(refusal("[desk]\ncues = \"cues.toml\"\ngestures = \"turn.toml\""),
              AllOf(HasSubstr("cues.toml:2"), HasSubstr("turn.toml:1")));
  EXPECT_THAT(refusal("name = \"a b\""), HasSubstr("'a b' is not a valid name"));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Refusals, ConfigLooksAtTheFilesOfTrackersAndCamerasWithoutOpeningThem) {
  const auto refusal = [&](const std::string& toml) {
    const auto outcome = handcast({"config", "--check", rig_file(toml)});
    EXPECT_EQ(outcome.exit_code, 100) << toml;
    return outcome.log;
  };
  std::ofstream(scratch_.path() / "odd.json") << "{}";
  std::ofstream(scratch_.path() / "gone.json")
      << R"({"runtime": {"name": "It", "library_path": "./libgone.so"}})";
  std::ofstream(scratch_.path() / "odd.txt") << "dance\n";
  const auto all = handcast({"config", "--reference"}).output;
  const auto has = [&](const std::string& backend) {
    return all.find("\n| `" + backend + "` |") != std::string::npos;
  };
  if (has("openxr")) {
    const std::string rig = "[pose]\nbackend = \"openxr\"\n[pose.openxr]\nruntime = ";
    EXPECT_THAT(refusal(rig + "\"nowhere.json\""), HasSubstr("nowhere.json'"));
    EXPECT_THAT(refusal(rig + "\"odd.json\""), HasSubstr("odd.json' is no manifest"));
    EXPECT_THAT(refusal(rig + "\"gone.json\""), HasSubstr("libgone.so"));
    const Variable active("XR_RUNTIME_JSON", "/nowhere/active.json");
    EXPECT_THAT(refusal("[pose]\nbackend = \"openxr\""), HasSubstr("/nowhere/active.json"));
    EXPECT_THAT(refusal("[pose]\nsecond = \"openxr\""), HasSubstr("/nowhere/active.json"));
  }
  EXPECT_THAT(refusal("[pose]\nbackend = \"leapc\"\n[pose.leapc]\nlibrary = \"none.so\""),
              HasSubstr("none.so: there is no such file"));
  if (has("leap")) {
    EXPECT_THAT(refusal("[camera]\nbackend = \"leap\"\n[camera.leap]\nbring_up = \"none.txt\""),
                HasSubstr("camera 'leap': leap.bring_up: "));
    EXPECT_THAT(refusal("[camera]\nbackend = \"leap\"\n[camera.leap]\nbring_up = \"odd.txt\""),
                HasSubstr("'dance' is no step"));
    EXPECT_THAT(refusal("[camera]\nbackend = \"leap\"\n[camera2]\nbackend = \"twin\""),
                HasSubstr("set camera2.backend = \"none\""));
  }
}

TEST_F(Refusals, ALibraryThatEndsTheCheckDoesNotPassIt) {
  const auto reference = handcast({"config", "--reference"}).output;
  if (reference.find("\n| `openxr` |") == std::string::npos) GTEST_SKIP() << "without OpenXR";
  std::ofstream(scratch_.path() / "quits.json")
      << R"({"runtime": {"name": "It", "library_path": ")" << QUITTING_LIBRARY << R"("}})";
  const auto outcome =
      handcast({"config", "--check",
                rig_file("[pose]\nbackend = \"openxr\"\n[pose.openxr]\nruntime = \"quits.json\"")});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, HasSubstr("pose: its check ended before it was done"));
}

TEST_F(Refusals, ConfigNamesWhatATrackerOfTwoCamerasLacks) {
  const auto stereo = std::filesystem::absolute("config/calibrations/stereo.toml").string();
  const auto log_of = [&](const std::string& toml) {
    return handcast({"config", "--check", rig_file(toml)}).log;
  };
  const std::string pose = "[pose]\nbackend = \"stereo\"\n",
                    two = "[camera2]\nbackend = \"twin\"\n";
  EXPECT_THAT(log_of("calibration = \"" + stereo + "\"\n" + pose),
              HasSubstr("set camera2.backend"));
  const auto one = log_of(pose + two);
  EXPECT_THAT(one, HasSubstr("no second camera ([camera2], [camera2_from_camera])"));
  EXPECT_EQ(one.find("no second camera"), one.rfind("no second camera")) << "once: " << one;
  EXPECT_EQ(log_of("calibration = \"" + stereo + "\"\n" + pose + two), "");
  const auto unloaded = log_of("calibration = \"none.toml\"\n" + pose + two);
  EXPECT_THAT(unloaded, AllOf(HasSubstr("none.toml: cannot be read"),
                              HasSubstr("begins at the folder of the rig file"),
                              Not(HasSubstr("no second camera"))));
}

TEST_F(Refusals, AFaultOfTheSecondCameraNamesItsOwnSettings) {
  const auto outcome = handcast(
      {"config", "--check",
       rig_file("calibration = \"" +
                std::filesystem::absolute("config/calibrations/stereo.toml").string() +
                "\"\n[camera2]\nbackend = \"replay\"\n" + "[landmarks2]\nfallback = \"none\"\n")});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log,
              AllOf(HasSubstr("camera2 'replay': no recording is given; set "
                              "replay.directory"),
                    HasSubstr("landmarks2.fallback"), Not(HasSubstr("landmarks.fallback"))));
}

TEST_F(Refusals, ConfigNamesEachFaultOnce) {
  const auto outcome = handcast({"config", "--check", rig_file("calibration = \"none.toml\"")});
  const auto first = outcome.log.find("none.toml: cannot be read");
  ASSERT_NE(first, std::string::npos) << outcome.log;
  EXPECT_EQ(outcome.log.find("none.toml: cannot be read", first + 1), std::string::npos)
      << outcome.log;
}

TEST_F(Refusals, AnEmptyArgumentIsOneThatAScriptForgot) {
  const auto outcome = handcast({"up", ""});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.log, HasSubstr("argument 2 is empty"));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Refusals, WhatConfigPrintsConfigAccepts) {
  const auto printed =
      handcast({"config", "--print", "config/rigs/twin.toml", "--set", "camera.rate_hz=77"});
  ASSERT_EQ(printed.exit_code, 0) << printed.log;
  EXPECT_THAT(printed.output, HasSubstr("rate_hz = 77"));
  EXPECT_EQ(handcast({"config", "--check", rig_file(printed.output)}).exit_code, 0);
  EXPECT_THAT(handcast({"--version"}).output, StartsWith("handcast "));
}

}  // namespace
}  // namespace handcast::system_test
