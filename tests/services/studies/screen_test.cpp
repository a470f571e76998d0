// SPDX-License-Identifier: Apache-2.0
// The study on a screen: a real X server, a real window, and a simulated subject.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <thread>

#include "services/studies/base/study_table.hpp"
#include "tests/display_server.hpp"
#include "tests/scratch.hpp"

namespace handcast::study {
namespace {

using namespace std::chrono_literals;

class Screen : public testing::Test {
 protected:
  void SetUp() override {
    if (!display_) GTEST_SKIP() << test::DisplayServer::why();
  }
  /// Begins the study; its process is killed after `most`.
  int study(std::chrono::seconds most, const std::string& arguments = "") const {
    const auto command = fmt::format(
        "exec timeout -s KILL {} {}/handcast-study jnd {} --answers-by-model --window --size "
        "320x240 "
        "--px-per-mm 0.9 --interval-s 0.2 --rate-hz 30 {} >{}/out 2>&1",
        most.count(), std::getenv("HANDCAST_BIN"), scratch_.path().string(), arguments,
        scratch_.path().string());
    return std::system(command.c_str());
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
  study(12s);
  const auto first = log();
  ASSERT_GT(first.rows.size(), 3u) << said();
  study(12s);
  const auto second = log();
  ASSERT_GT(second.rows.size(), first.rows.size());
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
  study(8s);
  ASSERT_GT(log().rows.size(), 0u) << said();
  const int status = study(20s, "--seed 2");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 100);
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
