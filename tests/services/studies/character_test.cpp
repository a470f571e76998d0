// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "renderer/media/picture.hpp"
#include "services/studies/character/course.hpp"
#include "services/studies/character/game.hpp"
#include "services/studies/character/picture.hpp"
#include "tests/services/studies/scripted_hand.hpp"

#ifdef __SANITIZE_ADDRESS__
/// Cairo keeps patterns of fontconfig until the process ends.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
#endif

namespace handcast::study {
namespace {

using Phase = CharacterScene::Phase;
constexpr std::array<bool, 4> kStraightHand{};

/// A game and a hand that plays it.
class Played : public testing::Test {
 protected:
  /// Holds a hand for a time, 60 samples a second.
  void hold(const std::array<bool, 4>& bent, double seconds) {
    const auto joints = hand_with(bent);
    for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += kStep_s)
      game_.step(now_s_, &joints);
  }
  void leave(double seconds) {
    for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += kStep_s)
      game_.step(now_s_, nullptr);
  }
  void begin() {
    hold(kStraightHand, 6.1);
    ASSERT_EQ(game_.scene().phase, Phase::asking);
  }
  static std::array<bool, 4> only(std::size_t finger) {
    std::array<bool, 4> bent{};
    bent[finger] = true;
    return bent;
  }
  std::size_t right_finger() const {
    return game_.scene().tips.size() -
           (static_cast<std::size_t>(game_.scene().tips.end() -
                                     std::ranges::find(game_.scene().tips, game_.scene().palm)));
  }

  CharacterGame game_{5, 20};
  double now_s_ = 100;
};

TEST_F(Played, AHandIsSeenForThreeSecondsThenACountDownOfThree) {
  hold(kStraightHand, 2.9);
  EXPECT_EQ(game_.scene().phase, Phase::waiting);
  hold(kStraightHand, 0.2);
  EXPECT_EQ(game_.scene().phase, Phase::counting);
  EXPECT_EQ(game_.scene().countdown, 3);
  hold(kStraightHand, 2);
  EXPECT_EQ(game_.scene().countdown, 1);
  leave(0.1);
  EXPECT_EQ(game_.scene().phase, Phase::waiting) << "a hand that leaves begins anew";
}

TEST_F(Played, ExactlyOneTipHasTheCharacterOfThePalm) {
  begin();
  std::set<std::size_t> asked;
  while (!game_.is_over()) {
    const auto& scene = game_.scene();
    EXPECT_EQ(std::ranges::count(scene.tips, scene.palm), 1);
    EXPECT_EQ(std::set<char>(scene.tips.begin(), scene.tips.end()).size(), 4u);
    asked.insert(right_finger());
    hold(only(right_finger()), 0.3);
    hold(kStraightHand, 1.1);
  }
  EXPECT_EQ(game_.results().size(), 20u);
  EXPECT_EQ(asked.size(), 4u) << "each finger is asked for";
  EXPECT_TRUE(std::ranges::all_of(game_.results(), &CharacterRound::is_correct));
}

TEST_F(Played, EveryFingerCanAnswerAndAWrongOneCountsAsWrong) {
  begin();
  for (std::size_t finger = 0; finger < 4; ++finger) {
    hold(only(finger), 0.3);
    ASSERT_EQ(game_.results().size(), finger + 1);
    EXPECT_EQ(game_.results().back().picked, finger);
    EXPECT_EQ(game_.results().back().is_correct(), finger == game_.results().back().asked);
    hold(kStraightHand, 1.1);
  }
}

TEST_F(Played, TwoFingersAtOnceAreNoAnswerAndAShortTwitchIsNone) {
  begin();
  hold({true, true, false, false}, 2);
  EXPECT_TRUE(game_.results().empty());
  hold(kStraightHand, 0.2);
  hold(only(1), 0.08);
  hold(kStraightHand, 0.5);
  EXPECT_TRUE(game_.results().empty());
  hold(only(1), 0.3);
  EXPECT_EQ(game_.results().size(), 1u);
}

TEST_F(Played, TheNextRoundWaitsForASecondOfStraightFingers) {
  begin();
  hold(only(0), 3);
  EXPECT_EQ(game_.results().size(), 1u) << "one bent finger answers once";
  hold(kStraightHand, 0.9);
  EXPECT_EQ(game_.scene().phase, Phase::straighten);
  hold(kStraightHand, 0.2);
  EXPECT_EQ(game_.scene().phase, Phase::asking);
  EXPECT_EQ(game_.scene().round, 2);
}

