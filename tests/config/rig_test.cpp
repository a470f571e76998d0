// SPDX-License-Identifier: Apache-2.0
#include "config/rig.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <map>

#include "tests/config/every_setting.hpp"
#include "tests/scratch.hpp"

namespace handcast::config {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr auto kFile = "/rigs/test.toml";

std::vector<std::string> faults_of(const std::string& toml,
                                   const std::vector<std::string>& settings = {}) {
  const auto rig = parse_rig(toml, kFile, settings);
  if (rig) return {};
  EXPECT_EQ(rig.error().code, Errc::bad_config);
  std::vector<std::string> lines;
  std::istringstream text(rig.error().what);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

Rig rig_of(const std::string& toml, const std::vector<std::string>& settings = {}) {
  const auto rig = parse_rig(toml, kFile, settings);
  EXPECT_TRUE(rig) << rig.error().what;
  return rig ? *rig : Rig{};
}

TEST(Rig, AnEmptyFileIsTheDefaults) { EXPECT_THAT(differences(rig_of(""), Rig{}), IsEmpty()); }

TEST(Rig, AFileChangesWhatItSaysAndNothingElse) {
  const auto rig = rig_of(
      "name = 'mine'\n[camera]\nrate_hz = 240\nreplay.loop = false\n[cascade.fill]\nreach_px = "
      "7\n");
  EXPECT_EQ(rig.camera.rate_hz, 240);
  EXPECT_THAT(differences(rig, Rig{}),
              ElementsAre("name", "camera.rate_hz", "camera.replay.loop", "cascade.fill.reach_px"));
}

TEST(Rig, AFileSaysAllItsFaultsAtOnceInTheOrderOfItsLines) {
  EXPECT_THAT(
      faults_of("[projector]\n"
                "rate_hz = 0\n"
                "[camera]\n"
                "rate_hz = \"fast\"\n"
                "expsure_ms = 1\n"
                "[cascade.fill]\n"
                "method = \"reflct\"\n"
                "reach_px = 3.5\n"
                "[observer]\n"
                "enabled = 1\n"),
      ElementsAre(
          "/rigs/test.toml:2: projector.rate_hz: 0 is outside 1..10000 Hz",
          "/rigs/test.toml:4: camera.rate_hz: must be a number, 1..2000 Hz, not text",
          "/rigs/test.toml:5: camera.expsure_ms: there is no such setting (did you mean "
          "'exposure_ms'?)",
          "/rigs/test.toml:7: cascade.fill.method: 'reflct' is not one of: none, reflect (did you "
          "mean 'reflect'?)",
          "/rigs/test.toml:8: cascade.fill.reach_px: must be a whole number, 1..32 px, not a "
          "number",
          "/rigs/test.toml:10: observer.enabled: must be true or false, not a whole number"));
}

TEST(Rig, AFileOfAnotherKindIsNotPrintedBackWhole) {
  std::string lines;
  for (int i = 0; i < 5000; ++i) lines += "k" + std::to_string(i) + " = 1\n";
  const auto faults = faults_of(lines);
  ASSERT_EQ(faults.size(), 101u);
  EXPECT_THAT(faults[99], HasSubstr("test.toml:100: k99: there is no such setting"));
  EXPECT_EQ(faults.back(), "and 4900 more errors");
}

TEST(Rig, AFileOfAnotherKindIsNamed) {
  EXPECT_THAT(faults_of("rig = \"../rigs/twin.toml\"\nseconds = 5\n"),
              ElementsAre(HasSubstr("/rigs/test.toml is a plan, not a rig file")));
  EXPECT_THAT(faults_of("[[variant]]\nname = \"a\"\n"), ElementsAre(HasSubstr("is a plan")));
  EXPECT_THAT(faults_of("[camera]\nwidth_px = 720\n"), ElementsAre(HasSubstr("is a calibration")));
}

TEST(Rig, AnUnknownSectionIsOneFaultWithASuggestion) {
  EXPECT_THAT(
      faults_of("[camrea]\nrate_hz = 1\nexposure_ms = 2\n"),
      ElementsAre("/rigs/test.toml:1: camrea: there is no such setting (did you mean 'camera'?)"));
}

TEST(Rig, AnUnknownNameInASectionInsideASectionIsAFaultHoweverItIsWritten) {
  const std::string fault =
      "cascade.fill.reech_px: there is no such setting (did you mean 'reach_px'?)";
  for (const std::string toml :
       {"[cascade.fill]\nreech_px = 4\n", "[cascade]\nfill.reech_px = 4\n",
        "cascade.fill.reech_px = 4\n", "[cascade]\nfill = { reech_px = 4 }\n",
        "cascade = { fill = { reech_px = 4 } }\n"})
    EXPECT_THAT(faults_of(toml), ElementsAre(HasSubstr(fault))) << toml;
  EXPECT_THAT(faults_of("[cascade.fil]\nreach_px = 4\n"),
              ElementsAre("/rigs/test.toml:1: cascade.fil: there is no such setting (did you mean "
                          "'fill'?)"));
  EXPECT_THAT(faults_of("", {"cascade.fill.reech_px=4"}),
              ElementsAre("--set cascade.fill.reech_px=4: there is no such setting (did you mean "
                          "'cascade.fill.reach_px'?)"));
}

TEST(Rig, ASettingInTheWrongSectionIsToldWhereItBelongs) {
  EXPECT_THAT(faults_of("[camera]\nreach_px = 4\n"),
              ElementsAre(HasSubstr("did you mean 'cascade.fill.reach_px'?")));
}

TEST(Rig, ANameLikeNoOtherGetsNoSuggestion) {
  EXPECT_THAT(faults_of("[camera]\nxylophone = 4\n"), ElementsAre(Not(HasSubstr("did you mean"))));
}

TEST(Rig, ASectionCannotBeAValueNorAValueASection) {
  EXPECT_THAT(
      faults_of("camera = 5\n[name]\n"),
      ElementsAre("/rigs/test.toml:1: camera: is a section, [camera], and cannot be a whole number",
                  "/rigs/test.toml:2: name: must be text in quotes, not a section"));
}

TEST(Rig, WhatIsNotAFiniteNumberIsRefused) {
  EXPECT_THAT(faults_of("[camera]\nrate_hz = nan\n[projector]\nrate_hz = inf\n[twin]\nseed = "
                        "9223372036854775807\n"),
              ElementsAre(HasSubstr("camera.rate_hz"), HasSubstr("projector.rate_hz"),
                          HasSubstr("twin.seed")));
}

TEST(Rig, AFileThatIsNotTomlSaysLineAndColumn) {
  EXPECT_THAT(faults_of("[camera]\nrate_hz = = 5\n"),
              ElementsAre("/rigs/test.toml:2:11: between a name and its value there is one =",
                          "    rate_hz = = 5", "              ^"));
  EXPECT_THAT(faults_of("[camera]\nrate_hz = 5\nrate_hz = 6\n"),
              ElementsAre(HasSubstr("/rigs/test.toml:3:1: rate_hz is set already, at line 2"),
                          "    rate_hz = 6", "    ^"));
}

TEST(Rig, ANumberWithAUnitOrInQuotesIsToldHowToWriteIt) {
  EXPECT_THAT(faults_of("camera.rate_hz = '60'\ncamera.exposure_ms = \"1,5\"\n"
                        "projector.brightness = '50%'\n"),
              ElementsAre(HasSubstr("not text; write 60, without quotes"),
                          HasSubstr("not text; write 1.5, with a decimal point"),
                          HasSubstr("not text; write 0.5: a share is a number")));
  EXPECT_THAT(faults_of("", {"camera.rate_hz=60,5"}),
              ElementsAre("--set camera.rate_hz=60,5: must be a number, 1..2000 Hz; write 60.5, "
                          "with a decimal point"));
  EXPECT_THAT(faults_of("", {"camera.rate_hz=60 Hz"}),
              ElementsAre(HasSubstr("write the number alone, without 'Hz'")));
}

TEST(Rig, NoFaultPrintsTheFile) {
  const std::string much(838'000, 'A');
  for (const auto& toml : {"name = '" + much + "'", "cascade.fill.method = '" + much + "'",
                           much + " = 1", "camera." + much + " = 1", "hand.left = '~" + much + "'",
                           "camera.rate_hz = '" + much + "'"})
    EXPECT_LT(faults_of(toml).at(0).size(), 600u) << toml.substr(0, 30);
  EXPECT_LT(faults_of("", {much}).at(0).size(), 600u);
  EXPECT_LT(faults_of("", {much + "=1"}).at(0).size(), 600u);
  EXPECT_THAT(faults_of("\"a\\u001b[2J\" = 1\ncascade.fill.method = \"a\\nb\"\n"),
              ElementsAre(HasSubstr("a\\x1b[2J: there is no such setting"),
                          HasSubstr("'a\\nb' is not one of")));
}

TEST(Rig, BonesMustBeCalledShortBeforeTheyAreCalledLong) {
  EXPECT_THAT(faults_of("[cascade.correct]\nbone_short_px = 30\n"),
              ElementsAre(HasSubstr("must be less than cascade.correct.bone_long_px")));
}

TEST(Rig, NoLedGetsMoreThanTheLimit) {
  EXPECT_THAT(faults_of("[dlp]\nlimit = 0.2\nred = 0.2\ngreen = 0.1\nblue = 0.21\n"),
              ElementsAre(HasSubstr("dlp.blue: 0.21 is above dlp.limit, 0.2")));
}

TEST(Rig, AMissingFileIsNamed) {
  const auto rig = load_rig("/no/such/rig.toml");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, Errc::bad_config);
  EXPECT_THAT(rig.error().what, HasSubstr("/no/such/rig.toml"));
}

TEST(Assignment, IsTypedByItsSetting) {
  const auto rig = rig_of("", {"camera.rate_hz=240", "twin.seed=7", "observer.enabled=false",
                               "cascade.filter.method=paper", "name=5"});
  EXPECT_EQ(rig.camera.rate_hz, 240);
  EXPECT_EQ(rig.twin.seed, 7);
  EXPECT_FALSE(rig.observer.enabled);
  EXPECT_EQ(rig.cascade.filter.method, FilterMethod::paper);
  EXPECT_EQ(rig.name, "5");
}

TEST(Assignment, WinsOverTheFileAndTheLastOneWins) {
  EXPECT_EQ(rig_of("[camera]\nrate_hz = 100\n", {"camera.rate_hz=200", "camera.rate_hz=300"})
                .camera.rate_hz,
            300);
}

TEST(Assignment, FaultsAreToldWithThoseOfTheFile) {
  EXPECT_THAT(
      faults_of("nme = 'x'\n", {"camera.rate_hz=0", "camera.rate_hz=fast", "camera.rat_hz=5",
                                "camera=5", "seed=3", "observer.enabled"}),
      ElementsAre(
          "/rigs/test.toml:1: nme: there is no such setting (did you mean 'name'?)",
          "--set camera.rate_hz=0: 0 is outside 1..2000 Hz",
          "--set camera.rate_hz=fast: must be a number, 1..2000 Hz",
          "--set camera.rat_hz=5: there is no such setting (did you mean 'camera.rate_hz'?)",
          "--set camera=5: is a section; set one of its settings",
          "--set seed=3: there is no such setting (did you mean 'twin.seed'?)",
          "--set observer.enabled: must look like path=value"));
}

TEST(Rig, ANameThatNoRigCanHaveIsRefused) {
  for (const auto& name : std::vector<std::string>{"", "a b", "a/b", "a\\tb", std::string(49, 'x')})
    EXPECT_THAT(faults_of("name = \"" + name + "\""),
                ElementsAre(HasSubstr("is not a valid name of a rig")))
        << name;
  EXPECT_THAT(faults_of("name = \"Desk_2-b\""), IsEmpty());
}

TEST(Rig, AnAssignmentIsOneLine) {
  EXPECT_THAT(
      faults_of("", {"camera.rate_hz=5\ncamera.exposure_ms=1"}),
      ElementsAre(
          "--set camera.rate_hz=5\\x0acamera.exposure_ms=1: must not contain a line break"));
  EXPECT_THAT(faults_of("", {"content.left=a\rb"}),
              ElementsAre(HasSubstr("must not contain a line break")));
}

TEST(Rig, CoresAreWholeNumbers) {
  EXPECT_THAT(faults_of("[pose.process]\ncores = [0, 1.5]"),
              ElementsAre("/rigs/test.toml: pose.process.cores: 1.5 is not the number of a core"));
}

TEST(Paths, OfAFileStartAtItsFolder) {
  const auto rig = rig_of(
      "calibration = 'c.toml'\n[twin]\nmotion = '../lmc'\n[camera.replay]\ndirectory = "
      "'/abs'\n[content]\nleft = 'a.png'\n");
  EXPECT_EQ(rig.calibration, "/rigs/c.toml");
  EXPECT_EQ(rig.twin.motion, "/lmc");
  EXPECT_EQ(rig.camera.replay.directory, "/abs");
  EXPECT_EQ(rig.content.left, "/rigs/a.png");
}

TEST(Paths, OfAnAssignmentStartAtTheCurrentFolder) {
  EXPECT_EQ(rig_of("", {"hand.left=hand.glb"}).hand.left,
            (std::filesystem::current_path() / "hand.glb").string());
}

// A rig that is reloaded, and a service that is started again, may stand in a folder that is gone.
TEST(Paths, OfAFileAreFoundFromAFolderThatWasDeleted) {
  struct ComeBack {
    std::filesystem::path from = std::filesystem::current_path();
    ~ComeBack() { std::filesystem::current_path(from); }
  } come_back;
  {
    const test::Scratch gone;
    std::filesystem::current_path(gone.path());
  }
  const auto rig = parse_rig("calibration = 'c.toml'\n", kFile, {"hand.left=hand.glb"});
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->calibration, "/rigs/c.toml");
}

TEST(Paths, AProgramOfSomebodyStartsInTheFolderOfTheFileThatNamesIt) {
  const std::string command = "pose.external.command = ['python3', 'my_tracker.py']\n";
  EXPECT_EQ(parse_rig(command, kFile)->pose.external.folder, "/rigs");
  EXPECT_EQ(parse_rig(command + "pose.external.folder = 'mine'\n", kFile)->pose.external.folder,
            "/rigs/mine");
  EXPECT_EQ(parse_rig("", kFile, {"pose.external.command=['./mine']"})->pose.external.folder,
            std::filesystem::current_path());
  EXPECT_EQ(parse_rig("", kFile)->pose.external.folder, "");
}

TEST(Paths, ATildeIsTheHomeFolderInEverySettingThatNamesAFile) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  if (home.empty()) GTEST_SKIP() << "HOME is not set";
  Rig names;
  int checked = 0;
  for (const auto& section : list_settings(names))
    for (const auto& setting : section.settings) {
      if (!names_a_file(setting.path)) continue;
      ++checked;
      for (const bool in_file : {true, false}) {
        auto rig =
            in_file ? rig_of(setting.path + " = '~/a.b'") : rig_of("", {setting.path + "=~/a.b"});
        EXPECT_EQ(*std::get<std::string*>(find_setting(list_settings(rig), setting.path)->target),
                  home + "/a.b")
            << setting.path;
      }
    }
  EXPECT_GT(checked, 15);
  EXPECT_THAT(faults_of("hand.left = '~no-such-user/a.glb'"),
              ElementsAre(AllOf(HasSubstr("test.toml: hand.left: "),
                                HasSubstr("there is no user 'no-such-user'"))));
}

