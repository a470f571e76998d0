// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include <vector>

#include "tests/bench/goals.hpp"
#include "tests/bench/rings_measure.hpp"

namespace handcast::bench {

/// Every transport with messages of one size.
struct Table {
  std::size_t bytes = 0;
  std::vector<Row> rows;

  const Row& row(std::string_view name) const;
};

Table table_of_poses();   ///< 2 KiB
Table table_of_images();  ///< 388,800 B: 720 x 540
void print(const Table& table);

std::vector<Goal> goals_of(const Table& poses, const Table& images);

}  // namespace handcast::bench
