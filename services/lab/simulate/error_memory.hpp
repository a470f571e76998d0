// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "ipc/msg/landmarks.hpp"

namespace handcast::simulate {

/// How long the errors of a detector last: the autocorrelation of the error of each landmark, about
/// zero, over all landmarks: sum e(t) e(t + d) / sum (|e(t)|^2 + |e(t + d)|^2) / 2. White noise has
/// 0, a constant error 1.
class ErrorMemory {
 public:
  /// The error of each landmark of one hand in px; NaN if it was not seen.
  using Errors = std::array<glm::vec2, msg::kLandmarks>;

  /// Adds the errors of a frame of `time_ns`. Times must ascend per side.
  void add(msg::Side side, std::int64_t time_ns, const Errors& errors);

  /// {"50": 0.9, ...}: by delay in ms (50, 100, 200, 400); null if there are no such pairs.
  nlohmann::json to_json() const;

 private:
  struct Entry {
    std::int64_t time_ns;
    Errors errors;
  };
  std::array<std::vector<Entry>, 2> entries_;
};

}  // namespace handcast::simulate
