// SPDX-License-Identifier: Apache-2.0
// `handcast preview --shot` of a running rig.
#include <gmock/gmock.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/control/rig_address.hpp"
#include "renderer/media/picture.hpp"
#include "services/tools/preview/rig_follower.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr int kWidth = 1200, kHeight = 700;

struct Pixel {
  int red, green, blue;
};

Pixel at(const renderer::Texture& picture, int x, int y) {
  const auto pixel = picture.at(x, y);
  return {static_cast<int>(pixel & 255), static_cast<int>(pixel >> 8 & 255),
          static_cast<int>(pixel >> 16 & 255)};
}

bool is_bright(Pixel pixel) { return std::min({pixel.red, pixel.green, pixel.blue}) > 90; }
bool is_coloured(Pixel pixel) {
  const auto [low, high] = std::minmax({pixel.red, pixel.green, pixel.blue});
  return high - low > 40 && high > 60;
}
/// The colour of the region D, hand with light, without the image below it.
bool is_lit_hand(Pixel pixel) {
  return pixel.green > 60 && pixel.green > 3 * pixel.red && pixel.blue > 2 * pixel.red;
}

/// The panels, with their titles and figures cut off: the left and the right half of the upper
/// part.
struct Area {
  int x0, x1, y0 = 90, y1 = 430;

  template <class Is>
  int count(const renderer::Texture& picture, Is is) const {
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) count += is(at(picture, x, y));
    return count;
  }
};
constexpr Area kCamera{30, 560}, kLight{680, 1170};