TEST(Paths, ThoseOfAnotherProgramAreNamed) {
  EXPECT_THAT(faults_of("content.left = '$HOME/a.png'\n"),
              ElementsAre(HasSubstr("variables are not replaced")));
  EXPECT_THAT(faults_of("content.left = 'file:///a.png'\n"),
              ElementsAre(HasSubstr("write the path alone")));
  EXPECT_THAT(faults_of("content.left = 'C:\\a.png'\n"),
              ElementsAre(HasSubstr("a path of Windows")));
  EXPECT_THAT(faults_of("content.left = \"C:\\new\\table.png\"\n"),
              ElementsAre(HasSubstr("are escapes; write single ones")));
  EXPECT_THAT(faults_of("", {"content.left=$HOME/a.png"}),
              ElementsAre(HasSubstr("--set: content.left: ")));
}

TEST(Paths, BuiltinAndEmptyStayAsTheyAre) {
  const auto rig = rig_of("[twin]\nmotion = 'builtin:still'\n");
  EXPECT_EQ(rig.twin.motion, "builtin:still");
  EXPECT_EQ(rig.content.left, "builtin:atlas");
  EXPECT_EQ(rig.hand.left, "");
}

TEST(Print, EverySettingReadsBackAsItWas) {
  Rig changed;
  for (const auto& setting : every_setting(changed)) change(setting);
  changed.cascade.correct.bone_short_px = 1.0 / 3;
  const auto back = parse_rig(print_rig(changed), kFile);
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_THAT(differences(*back, changed), IsEmpty());

  Rig defaults;
  EXPECT_EQ(differences(*back, defaults).size(), every_setting(defaults).size())
      << "a setting was not changed by this test";
}

