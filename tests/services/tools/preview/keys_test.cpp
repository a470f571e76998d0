// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/keys.hpp"

#include <gtest/gtest.h>

#include <string>

namespace handcast::preview {
namespace {

TEST(Keys, NumbersSwitchTheLayers) {
  Look look;
  const auto before = look.layers;
  for (std::size_t i = 0; i < kLayers; ++i) {
    EXPECT_EQ(obey(std::to_string(i + 1), look), Wish::nothing);
    EXPECT_NE(look.layers[i], before[i]);
  }
  EXPECT_EQ(look.layers, ~before);
}

TEST(Keys, TheSameKeyUndoesWhatItDid) {
  Look look;
  obey("h", look);
  obey(" ", look);
  EXPECT_TRUE(look.help);
  EXPECT_TRUE(look.frozen);
  obey("h", look);
  obey(" ", look);
  EXPECT_FALSE(look.help);
  EXPECT_FALSE(look.frozen);
}

TEST(Keys, WishesAreReturned) {
  Look look;
  EXPECT_EQ(obey("q", look), Wish::quit);
  EXPECT_EQ(obey("Escape", look), Wish::quit);
  EXPECT_EQ(obey("s", look), Wish::shot);
}

TEST(Keys, AllOthersDoNothing) {
  Look look;
  for (const auto* key : {"", "0", "7", "x", "11", "\xff"}) {
    EXPECT_EQ(obey(key, look), Wish::nothing);
    EXPECT_EQ(look.layers, default_layers());
    EXPECT_FALSE(look.help || look.frozen);
  }
}

}  // namespace
}  // namespace handcast::preview
