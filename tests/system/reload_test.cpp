// SPDX-License-Identifier: Apache-2.0
// `handcast reload` restarts only the services whose settings changed.
#include <gmock/gmock.h>
#include <signal.h>

#include <fstream>
#include <map>
#include <stdexcept>

#include "config/rig.hpp"
#include "ipc/control/control_client.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;
using testing::UnorderedElementsAre;

class Reload : public SystemTest {
 protected:
  void write_rig(const std::string& more) const {
    std::ofstream(file_) << "name = \"desk\"\n" << more;
  }
  /// A rig file with rates that do not overload the machine.
  void write_rig_with(const std::string& camera, const std::string& more = "") const {
    write_rig("[camera]\n" + camera + "\n[projector]\nrate_hz = 60\n[supervisor]\nready_s = 60\n" +
              more);
  }
  std::unique_ptr<Command> up_with_the_file() {
    auto rig = std::make_unique<Command>(
        scratch_.path(), Arguments{"up", file_.string(), "--out", scratch_.path().string()});
    EXPECT_TRUE(eventually([this] {
      const auto now = status();
      if (now.is_null()) return false;
      for (const auto& [name, service] : now["services"].items())
        if (service["state"] != "ready") return false;
      return now["rings"]["projection.frames"]["count"] > 0;
    })) << rig->log();
    return rig;
  }
  std::map<std::string, pid_t> processes() const {
    std::map<std::string, pid_t> processes;
    const auto now = status();
    for (const auto& [name, service] : now["services"].items())
      processes[name] = service["pid"].get<pid_t>();
    return processes;
  }
  /// The services that have another process than in `before`, or are only in one of the two.
  std::vector<std::string> changed_since(const std::map<std::string, pid_t>& before) const {
    std::vector<std::string> names;
    auto now = processes();
    for (const auto& [name, pid] : before)
      if (!now.contains(name) || now[name] != pid) names.push_back(name);
    for (const auto& [name, pid] : now)
      if (!before.contains(name)) names.push_back(name);
    return names;
  }

  const std::filesystem::path file_ = scratch_.path() / "desk.toml";
};

constexpr auto kCalm = "rate_hz = 60";
constexpr auto kNoObserver = "[observer]\nenabled = false\n",
               kObserver = "[observer]\nrate_hz = 2\n";

TEST_F(Reload, RestartsTheServicesThatReadWhatChangedAndTheLightGoesOn) {
  write_rig_with(kCalm, kObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  write_rig_with("rate_hz = 50", kObserver);
  const auto outcome = handcast({"reload"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(
      outcome.output,
      AllOf(StartsWith("reloaded: camera, landmarks restarted; pose, projector, content, desk, "
                       "observer untouched;"
                       " paused for: camera "),
            HasSubstr(", landmarks ")));
  EXPECT_EQ(service("camera")["restarts"], 0) << "it did not die";
  EXPECT_THAT(changed_since(before), UnorderedElementsAre("camera", "landmarks"));
  EXPECT_EQ(status()["rings"]["camera.frames"]["wanted_hz"], 50);
  EXPECT_EQ(service("camera")["state"], "ready");
  expect_more_light();
}

TEST_F(Reload, AFileThatSaysTheSameChangesNothing) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  write_rig_with(std::string(kCalm) + "  # as before", kNoObserver);
  EXPECT_EQ(handcast({"reload"}).output, "nothing changed\n");
  EXPECT_TRUE(changed_since(before).empty());
}

TEST_F(Reload, WhatWasSetAndSavedRestartsNobody) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  ASSERT_EQ(handcast({"set", "projector.brightness=0.5", "content.shading=0.25"}).exit_code, 0);
  ASSERT_EQ(handcast({"save"}).exit_code, 0);
  EXPECT_EQ(handcast({"reload"}).output, "nothing changed\n");
  EXPECT_TRUE(changed_since(before).empty());
  ASSERT_EQ(handcast({"undo"}).exit_code, 0);
  EXPECT_THAT(handcast({"get", "projector.brightness"}).output,
              HasSubstr("projector.brightness = 1"));
}

TEST_F(Reload, ABrokenFileChangesNothingAndNamesAllItsProblemsWithTheirLines) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  write_rig_with("rate_hz = 0\nexposure = 2", kNoObserver);
  const auto outcome = handcast({"reload"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("desk.toml:3: camera.rate_hz"),
                                 HasSubstr("desk.toml:4: camera.exposure")));
  EXPECT_TRUE(changed_since(before).empty());
  expect_more_light();
}

