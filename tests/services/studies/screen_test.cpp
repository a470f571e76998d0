// SPDX-License-Identifier: Apache-2.0
// The study on a screen: a real X server, a real window, and a simulated subject.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/studies/base/study_table.hpp"
#include "tests/display_server.hpp"
#include "tests/scratch.hpp"

extern char** environ;

namespace handcast::study {
namespace {

using namespace std::chrono_literals;

/// A shell command that is killed at the end.
class Running {
 public:
  explicit Running(std::string command) {
    char* const arguments[] = {const_cast<char*>("sh"), const_cast<char*>("-c"), command.data(),
                               nullptr};
    EXPECT_EQ(::posix_spawn(&pid_, "/bin/sh", nullptr, nullptr, arguments, environ), 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  /// The exit code, if it has ended by itself.
  std::optional<int> exit_code() {
    int status = 0;
    if (pid_ > 0 && ::waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = 0;
      exit_code_ = WEXITSTATUS(status);
    }
    return exit_code_;
  }

 private:
  pid_t pid_ = 0;
  std::optional<int> exit_code_;
};

class Screen : public testing::Test {
 protected:
  static constexpr auto kPatience = 60s;

  void SetUp() override {
    if (!display_) GTEST_SKIP() << test::DisplayServer::why();
  }
  std::string command(const std::string& arguments = "") const {
    return fmt::format(
        "exec {}/handcast-study jnd {} --answers-by-model --window --size 320x240 "
        "--px-per-mm 0.9 --interval-s 0.2 --rate-hz 10 {} >>{}/out 2>&1",
        std::getenv("HANDCAST_BIN"), scratch_.path().string(), arguments, scratch_.path().string());
  }
  /// Kills the study when its log has so many rows. Where it gives up, because this computer is too
  /// busy for its pictures, it is begun again.
  void study_until(std::size_t rows) const {
    for (const auto end = Deadline::in(kPatience); log().rows.size() < rows && !end.passed();)
      for (Running study(command());
           log().rows.size() < rows && !study.exit_code() && !end.passed();)
        std::this_thread::sleep_for(20ms);
  }
  StudyTable log() const {
    return read_study_table(scratch_.path() / "subject-01.csv").value_or(StudyTable());
  }
  std::string said() const {
    std::ifstream file(scratch_.path() / "out");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  test::DisplayServer display_;
  test::Scratch scratch_;
};

TEST_F(Screen, AStudyThatIsKilledGoesOnWhereItWasAndHasTheTimesOfAllPictures) {
  study_until(3);
  const auto first = log();
  ASSERT_GE(first.rows.size(), 3u) << said();
  study_until(first.rows.size() + 3);
  const auto second = log();
  ASSERT_GE(second.rows.size(), first.rows.size() + 3) << said();
  for (std::size_t row = 0; row < first.rows.size(); ++row)
    EXPECT_EQ(second.rows[row], first.rows[row]);
  const auto light = read_study_table(scratch_.path() / "subject-01.light.csv");
  ASSERT_TRUE(light) << light.error().what;
  const auto hand = *light->column("hand_s"), lit = *light->column("light_s"),
             trial = *light->column("trial"), interval = *light->column("interval");
  // In every trial one interval is late, by what was asked.
  for (std::size_t row = 0; row < light->rows.size(); ++row) {
    const auto number = static_cast<std::size_t>(*light->number(row, trial));
    if (light->rows[row][0] != "1" || number > second.rows.size()) continue;
    const auto& asked = second.rows[number - 1];
    const double delay_ms = asked[8] == light->rows[row][interval] ? std::stod(asked[7]) : 0;
    EXPECT_NEAR(1e3 * (*light->number(row, hand) - *light->number(row, lit)), delay_ms, 0.01);
  }
}

TEST_F(Screen, AnotherSeedDoesNotGoOnInTheSameLog) {
  study_until(1);
  ASSERT_GT(log().rows.size(), 0u) << said();
  Running study(command("--seed 2"));
  for (const auto end = Deadline::in(kPatience); !study.exit_code() && !end.passed();)
    std::this_thread::sleep_for(20ms);
  EXPECT_EQ(study.exit_code(), 100) << said();
}

TEST(StudyWithoutAScreen, IsAnErrorWithASentence) {
  const test::Scratch scratch;
  const auto out = scratch.path() / "out";
  const auto command =
      fmt::format("env -u DISPLAY {}/handcast-study jnd {} 2>{}", std::getenv("HANDCAST_BIN"),
                  scratch.path().string(), out.string());
  EXPECT_NE(std::system(command.c_str()), 0);
  std::ifstream file(out);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_THAT(text, testing::HasSubstr("handcast study jnd: "));
}

}  // namespace
}  // namespace handcast::study
