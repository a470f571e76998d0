// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// The grey values of images.
class Greys {
 public:
  void add(std::span<const std::uint8_t> pixels);
  bool empty() const { return count_ == 0; }
  /// The grey value that a share of the pixels does not exceed.
  int percentile(double share) const;
  /// The share of pixels of at least this grey value.
  double share_from(int grey) const;

 private:
  std::array<std::uint64_t, 256> histogram_{};
  std::uint64_t count_ = 0;
};

/// Judges exposure, background and light. `has_hand`: a hand was seen, so the brightest pixels
/// should be its.
std::vector<Finding> judge_images(const Greys& greys, bool has_hand);

}  // namespace handcast::doctor
