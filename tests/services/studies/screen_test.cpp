// SPDX-License-Identifier: Apache-2.0
// The study on a screen: a real X server, a real window, and a simulated subject.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/services/studies/study_on_screen.hpp"

namespace handcast::study {
namespace {

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
  Running study(command("--answers-by-model --seed 2"));
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