TEST(Print, SaysOfEverySettingWhatItIsAndMayBe) {
  const auto text = print_rig(Rig{});
  EXPECT_THAT(text, HasSubstr("[camera]\n# The source of frames"));
  EXPECT_THAT(
      text,
      HasSubstr("# Frames per second requested from the camera. (1..2000 Hz)\nrate_hz = 525\n"));
  EXPECT_THAT(text,
              HasSubstr("(one of: hold, velocity, acceleration)\nmethod = \"acceleration\"\n"));
}

TEST(Rig, EveryServiceRunsAsItsOwnSectionSays) {
  auto rig = parse_rig("", "rig.toml").value();
  const std::map<std::string, Process*> sections{{"camera", &rig.camera.process},
                                                 {"pose", &rig.pose.process},
                                                 {"landmarks", &rig.landmarks.process},
                                                 {"projector", &rig.projector.process},
                                                 {"observer", &rig.observer.process}};
  int priority = 10;
  for (const auto& [name, process] : sections) process->priority = ++priority;
  priority = 10;
  for (const auto& [name, process] : sections)
    EXPECT_EQ(process_of(rig, name).priority, ++priority) << name;
  EXPECT_EQ(process_of(rig, "moon").priority, 0);
}

TEST(Viewpoint, TheSecondOneHasNamesOfItsOwnForWhatIsItsOwn) {
  const auto second = [](std::string_view name) { return name_at(Viewpoint::second, name); };
  EXPECT_EQ(second("camera"), "camera2");
  EXPECT_EQ(second("camera.v4l2.device"), "camera2.v4l2.device");
  EXPECT_EQ(second("landmarks.hands"), "landmarks2.hands");
  EXPECT_EQ(second("pose.hands"), "pose.hands") << "both views read the same poses";
  EXPECT_EQ(second("cameras.x"), "cameras.x");
  EXPECT_EQ(name_at(Viewpoint::first, "camera.frames"), "camera.frames");
  EXPECT_EQ(name_at_first("landmarks2.models"), "landmarks.models");
  EXPECT_EQ(name_at_first("camera2"), "camera");
  EXPECT_EQ(name_at_projector(Viewpoint::second, "projector.kms.card"), "projector2.kms.card");
  EXPECT_EQ(name_at_projector(Viewpoint::second, "projection.frames"), "projection2.frames");
  EXPECT_EQ(name_at_projector(Viewpoint::second, "camera.frames"), "camera.frames");
  EXPECT_EQ(name_at_first("projector2.rate_hz"), "projector.rate_hz");
  EXPECT_EQ(name_at_first("camera.frames"), "");
  EXPECT_EQ(name_at_first("pose.hands"), "");
}

TEST(Viewpoint, EachHasSectionsOfItsOwn) {
  Rig rig;
  rig.camera2.rate_hz = 100;
  rig.landmarks2.hands = 1;
  EXPECT_EQ(camera_at(rig, Viewpoint::first).rate_hz, rig.camera.rate_hz);
  EXPECT_EQ(camera_at(rig, Viewpoint::second).rate_hz, 100);
  EXPECT_EQ(landmarks_at(rig, Viewpoint::first).hands, 2);
  EXPECT_EQ(landmarks_at(rig, Viewpoint::second).hands, 1);
  rig.projector2.rate_hz = 120;
  EXPECT_EQ(rig_at_projector(rig, Viewpoint::first).projector.rate_hz, rig.projector.rate_hz);
  EXPECT_EQ(rig_at_projector(rig, Viewpoint::second).projector.rate_hz, 120);
}

}  // namespace
}  // namespace handcast::config
