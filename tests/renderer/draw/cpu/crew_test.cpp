// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/crew.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>

namespace handcast::renderer::cpu {
namespace {

TEST(Crew, EveryPartIsDoneOnceAndTheTaskIsOver) {
  Crew crew(3);
  ASSERT_EQ(crew.size(), 4);
  std::vector<int> done;  // no atomics: run() orders all writes before its return
  std::array<int, 4> busy{};
  for (int round = 0; round < 3000; ++round) {
    const int parts = round % 40;
    done.assign(static_cast<std::size_t>(parts), 0);
    auto part = [&](int index, int worker) {
      ++busy[static_cast<std::size_t>(worker)];
      ++done[static_cast<std::size_t>(index)];
      --busy[static_cast<std::size_t>(worker)];
    };
    if (round % 3 == 0) crew.rouse();
    crew.run(parts, part);
    ASSERT_EQ(done, std::vector<int>(static_cast<std::size_t>(parts), 1)) << round;
    ASSERT_EQ(busy, (std::array<int, 4>{}));
  }
}

TEST(Crew, HelpersTakeParts) {
  Crew crew(1);
  std::atomic<int> helped{0};
  auto part = [&](int, int worker) {
    if (worker == 1) ++helped;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  };
  for (int round = 0; round < 1000 && helped == 0; ++round) {
    crew.rouse();
    crew.run(8, part);
  }
  EXPECT_GT(helped, 0);
}

TEST(Crew, AloneItDoesAllItself) {
  Crew crew(0);
  int done = 0;
  auto part = [&](int, int worker) { done += worker == 0; };
  crew.rouse();
  crew.run(5, part);
  EXPECT_EQ(done, 5);
}

TEST(Crew, AHelperThatSleepsIsNotWaitedFor) {
  Crew crew(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));  // nobody roused it
  int done = 0;
  auto part = [&](int, int worker) { done += worker == 0; };
  crew.run(9, part);
  EXPECT_EQ(done, 9);
}

}  // namespace
}  // namespace handcast::renderer::cpu
