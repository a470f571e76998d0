// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include "renderer/media/picture.hpp"
#include "services/studies/shooter/game.hpp"
#include "services/studies/shooter/picture.hpp"
#include "services/studies/shooter/run.hpp"
#include "tests/services/studies/scripted_hand.hpp"

namespace handcast::study {
namespace {

class Shooter : public testing::Test {
 protected:
  void play(double seconds, float steer, bool is_seen = true) {
    for (double s = 0; s < seconds; s += kStep_s) step(steer, is_seen);
  }
  void step(float steer, bool is_seen = true) {
    game_.step(kStep_s, std::array{ShooterPlayer{steer, is_seen}});
  }
  const ShooterScene& scene() const { return game_.scene(); }
  ShooterGame game_{4};
};

TEST_F(Shooter, BeginsWithAHandAndPausesWithoutOne) {
  play(5, 0, false);
  EXPECT_FALSE(scene().is_playing);
  play(0.5, 0);
  ASSERT_TRUE(scene().is_playing);
  const auto aliens = scene().aliens[0].at_mm;
  play(5, 0, false);
  EXPECT_EQ(scene().aliens[0].at_mm, aliens);
}

TEST_F(Shooter, TheShipGoesWhereItIsSteered) {
  play(1, -1);
  EXPECT_NEAR(scene().ship_mm, -ShooterScene::kHalfWidth_mm, 0.1);
  play(1, 0.5f);
  EXPECT_NEAR(scene().ship_mm, 0.5f * ShooterScene::kHalfWidth_mm, 0.1);
  play(1, 7);
  EXPECT_LE(scene().ship_mm, ShooterScene::kHalfWidth_mm);
}

TEST_F(Shooter, AliensThatAreHitGiveScore) {
  play(4, 0);
  EXPECT_GT(scene().score, 0);
  EXPECT_LT(scene().aliens.size(), 15u);
}

TEST_F(Shooter, APlayerWhoFollowsTheAliensClearsTheWave) {
  for (double s = 0; s < 90 && scene().wave < 2; s += kStep_s) {
    const float target = scene().aliens.empty() ? 0 : scene().aliens.back().at_mm.x;
    step(target / ShooterScene::kHalfWidth_mm);
  }
  EXPECT_GE(scene().wave, 2);
  EXPECT_GE(scene().score, 300);
}

TEST_F(Shooter, WhoDoesNothingLosesAllLivesAndTheNextGameBeginsByItself) {
  bool was_over = false, began_again = false;
  for (double s = 0; s < 300 && !began_again; s += kStep_s) {
    step(1);
    was_over |= scene().lives == 0 && !scene().is_playing;
    began_again |= was_over && scene().is_playing && scene().lives == ShooterScene::kLives;
  }
  EXPECT_TRUE(was_over);
  EXPECT_TRUE(began_again);
}

TEST_F(Shooter, EndlessPlayStaysBounded) {
  for (double s = 0; s < 600; s += kStep_s) step(static_cast<float>(std::sin(s)));
  EXPECT_LE(scene().shots_mm.size(), 10u);
  EXPECT_LE(scene().bombs_mm.size(), 60u);
  EXPECT_LE(scene().bursts_mm.size(), 40u);
}

class TwoHands : public testing::Test {
 protected:
  /// Steers both ships to their last aliens, if they are to be hit.
  void play(double seconds, std::array<bool, 2> hits, std::array<bool, 2> seen = {true, true}) {
    for (double s = 0; s < seconds; s += kStep_s) {
      std::array<ShooterPlayer, 2> players;
      for (std::size_t hand = 0; hand < 2; ++hand) {
        const auto& aliens = game_.scene(hand).aliens;
        const float target_mm = hits[hand] && !aliens.empty() ? aliens.back().at_mm.x : -30;
        players[hand] = {target_mm / ShooterScene::kHalfWidth_mm, seen[hand]};
      }
      events_ = game_.step(kStep_s, players);
      has_shot_ |= events_.has_shot;
      has_hit_ |= events_.has_hit;
      has_lost_ |= events_.has_lost;
    }
  }
  std::size_t aliens() const { return game_.scene(0).aliens.size() + game_.scene(1).aliens.size(); }

