// SPDX-License-Identifier: Apache-2.0
// `handcast init` writes rig files that work, for the twin and for emulated devices.
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <sstream>

#include "calib/calibration.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// `handcast` with a terminal, at which a person types.
class AtATerminal {
 public:
  explicit AtATerminal(const Arguments& arguments) {
    pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ != 0) return;
    const auto program = (program_folder() / "handcast").string();
    std::vector<char*> pointers{const_cast<char*>(program.c_str())};
    for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());
    _exit(127);
  }
  ~AtATerminal() {
    close(terminal_);  // whoever still asks gets SIGHUP
    if (!is_reaped_) waitpid(pid_, nullptr, 0);
  }
  AtATerminal(const AtATerminal&) = delete;

  /// Waits for the next question, and types an answer.
  void type(const std::string& answer) {
    read_until("] > ");
    ASSERT_EQ(write(terminal_, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
  }
  /// Waits for the end. The status as that of waitpid().
  int wait() {
    read_until("");
    int status = 0;
    waitpid(pid_, &status, 0);
    is_reaped_ = true;
    return status;
  }
  const std::string& shown() const { return shown_; }

 private:
  /// Reads until a text comes; an empty text: until the program has ended.
  void read_until(const std::string& text) {
    const auto begin = shown_.size();
    char byte = 0;
    while (read(terminal_, &byte, 1) == 1) {
      shown_ += byte;
      if (!text.empty() && shown_.find(text, begin) != std::string::npos) return;
    }
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  bool is_reaped_ = false;
  std::string shown_;
};

class Init : public SystemTest {
 protected:
  std::string file() const { return scratch_.path() / "stage.toml"; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(file()).rdbuf();
    return text.str();
  }
  Outcome init(Arguments more = {}) const {
    more.insert(more.begin(), {"init", file()});
    return handcast(more);
  }
  /// The checks of the doctor that found a fault.
  std::vector<std::string> faults() const {
    const auto outcome = handcast({"doctor", file(), "--json"});
    std::vector<std::string> checks;
    for (const auto& finding : nlohmann::json::parse(outcome.output))
      if (finding["grade"] == "fault") checks.push_back(finding["check"]);
    EXPECT_EQ(outcome.exit_code, checks.empty() ? 0 : 1);
    return checks;
  }
  std::unique_ptr<Command> up_with_the_file(const Arguments& more = {}) const {
    Arguments arguments{"up", file(), "--set", "supervisor.ready_s=60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<Command>(scratch_.path(), arguments);
  }
};

TEST_F(Init, ARigOnTheTwinPassesTheDoctorAndRuns) {
  const auto outcome = init({"--camera", "twin", "--output", "twin"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("the rig 'stage'"), HasSubstr("the digital twin"),
                                    HasSubstr("handcast up " + file())));
  EXPECT_EQ(faults(), std::vector<std::string>());
  const auto rig =
      up_with_the_file({"--set", "camera.rate_hz=60", "--set", "projector.rate_hz=60"});
  wait_until_light();
  EXPECT_EQ(status()["rig"], "stage");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(Init, AFileThatExistsIsKeptUnlessForceSaysOtherwise) {
  std::ofstream(file()) << "mine";
  const auto refused = init({"--camera", "twin"});
  EXPECT_EQ(refused.exit_code, 100);
  EXPECT_THAT(refused.log, AllOf(HasSubstr("exists"), HasSubstr("--force")));
  EXPECT_EQ(text(), "mine");
  EXPECT_EQ(init({"--camera", "twin", "--force"}).exit_code, 0);
  EXPECT_THAT(text(), HasSubstr("name = \"stage\""));
}

TEST_F(Init, AFaultyAnswerWritesNothing) {
  for (const auto& [flag, code] : {std::pair("--output", 111), {"--distance", 100}, {"--who", 2}}) {
    const auto refused = init({"--camera", "twin", "--tracker", "none", flag, "nonsense"});
    EXPECT_EQ(refused.exit_code, code) << flag;
    EXPECT_THAT(refused.log, HasSubstr(flag));
    EXPECT_FALSE(fs::exists(file()));
  }
}

TEST_F(Init, APersonIsAskedAtATerminal) {
  AtATerminal person({"init", file(), "--camera", "twin", "--output", "twin"});
  person.type("no idea\n");
  person.type("2\n");
  person.type("my-stage\n");
  EXPECT_EQ(person.wait(), 0) << person.shown();
  EXPECT_THAT(person.shown(),
              AllOf(HasSubstr("Which hand tracker?"), HasSubstr("'no idea' is not none or twin")));
  EXPECT_THAT(text(), AllOf(HasSubstr("name = \"my-stage\""), HasSubstr("none.distance_m = 0.73")));
}

TEST_F(Init, CtrlCOrTheEndOfTheInputLeavesNoFile) {
  AtATerminal person({"init", file(), "--camera", "twin"});
  person.type("\n");
  person.type("\x03");
  EXPECT_TRUE(WIFSIGNALED(person.wait())) << person.shown();
  AtATerminal other({"init", file(), "--camera", "twin"});
  other.type("\x04");
  EXPECT_EQ(WEXITSTATUS(other.wait()), 100);
  EXPECT_THAT(other.shown(), HasSubstr("the input ended"));
  EXPECT_TRUE(fs::is_empty(scratch_.path()));
}

/// With an emulated webcam and an emulated graphics card.
class InitWithDevices : public Init {
 protected:
  void SetUp() override {
    Init::SetUp();
#ifdef HANDCAST_WITH_SANITIZER
    GTEST_SKIP() << "a sanitizer must be loaded before the emulated devices";
#endif
    std::ofstream(plug()) << "in";
    preload_.emplace("LD_PRELOAD", HANDCAST_EMULATED_DEVICES);
    webcam_.emplace("HANDCAST_EMULATED_WEBCAM", plug());
    card_.emplace("HANDCAST_EMULATED_CARD", "EPSON PJ");
  }
  std::string plug() const { return scratch_.path() / "plug"; }
  std::string calibration_of(const std::string& camera) const {
    auto calibration = calib::reference_rig();
    calibration.camera_device = camera;
    calibration.projector_device = "EPSON PJ";
    const std::string path = scratch_.path() / "calibration.toml";
    std::ofstream(path) << calib::print_calibration(calibration);
    return path;
  }

 private:
  std::optional<Variable> preload_, webcam_, card_;
};

TEST_F(InitWithDevices, TheDoctorMissesOnlyTheCalibration) {
  const auto outcome = init({"--camera", "v4l2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("GREY 720x540 at 100 Hz"), HasSubstr("EPSON PJ"),
                                    HasSubstr("MISSING")));
  EXPECT_EQ(faults(), std::vector<std::string>{"calibration"});
}

TEST_F(InitWithDevices, WithACalibrationTheRigPassesAndItsDevicesRun) {
  const auto outcome =
      init({"--camera", "v4l2", "--calibration", calibration_of("Emulated Webcam")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_EQ(faults(), std::vector<std::string>());
  const auto rig = up_with_the_file();
  EXPECT_TRUE(eventually([&] {
    return rig->log().find("sends GREY 720x540 at 100 Hz") != std::string::npos &&
           rig->log().find("mode 1024x768@60") != std::string::npos;
  })) << rig->log();
  EXPECT_TRUE(eventually([&] { return service("projector")["state"] == "ready"; }));
  EXPECT_EQ(service("camera")["state"], "ready");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(InitWithDevices, ACalibrationOfAnotherCameraIsRefused) {
  const auto outcome = init({"--camera", "v4l2", "--calibration", calibration_of("Old Webcam")});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log, HasSubstr("made with the camera 'Old Webcam'"));
  EXPECT_FALSE(fs::exists(file()));
}

}  // namespace
}  // namespace handcast::system_test
