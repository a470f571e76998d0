// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace handcast::study {

/// The order in which a subject meets the conditions: a row of a balanced Latin square (Williams
/// 1949), in which each condition comes once in each place and, over all rows, equally often behind
/// each other one. An odd number of conditions takes two squares, of which the second is the
/// mirrored first. `subject`: from 0. Values are 0 .. conditions - 1.
inline std::vector<std::size_t> latin_order(std::size_t subject, std::size_t conditions) {
  std::vector<std::size_t> order(conditions);
  const std::size_t row = subject % conditions;
  const bool mirrored = conditions % 2 == 1 && subject / conditions % 2 == 1;
  for (std::size_t place = 0; place < conditions; ++place) {
    const std::size_t first = place % 2 == 0 ? place / 2 : conditions - (place + 1) / 2;
    order[mirrored ? conditions - 1 - place : place] = (first + row) % conditions;
  }
  return order;
}

}  // namespace handcast::study
