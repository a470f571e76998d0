// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/methods.hpp"

#include <array>

namespace handcast::chart {
namespace {

/// 21 landmarks have 42 degrees of freedom; registration adds 3 + 2 x 5.
const std::array kRungMethods{
    Method{"hold", "hold", kOurs, 0},           Method{"predict", "predict", kOurs, 0},
    Method{"shift", "shift", kOurs, 2},         Method{"similarity", "similarity", kOurs, 4},
    Method{"fingers", "per finger", kOurs, 14}, Method{"landmarks", "landmarks", kOurs, 42},
    Method{"register", "register", kOurs, 55},
};

const std::array kOthers{
    Method{"baseline", "baseline", kBaseline},
    Method{"paper", "paper as published", kPaper},
    Method{"paper_at_our_speed", "paper at our speed", kPaper},
    Method{"handcast", "handcast", kOurs},
    Method{"ideal", "ideal landmarks", kQuiet},
    Method{.variant = "handcast_network",
           .label = "with our network",
           .colour = kFast,
           .detects = true},
    Method{.variant = "mediapipe", .label = "with MediaPipe", .colour = kFast, .detects = true},
};

}  // namespace

std::span<const Method> rungs() { return kRungMethods; }

Method method_of(std::string_view variant) {
  for (const auto& method : kRungMethods)
    if (method.variant == variant) return method;
  for (const auto& method : kOthers)
    if (method.variant == variant) return method;
  return {std::string(variant), std::string(variant)};
}

}  // namespace handcast::chart
