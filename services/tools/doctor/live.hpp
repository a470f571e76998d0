// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
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

/// Whether a ring of the supervisor's status holds its rate. `setting`: the path of the rate.
Finding judge_rate(const nlohmann::json& ring, const std::string& check,
                   const std::string& setting);

/// Watches a rig that is up for some seconds: services, rates, clocks, losses, images, hands,
/// light. Errors: those of client::open_stream() for its camera, and unavailable (its status cannot
/// be read).
Result<std::vector<Finding>> examine_live(const std::string& rig, double seconds);

}  // namespace handcast::doctor