TEST_F(Played, TimeWithoutAHandIsTakenOff) {
  begin();
  hold(kStraightHand, 1);
  leave(30);
  hold(only(2), 0.3);
  ASSERT_EQ(game_.results().size(), 1u);
  EXPECT_NEAR(game_.results()[0].seconds, 1.2, 0.2);
}

TEST_F(Played, TheCharactersOnTheTipsJumpOnceASecond) {
  begin();
  const auto first = game_.scene().shift;
  hold(kStraightHand, 0.5);
  EXPECT_EQ(game_.scene().shift, first);
  hold(kStraightHand, 0.6);
  EXPECT_NE(game_.scene().shift, first);
  for (const auto& shift : game_.scene().shift) {
    EXPECT_LE(glm::abs(shift.x), 1);
    EXPECT_LE(glm::abs(shift.y), 1);
  }
}

TEST(Characters, ThereAre43AndAllCome) {
  EXPECT_EQ(kCharacters.size(), 43u);
  EXPECT_EQ(std::set<char>(kCharacters.begin(), kCharacters.end()).size(), 43u);
}

TEST(CharacterCourse, BothMethodsMeetBothFacesEquallyOftenInBothOrders) {
  for (const int subject : {1, 2}) {
    const auto sessions = character_sessions(subject, 24);
    ASSERT_EQ(sessions.size(), 28u);
    std::array<std::array<int, 2>, 2> count{};
    for (const auto& session : sessions) {
      EXPECT_EQ(session.is_training, session.number < 4);
      if (!session.is_training)
        ++count[session.is_corrected][static_cast<std::size_t>(session.face)];
    }
    for (const auto& method : count)
      for (const int times : method) EXPECT_EQ(times, 6);
    EXPECT_EQ(sessions[0].is_corrected, subject == 2);
  }
}

StudyTable played_log(double baseline_s, double corrected_s) {
  StudyTable log{.name = "log", .columns = character_columns(), .rows = {}};
  for (const auto& session : character_sessions(1, 6)) {
    const double mean_s = session.is_corrected ? corrected_s : baseline_s;
    for (int round = 1; round <= 4; ++round)
      log.rows.push_back(line_of(CharacterPlayer{}, session, round,
                                 {.palm = 'A',
                                  .asked = 1,
                                  .picked = round == 4 && !session.is_corrected ? 2u : 1u,
                                  .seconds = mean_s + 0.1 * round + 0.01 * session.number}));
    log.rows.push_back(line_of(CharacterPlayer{}, session, session.is_corrected ? 2 : 4));
  }
  return log;
}

TEST(CharacterAnalysis, ComparesTheRoundsOfPairsOfSessions) {
  const auto log = played_log(3, 2);
  EXPECT_EQ(sessions_done(log), 10);
  const auto findings = analyse_characters({log});
  ASSERT_TRUE(findings) << findings.error().what;
  const auto json = to_json(*findings);
  EXPECT_EQ(json["conditions"]["baseline"]["count"], 1) << "a subject";
  EXPECT_EQ(json["pairs"]["conditions"]["baseline"]["count"], 3);
  EXPECT_NEAR(json["conditions"]["baseline"]["mean_s"].get<double>(), 3.25 + 0.06, 0.02);
  EXPECT_NEAR(json["pairs"]["paired_t_test"]["mean_difference_s"].get<double>(), -1, 0.02);
  EXPECT_DOUBLE_EQ(json["conditions"]["baseline"]["accuracy"].get<double>(), 0.75);
  EXPECT_EQ(json["conditions"]["corrected"]["difficulty"][1], 3);
  EXPECT_THAT(page_of(*findings), testing::HasSubstr("75.0 % of the answers are right"));
}

TEST(CharacterAnalysis, ASessionThatWasLeftDoesNotCountAndOneThatWasBegunAnewCountsOnce) {
  auto log = played_log(3, 2);
  const auto whole = analyse_characters({log});
  ASSERT_TRUE(whole);
  // Three rounds of the first test session, very slow, before it was begun anew; and one that was
  // left at the end.
  const auto first = std::ranges::find(log.rows, "test", [](const auto& row) { return row[4]; });
  std::vector<CsvRow> left(first, first + 3);
  for (auto& row : left) row[12] = "99";
  log.rows.insert(first, left.begin(), left.end());
  log.rows.insert(log.rows.end(), left.begin(), left.end());
  const auto again = analyse_characters({log});
  ASSERT_TRUE(again);
  EXPECT_EQ(to_json(*again), to_json(*whole));
}