TEST_F(Reload, WhatCannotChangeWhileARigIsUpIsRefusedWithTheWayToDoIt) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  std::ofstream(file_) << "name = \"wall\"\n[camera]\nrate_hz = 50\n";
  auto outcome = handcast({"reload"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, AllOf(HasSubstr("'desk' to 'wall'"), HasSubstr("handcast down")));

  write_rig_with("rate_hz = 50\nbackend = \"polaroid\"", kNoObserver);
  outcome = handcast({"reload"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, HasSubstr("no back end 'polaroid'"));
  EXPECT_TRUE(changed_since(before).empty());
}

TEST_F(Reload, AServiceThatAppearsIsStartedAndOneThatGoesIsStopped) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  write_rig_with(kCalm, kObserver);
  EXPECT_THAT(handcast({"reload"}).output, HasSubstr("observer started"));
  EXPECT_THAT(changed_since(before), ElementsAre("observer"));
  EXPECT_EQ(service("observer")["state"], "ready");
  const auto observer = service("observer")["pid"].get<pid_t>();

  write_rig_with(kCalm, kNoObserver);
  EXPECT_THAT(handcast({"reload"}).output, HasSubstr("observer stopped"));
  EXPECT_FALSE(is_alive(observer));
  EXPECT_FALSE(status()["services"].contains("observer"));

  write_rig_with(kCalm, kObserver);  // again, because now its rings exist already
  EXPECT_THAT(handcast({"reload"}).output, HasSubstr("observer started"));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
}

TEST_F(Reload, ACalibrationThatWasEditedCountsOnlyAtTheNextReload) {
  const auto calibration = scratch_.path() / "calibration.toml";
  std::filesystem::copy_file("config/calibrations/paper.toml", calibration);
  const auto setting = "calibration = \"" + calibration.string() + "\"\n";
  write_rig(setting +
            "[camera]\nrate_hz = 60\n[projector]\nrate_hz = 60\n[supervisor]\n"
            "ready_s = 60\n" +
            kNoObserver);
  const auto rig = up_with_the_file();
  std::ofstream(calibration) << "[camera]\nwidth_px = 10\n";
  const auto before = service("camera")["pid"].get<pid_t>();
  kill(before, SIGKILL);
  EXPECT_TRUE(eventually([&] {
    return service("camera")["state"] == "ready" && service("camera")["pid"] != before;
  })) << rig->log();
  expect_more_light();
  EXPECT_THAT(rig->log(), testing::Not(HasSubstr("another calibration")));
  const auto outcome = handcast({"reload"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, HasSubstr("calibration.toml: camera.height_px"));
  expect_more_light();
}

TEST_F(Reload, TheSupervisorsOwnSettingsRestartNobody) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  write_rig_with(kCalm, "stop_s = 2\nhistory_s = 5\n" + std::string(kNoObserver));
  EXPECT_EQ(handcast({"reload"}).output,
            "reloaded: camera, pose, landmarks, projector, content, desk untouched\n");
  EXPECT_TRUE(changed_since(before).empty());
}

TEST_F(Reload, ASwappedBackEndStaysUntilTheFileNamesAnother) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  ASSERT_EQ(handcast({"swap", "projector", "file"}).exit_code, 0);
  EXPECT_EQ(
      handcast({"reload"}).output,
      "nothing changed; projector keeps 'file' (`handcast swap projector twin` returns to the "
      "rig file's)\n");
  write_rig_with("rate_hz = 50", kNoObserver);
  const auto before = processes();
  EXPECT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_EQ(service("projector")["backend"], "file");
  EXPECT_THAT(changed_since(before), UnorderedElementsAre("camera", "landmarks"));
}

TEST_F(Reload, ToolsGetTheRigAsItRuns) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const Variable scope("HANDCAST_SCOPE", scratch_.path());
  const auto applied = [] {
    const auto answer = control::ask("desk", {.verb = control::Verb::rig});
    if (!answer) throw std::runtime_error(answer.error().what);
    const auto read = config::parse_rig((*answer)["rig"].get<std::string>(), "applied rig");
    if (!read) throw std::runtime_error(read.error().what);
    return *read;
  };
  EXPECT_EQ(applied().name, "desk");
  EXPECT_EQ(applied().projector.rate_hz, 60);
  write_rig_with("rate_hz = 50", kNoObserver);
  EXPECT_NE(applied().camera.rate_hz, 50) << "the file counts when it is applied";
  ASSERT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_EQ(applied().camera.rate_hz, 50);
  ASSERT_EQ(handcast({"swap", "projector", "file"}).exit_code, 0);
  EXPECT_EQ(applied().projector.backend, "file");
}

TEST_F(Reload, SettingsWithWhichOneServiceCannotWorkChangeNothing) {
  write_rig_with(kCalm, kNoObserver);
  const auto rig = up_with_the_file();
  const auto before = processes();
  const auto missing = "[content]\nleft = \"nowhere.png\"\n" + std::string(kNoObserver);
  write_rig_with("rate_hz = 50", missing);
  const auto failed = handcast({"reload"});
  EXPECT_EQ(failed.exit_code, 100);
  EXPECT_THAT(failed.log, AllOf(HasSubstr("content cannot work with the new settings: "),
                                HasSubstr("nowhere.png"), HasSubstr("nothing was changed")));
  EXPECT_TRUE(changed_since(before).empty()) << "the camera could have changed, but did not";
  EXPECT_EQ(status()["rings"]["camera.frames"]["wanted_hz"], 60);

  kill(before.at("content"), SIGKILL);
  EXPECT_TRUE(eventually([&] {
    const auto now = service("content");
    return now["pid"] != before.at("content") && now["state"] == "ready";
  })) << "it was started with the old settings";

  write_rig_with("rate_hz = 50", kNoObserver);
  EXPECT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_EQ(status()["rings"]["camera.frames"]["wanted_hz"], 50);
  expect_more_light();
}

}  // namespace
}  // namespace handcast::system_test
