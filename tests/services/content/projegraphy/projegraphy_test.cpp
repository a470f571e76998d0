// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/content/projegraphy/studio.hpp"
#include "services/tools/try/projected.hpp"
#include "tests/services/content/projegraphy/shadow_player.hpp"

namespace handcast::projegraphy {
namespace {

constexpr double kStep_s = 1. / 30;
constexpr std::uint32_t kBefore = 0xff404040;

/// The content of one hand of a person who holds animals.
class Wearer {
 public:
  Wearer(ShadowPlayer& player, content::Side side)
      : player_(player), index_(static_cast<std::size_t>(side)) {
    auto opening = content::opening_of("projegraphy", "", side, 640, 400);
    opening.calibration = &player.calibration();
    source_ = content::opened(opening);
  }

  void set(std::string_view name, std::string_view value) {
    const auto set = source_->set(name, value);
    ASSERT_TRUE(set) << set.error().what;
  }
  /// Draws the next picture; true if it changed.
  bool draw() {
    moment_.hand = &player_.hands()[index_];
    moment_.other = &player_.hands()[1 - index_];
    const auto begin_ns = now_ns();
    const auto drawn = source_->draw(moment_, {}, picture_);
    most_ms_ = std::max(most_ms_, ns_to_ms(now_ns() - begin_ns));
    EXPECT_TRUE(drawn) << drawn.error().what;
    moment_.time_s += kStep_s;
    ++moment_.frame;
    return *drawn;
  }
  void draw_for(double seconds) {
    for (double s = 0; s < seconds; s += kStep_s) draw();
  }
  /// Draws until it changes. False if it does not.
  bool draw_until_change() {
    for (int k = 0; k < 3000; ++k) {
      if (draw()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  const renderer::Texture& picture() const { return picture_; }
  double most_ms() const { return most_ms_; }  ///< that a picture took
  bool is_blank() const {
    return std::ranges::all_of(picture_.pixels(), [](auto texel) { return texel == kBefore; });
  }

 private:
  ShadowPlayer& player_;
  std::size_t index_;
  std::unique_ptr<content::Source> source_;
  content::Moment moment_;
  double most_ms_ = 0;
  renderer::Texture picture_{640, 400};
};

const Animal& named(std::string_view name) {
  return animals()[static_cast<std::size_t>(animal_of(name))];
}

double difference(const renderer::Texture& a, const renderer::Texture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    for (int c = 0; c < 3; ++c)
      sum += std::abs(content::level_of(a.pixels()[i], c) - content::level_of(b.pixels()[i], c));
  return sum / static_cast<double>(3 * a.pixels().size());
}

TEST(Projegraphy, AHandThatMovesIsNotLookedAt) {
  ShadowPlayer player(51);
  Wearer wearer(player, content::Side::left);
  wearer.set("wait", "true");
  player.hold(named("rabbit"), 0);
  for (int k = 0; k < 60; ++k) {
    wearer.draw();
    player.move({k % 20 < 10 ? 0.003f : -0.003f, 0, 0});
    if (k % 4 == 3) player.move({0.02f * (k % 8 == 3 ? 1.f : -1.f), 0, 0});
    ASSERT_TRUE(wearer.is_blank()) << k;
  }
  wearer.draw_for(1.5);
  EXPECT_FALSE(wearer.is_blank());
}

// What the projector throws onto the hand is the picture of the animal.
TEST(Projegraphy, TheAnimalIsBakedWhereTheProjectorSeesTheHand) {
  ShadowPlayer player(52);
  Wearer wearer(player, content::Side::left);
  wearer.set("wait", "true");
  wearer.set("fade", "0");
  player.hold(named("cat"), 3);
  wearer.draw_for(1);
  const auto light = trial::projected(player.hands()[0], wearer.picture(), player.calibration());
  const auto silhouette = player.silhouette();
  const auto found = recogniser().recognise(silhouette);
  ASSERT_TRUE(found);
  EXPECT_EQ(animals()[static_cast<std::size_t>(found->animal)].name, "cat");
  const auto wanted = painted(silhouette, *found);
  double squares = 0;
  int count = 0;
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      const glm::vec2 at = silhouette.from_projector({x, y});
      const glm::ivec2 px(glm::round(at * 2.f + 0.5f));
      if (px.x < 8 || px.y < 8 || px.x >= kPictureSide_px - 8 || px.y >= kPictureSide_px - 8)
        continue;
      bool is_inside = true;
      for (const auto& [dx, dy] : {std::pair{-3, 0}, {3, 0}, {0, -3}, {0, 3}})
        is_inside = is_inside && silhouette.mask.at(px.x / 2 + dx, px.y / 2 + dy);
      if (!is_inside) continue;
      for (int c = 0; c < 3; ++c) {
        const double off =
            content::level_of(light.at(x, y), c) - content::level_of(wanted.at(px.x, px.y), c);
        squares += off * off;
        ++count;
      }
    }
  const double psnr_db = 10 * std::log10(255. * 255 * count / squares);
  std::printf("%d levels, %.1f dB\n", count, psnr_db);
  EXPECT_GT(count, 10'000);
  EXPECT_GT(psnr_db, 20);
}

TEST(Projegraphy, TheLastAnimalGoesOnUntilTheNextOneIsPaintedAndThenFades) {
  ShadowPlayer player(53);
  Wearer wearer(player, content::Side::left);
  player.hold(named("bear"), 0);
  ASSERT_TRUE(wearer.draw());  // the first picture
  ASSERT_TRUE(wearer.draw_until_change());
  wearer.draw_for(1);
  const auto bear = wearer.picture();
  player.hold(named("rabbit"), 1);
  for (int k = 0; k < 14; ++k) EXPECT_FALSE(wearer.draw()) << k;  // not yet still
  std::vector<renderer::Texture> fading;
  const auto begin_ns = now_ns();
  EXPECT_EQ(wearer.picture().pixels(), bear.pixels());
  ASSERT_TRUE(wearer.draw_until_change());
  std::printf("%.0f ms from the silhouette to the light\n", ns_to_ms(now_ns() - begin_ns));
  fading.push_back(wearer.picture());
  while (wearer.draw()) fading.push_back(wearer.picture());
  const auto rabbit = wearer.picture();
  EXPECT_GT(fading.size(), 15u);
  EXPECT_LT(difference(fading.front(), bear), 2);
  EXPECT_GT(difference(rabbit, bear), 20);
  double before = 1e9;
  for (const auto& picture : fading) {
    const double now = difference(picture, rabbit);
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0);
  std::printf("a picture took at most %.1f ms of the content's thread\n", wearer.most_ms());
}

TEST(Projegraphy, AHandThatMovesButLooksTheSameKeepsItsPicture) {
  ShadowPlayer player(54);
  Wearer wearer(player, content::Side::left);
  wearer.set("wait", "true");
  player.hold(named("bull"), 0);
  wearer.draw_for(2);
  ASSERT_FALSE(wearer.is_blank());
  const auto before = wearer.picture();
  player.move({0.08f, 0.03f, 0});
  for (int k = 0; k < 60; ++k) EXPECT_FALSE(wearer.draw());
  EXPECT_EQ(wearer.picture().pixels(), before.pixels());
}

TEST(Projegraphy, TwoHandsTogetherAreOneAnimalAndApartTwo) {
  ShadowPlayer player(55);
  Wearer left(player, content::Side::left), right(player, content::Side::right);
  for (auto* wearer : {&left, &right}) {
    wearer->set("wait", "true");
    wearer->set("fade", "0");
  }
  player.hold(named("crab"), 0);
  left.draw_for(1);
  right.draw_for(1);
  // Both are red.
  for (const auto* wearer : {&left, &right}) {
    double red = 0, green = 0;
    for (const auto texel : wearer->picture().pixels()) {
      red += content::level_of(texel, 0);
      green += content::level_of(texel, 1);
    }
    EXPECT_GT(red, 1.7 * green);
  }
  player.hold(named("bear"), 0);
  Wearer alone(player, content::Side::left);
  alone.set("wait", "true");
  alone.set("fade", "0");
  alone.draw_for(1);
  left.draw_for(1);
  EXPECT_EQ(left.picture().pixels(), alone.picture().pixels());
}

TEST(Projegraphy, AddressesWithoutAServerOrWithASecretAreRefused) {
  const auto source = content::opened(content::opening_of("projegraphy"));
  EXPECT_TRUE(source->set("recogniser", "https://host/path"));
  EXPECT_TRUE(source->set("painter", "http://127.0.0.1:7860"));
  EXPECT_TRUE(source->set("painter", ""));
  EXPECT_FALSE(source->set("painter", "host:7860"));
  const auto secret = source->set("recogniser", "https://me:hush@host");
  ASSERT_FALSE(secret);
  EXPECT_EQ(secret.error().what.find("hush"), std::string::npos);
  EXPECT_FALSE(source->set("key", "/nowhere/key"));
  EXPECT_FALSE(source->set("budget", "-1"));
}

TEST(Projegraphy, TheHandsShareAPictureAndNobodysIsNotPainted) {
  ShadowPlayer player(56);
  const std::array meshes{&content::made_hand(content::Side::left),
                          &content::made_hand(content::Side::right)};
  const auto studio = Studio::shared(meshes);
  EXPECT_EQ(Studio::shared(meshes), studio);
  player.hold(named("eagle"), 0);
  const auto first = studio->order(player.silhouette()),
             second = studio->order(player.silhouette());
  EXPECT_EQ(first, second);
  player.hold(named("duck"), 0);
  const auto other = studio->order(player.silhouette());
  EXPECT_NE(first, other);
  other->wait();
  EXPECT_TRUE(first->is_done());
  ASSERT_TRUE(first->recognised() && other->recognised());
  EXPECT_EQ(animals()[static_cast<std::size_t>(first->recognised()->animal)].name, "eagle");
  EXPECT_EQ(animals()[static_cast<std::size_t>(other->recognised()->animal)].name, "duck");
}

}  // namespace
}  // namespace handcast::projegraphy