TEST(CharacterAnalysis, ALogOfBeforeSeedAndHandCountsTheSame) {
  const auto log = played_log(3, 2);
  auto earlier = log;
  earlier.columns = {"subject", "session", "phase",  "condition", "face",    "round",
                     "palm",    "asked",   "picked", "correct",   "seconds", "difficulty"};
  for (auto& row : earlier.rows) row.erase(row.begin() + 1, row.begin() + 3);
  const auto findings = analyse_characters({earlier});
  ASSERT_TRUE(findings) << findings.error().what;
  EXPECT_EQ(to_json(*findings), to_json(*analyse_characters({log})));
}

TEST(CharacterLog, GoesOnWithTheSameSeedAndHandOnly) {
  StudyTable log{.name = "log", .columns = character_columns(), .rows = {}};
  const CharacterPlayer player{.subject = 3, .seed = 8, .hand = msg::Side::right};
  EXPECT_TRUE(check_player(log, player));
  log.rows.push_back(line_of(player, character_sessions(3, 6)[0], 1, {}));
  EXPECT_EQ(log.rows[0][1], "8");
  EXPECT_EQ(log.rows[0][2], "right");
  EXPECT_TRUE(check_player(log, player));
  EXPECT_THAT(check_player(log, {.subject = 3, .seed = 9, .hand = msg::Side::right}).error().what,
              testing::HasSubstr("--seed 8 --hand right"));
  EXPECT_FALSE(check_player(log, {.subject = 3, .seed = 8, .hand = msg::Side::left}));
}

TEST(CharacterAnalysis, WhatIsNoLogIsNamed) {
  EXPECT_FALSE(analyse_characters({}));
  auto log = played_log(3, 2);
  log.rows[20][12] = "soon";
  EXPECT_THAT(analyse_characters({log}).error().what, testing::HasSubstr("'soon'"));
  log.columns = {"a"};
  EXPECT_THAT(analyse_characters({log}).error().what, testing::HasSubstr("no log of this game"));
}

TEST(HandLayout, APatchIsAsLargeAsTheHandAndLiesOnItsChart) {
  for (const auto side : {renderer::Side::left, renderer::Side::right}) {
    const auto mesh = renderer::load_hand_or_default("", side);
    ASSERT_TRUE(mesh);
    const HandLayout layout(*mesh, 640, 400);
    for (const auto face : {Face::back, Face::palm}) {
      const auto& palm = layout.palm(face);
      EXPECT_GT(palm.middle_px.x, 0);
      EXPECT_LT(palm.middle_px.x, 640);
      // The picture of a hand is about 300 mm wide.
      EXPECT_NEAR(glm::length(palm.px_per_mm[0]), 1.7, 0.8);
      EXPECT_NEAR(glm::length(palm.px_per_mm[1]), 1.7, 0.8);
      for (std::size_t finger = 0; finger < HandLayout::kFingers; ++finger) {
        const auto& tip = layout.tip(finger, face);
        ASSERT_GT(tip.middle_px.x, 0) << finger;
        EXPECT_GT(glm::length(tip.px_per_mm[1]), 0.5) << finger;
        EXPECT_LT(glm::length(tip.px_per_mm[1]), 3) << finger;
      }
      // All are seen from outside: none is a mirror image of another.
      const float turn = glm::determinant(palm.px_per_mm);
      for (std::size_t finger = 1; finger < HandLayout::kFingers; ++finger)
        EXPECT_GT(turn * glm::determinant(layout.tip(finger, face).px_per_mm), 0) << finger;
    }
  }
}

TEST(CharacterPictures, TheCharactersAreOnThePalmAndTheTips) {
  const auto mesh = renderer::load_hand_or_default("", renderer::Side::left);
  ASSERT_TRUE(mesh);
  CharacterPicture picture(*mesh, 640, 400);
  const HandLayout layout(*mesh, 640, 400);
  CharacterScene scene{.phase = Phase::asking, .palm = 'M', .tips = {'M', 'A', '7', '@'}};
  const auto drawn = picture.draw(scene, Face::palm);
  const auto inked = [&](const Patch& patch, float reach_px) {
    int count = 0;
    for (int y = 0; y < drawn.height; ++y)
      for (int x = 0; x < drawn.width; ++x)
        count += glm::distance(glm::vec2(x, y), patch.middle_px) < reach_px &&
                 (drawn.at(x, y) & 0xff) > 200;
    return count;
  };
  EXPECT_GT(inked(layout.palm(Face::palm), 50), 150);
  for (std::size_t tip = 1; tip < 5; ++tip) EXPECT_GT(inked(layout.tip(tip, Face::palm), 16), 15);
  EXPECT_EQ(inked(layout.palm(Face::back), 50), 0);
  const char* folder = std::getenv("HANDCAST_PICTURES");
  EXPECT_TRUE(!folder || renderer::write_png(std::string(folder) + "/character.png", drawn));
}

}  // namespace
}  // namespace handcast::study