  ShooterGame game_{4, 2};
  ShooterEvents events_;
  bool has_shot_ = false, has_hit_ = false, has_lost_ = false;
};

TEST_F(TwoHands, HaveOneScoreOneSetOfLivesAndOneWave) {
  play(0.1, {false, false});
  EXPECT_EQ(aliens(), 30u);
  play(4, {true, false});
  EXPECT_GT(game_.scene(0).score, 0);
  EXPECT_EQ(game_.scene(1).score, game_.scene(0).score);
  for (int s = 0; s < 120 && game_.scene(0).lives == ShooterScene::kLives; ++s)
    play(1, {true, false});
  EXPECT_LT(game_.scene(0).lives, ShooterScene::kLives);
  EXPECT_EQ(game_.scene(1).lives, game_.scene(0).lives);
}

TEST_F(TwoHands, WhoHasNoAliensLeftGetsHalfOfThoseOfTheOther) {
  for (int s = 0; s < 60 * 60 && game_.scene(0).aliens.size() != 1; ++s)
    play(kStep_s, {true, false}, {true, false});
  ASSERT_EQ(game_.scene(0).aliens.size(), 1u);
  EXPECT_EQ(game_.scene(1).aliens.size(), 15u) << "the other hand was away";
  for (int s = 0; s < 60 * 60 && game_.scene(0).aliens.size() == 1; ++s)
    play(kStep_s, {true, false}, {true, false});
  EXPECT_EQ(game_.scene(0).aliens.size(), 7u);
  EXPECT_EQ(game_.scene(1).aliens.size(), 8u);
  EXPECT_EQ(game_.scene(0).wave, 1);
}

TEST_F(TwoHands, TogetherTheyClearTheWave) {
  for (int s = 0; s < 120 && game_.scene(0).wave < 2; ++s) play(1, {true, true});
  EXPECT_GE(game_.scene(0).wave, 2);
  EXPECT_EQ(game_.scene(1).wave, game_.scene(0).wave);
}

TEST_F(TwoHands, AHandThatIsAwayPausesAlone) {
  play(1, {false, false});
  const auto here = game_.scene(0).aliens[0].at_mm, away = game_.scene(1).aliens[0].at_mm;
  play(1, {false, false}, {true, false});
  EXPECT_NE(game_.scene(0).aliens[0].at_mm, here);
  EXPECT_EQ(game_.scene(1).aliens[0].at_mm, away);
}

TEST_F(TwoHands, ShotsHitsAndLossesAreTold) {
  for (int s = 0; s < 200 && !has_lost_; ++s) play(1, {true, false});
  EXPECT_TRUE(has_shot_ && has_hit_ && has_lost_);
}

TEST(Tilt, TurningAboutTheForearmSteersAndMovingDoesNot) {
  const auto flat = hand_with({});
  const auto turned = [&](float angle_rad, glm::vec3 shift) {
    auto joints = flat;
    const glm::mat3 turn(glm::rotate(glm::mat4(1), angle_rad, glm::vec3(0, 1, 0)));
    for (auto& joint : joints) joint = turn * joint + shift;
    return joints;
  };
  TiltSteering tilt(msg::Side::left);
  EXPECT_FLOAT_EQ(tilt.at(0, flat), 0);
  EXPECT_NEAR(tilt.at(0.1, turned(0, {0.2f, 0.1f, 0.3f})), 0, 1e-3);
  const float one = tilt.at(0.2, turned(0.3f, {})), other = tilt.at(0.3, turned(-0.3f, {}));
  EXPECT_NEAR(one, -other, 1e-3);
  EXPECT_GT(glm::abs(one), 0.5f);
  EXPECT_FLOAT_EQ(tilt.at(9, turned(0.3f, {})), 0) << "held anew";
}

TEST(ShooterPictures, TheGameTheScoreAndTheLivesAreOnTheHand) {
  const auto mesh = renderer::load_hand_or_default("", renderer::Side::left);
  ASSERT_TRUE(mesh);
  ShooterPicture picture(*mesh, 1024, 640);
  ShooterGame game(4);
  for (int step = 0; step < 200; ++step) game.step(kStep_s, std::array{ShooterPlayer{0.3f, true}});
  const auto drawn = picture.draw(game.scene(), Face::palm, 3);
  const renderer::Texture before = [&] {
    renderer::Texture copy(drawn.width, drawn.height);
    std::copy_n(drawn.data, copy.pixels().size(), copy.pixels().begin());
    return copy;
  }();
  const char* folder = std::getenv("HANDCAST_PICTURES");
  EXPECT_TRUE(!folder || renderer::write_png(std::string(folder) + "/shooter.png", drawn));
  auto poorer = game.scene();
  poorer.lives = 1;
  const auto after = picture.draw(poorer, Face::palm, 3);
  const HandLayout layout(*mesh, 1024, 640);
  std::array<int, 5> changed{};
  for (int y = 0; y < after.height; ++y)
    for (int x = 0; x < after.width; ++x)
      if (after.at(x, y) != before.at(x, y))
        for (std::size_t f = 0; f < 5; ++f)
          changed[f] += glm::distance(layout.tip(f, Face::palm).middle_px, glm::vec2(x, y)) < 30;
  EXPECT_EQ(changed[1], 0) << "the index finger has the last life";
  for (std::size_t f = 2; f < 5; ++f) EXPECT_GT(changed[f], 20) << f;
}

}  // namespace
}  // namespace handcast::study