class Preview : public SystemTest {
 protected:
  /// The picture of a rig that is up.
  renderer::Texture shot(const Arguments& more = {}) const {
    const auto file = (scratch_.path() / "shot.png").string();
    Arguments arguments{"preview", "--shot", file, "--after", "1", "--size", "1200x700"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = handcast(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.log;
    auto picture = renderer::read_picture(file);
    EXPECT_TRUE(picture);
    return picture ? std::move(*picture) : renderer::Texture(kWidth, kHeight);
  }
  std::string in_scratch(const std::string& name) const {
    return (scratch_.path() / name).string();
  }
};

TEST_F(Preview, AShotShowsTheHandTheRegionsOnItAndTheLight) {
  const auto rig = up({"--set", "twin.motion=builtin:still"});
  wait_until_light();
  const auto image = shot({"--layers", "image"}), regions = shot({"--layers", "regions"});
  ASSERT_EQ(image.width(), kWidth);
  ASSERT_EQ(image.height(), kHeight);
  EXPECT_GT(kLight.count(image, is_coloured), 1000) << "the light";

  int lit = 0, on_hand = 0;
  for (int y = kCamera.y0; y < kCamera.y1; ++y)
    for (int x = kCamera.x0; x < kCamera.x1; ++x) {
      if (!is_lit_hand(at(regions, x, y))) continue;
      ++lit;
      on_hand += is_bright(at(image, x, y));
    }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(on_hand, lit * 9 / 10) << "the hand does not move, so both pictures show it alike";
  EXPECT_EQ(kCamera.count(image, is_lit_hand), 0) << "a layer that was not chosen";
}

TEST_F(Preview, ABlackoutIsSeenAndSaidWhereverPeopleLook) {
  const auto rig = up({"--set", "twin.motion=builtin:still"});
  wait_until_light();
  EXPECT_THAT(handcast({"status"}).output, Not(HasSubstr("the light is off")));
  ASSERT_EQ(handcast({"blackout"}).exit_code, 0);
  const auto dark = shot();
  EXPECT_EQ(kLight.count(dark, is_coloured), 0);
  EXPECT_EQ(kCamera.count(dark, is_coloured), 0);
  EXPECT_THAT(handcast({"status"}).output, HasSubstr("the light is off: light.blackout is on"));
  ASSERT_EQ(handcast({"blackout", "off"}).exit_code, 0);
  EXPECT_GT(kLight.count(shot(), is_coloured), 1000);
}

TEST_F(Preview, AShotShowsTheLightOfTheSecondProjector) {
  Arguments two{"--set", "twin.motion=builtin:still"};
  for (const char* setting : {"calibration=config/calibrations/left_of_two.toml",
                              "projector2.calibration=config/calibrations/right_of_two.toml",
                              "projector2.backend=twin", "projector2.rate_hz=60"})
    two.insert(two.end(), {"--set", setting});
  const auto rig = up(two);
  wait_until_light();
  ASSERT_TRUE(eventually([&] { return service("projector2")["state"] == "ready"; }));
  const auto first = shot(), second = shot({"--second-projector"});
  EXPECT_GT(kLight.count(second, is_coloured), 1000);
  int others = 0;
  for (int y = kLight.y0; y < kLight.y1; ++y)
    for (int x = kLight.x0; x < kLight.x1; ++x) others += first.at(x, y) != second.at(x, y);
  EXPECT_GT(others, 1000) << "another picture";
}

TEST_F(Preview, TheRigKnowsNothingOfAPreview) {
  const auto rig = up();
  wait_until_light();
  const auto second = handcast({"preview", "--second-projector", "--shot", in_scratch("b.png")});
  EXPECT_EQ(second.exit_code, 100);
  EXPECT_THAT(second.log, HasSubstr("the rig has no second projector"));
  Command preview(scratch_.path(), {"preview", "--shot", in_scratch("a.png"), "--after", "4"});
  const auto top = handcast({"top", "--json"});
  EXPECT_TRUE(preview.running());
  EXPECT_THAT(top.output, HasSubstr("projection.frames"));
  EXPECT_THAT(top.output, Not(HasSubstr("preview"))) << "no place in a ring is taken";
  EXPECT_EQ(preview.wait(), 0) << preview.log();
}

TEST_F(Preview, ARigThatGoesDownEndsThePreviewWithASentence) {
  const auto rig = up();
  wait_until_light();
  Command preview(scratch_.path(), {"preview", "--shot", in_scratch("a.png"), "--after", "60"});
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(preview.wait(), 111);
  EXPECT_THAT(preview.log(), HasSubstr("handcast preview: "));
  EXPECT_FALSE(std::filesystem::exists(in_scratch("a.png")));
}

TEST_F(Preview, AFollowedRigIsDarkWhileItIsDownAndGoesOnWhenItIsUpAgain) {
  const auto is_lit = [](const preview::Scene& scene) {
    return std::ranges::any_of(scene.light.pixels(), [](auto pixel) { return pixel != 0; });
  };
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  auto rig = up();
  wait_until_light();
  auto feed = preview::RigFeed::open("");
  ASSERT_TRUE(feed) << feed.error().what;
  preview::RigFollower follower(std::move(*feed));
  const auto wait_until = [&](auto is_so) {
    for (int i = 0; i < 2000; ++i) {
      follower.look();
      if (is_so(follower.scene())) return true;
      sleep_until_ns(now_ns() + preview::RigFeed::kPeriod_ns);
    }
    return false;
  };
  EXPECT_TRUE(wait_until(is_lit));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_TRUE(wait_until([](const auto& scene) { return scene.is_down; }));
  const auto dark = follower.scene();
  EXPECT_EQ(dark.light.width(), 0);
  EXPECT_THAT(dark.missing, ElementsAre(HasSubstr("the rig is down; `handcast up` starts it")));
  EXPECT_EQ(rig->wait(), 0);
  rig = up();
  EXPECT_TRUE(wait_until(is_lit)) << "by itself";
}

TEST_F(Preview, WithoutARigItSaysSo) {
  const auto outcome = handcast({"preview", "--shot", in_scratch("a.png")});
  EXPECT_EQ(outcome.exit_code, 111);
  EXPECT_THAT(outcome.log, HasSubstr("no rig is up"));
}

TEST_F(Preview, AFileThatCannotBeWrittenIsRefusedWithASentence) {
  const auto rig = up();
  wait_until_light();
  for (const auto& [file, exit_code] :
       {std::pair{scratch_.path().string(), 100}, std::pair{std::string("/nowhere/a.png"), 100},
        std::pair{std::string("/dev/full"), 111}}) {
    const auto outcome = handcast({"preview", "--after", "0.2", "--shot", file});
    EXPECT_EQ(outcome.exit_code, exit_code) << file;
    EXPECT_THAT(outcome.log, HasSubstr("cannot be written")) << file;
    EXPECT_THAT(outcome.log, HasSubstr(file));
  }
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST_F(Preview, WithoutADisplayItNamesTheWayWithoutOne) {
  const Variable display("DISPLAY", "");
  const auto rig = up();
  wait_until_light();
  const auto outcome = handcast({"preview"});
  EXPECT_THAT(outcome.exit_code, testing::AnyOf(100, 111)) << "this build may have no window";
  EXPECT_THAT(outcome.log, HasSubstr("use --shot FILE.png"));
}

TEST_F(Preview, NonsenseOnTheCommandLineIsRefused) {
  for (const Arguments& words : {Arguments{"preview", "--layers", "hands"},
                                 {"preview", "--size", "1"},
                                 {"preview", "--after", "x"},
                                 {"preview", "twin"}})
    EXPECT_EQ(handcast(words).exit_code, 2);
}

}  // namespace
}  // namespace handcast::system_test
