// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/recent.hpp"

#include <gmock/gmock.h>

namespace handcast::renderer {
namespace {

using testing::ElementsAre;

TEST(Recent, TheOldestLeaveAndTheNewestComeInOnePieceOfMemory) {
  Recent<int> recent(3);
  const int* memory = recent.begin();
  for (int value = 0; value < 100; ++value) {
    recent.push_back(value);
    if (recent.size() > 3) recent.pop_front();
    EXPECT_EQ(recent.back(), value);
    EXPECT_EQ(recent.front(), std::max(0, value - 2));
    EXPECT_LT(recent.end() - memory, 7);
  }
  EXPECT_THAT(recent, ElementsAre(97, 98, 99));
  EXPECT_EQ(*recent.rbegin(), 99);
}

TEST(Recent, ALateValueIsInsertedAtItsPlace) {
  Recent<int> recent(4);
  for (const int value : {1, 2, 4}) recent.push_back(value);
  recent.insert(std::lower_bound(recent.begin(), recent.end(), 3), 3);
  recent.insert(recent.begin(), 0);
  EXPECT_THAT(recent, ElementsAre(0, 1, 2, 3, 4));
  recent.pop_back();
  recent.clear();
  EXPECT_TRUE(recent.empty());
}

TEST(Recent, MoreThanExpectedAreKept) {
  Recent<int> recent(2);
  for (int value = 0; value < 9; ++value) recent.push_back(value);
  recent.insert(recent.begin() + 1, 77);
  EXPECT_THAT(recent, ElementsAre(0, 77, 1, 2, 3, 4, 5, 6, 7, 8));
}

}  // namespace
}  // namespace handcast::renderer
