// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "services/lab/simulate/sensor_feed.hpp"

namespace handcast::simulate {

/// Passes on the messages of another feed and counts the detections that hold a hand.
class CountingFeed final : public SensorFeed {
 public:
  /// Takes over the feed to be counted.
  explicit CountingFeed(std::unique_ptr<SensorFeed> source) : source_(std::move(source)) {}

  std::vector<SensorEvent> until(std::int64_t now_ns) override {
    auto events = source_->until(now_ns);
    detections_ += static_cast<int>(std::ranges::count_if(events, [](const SensorEvent& event) {
      const auto* landmarks = std::get_if<msg::Landmarks>(&event.message);
      return landmarks && landmarks->count > 0;
    }));
    return events;
  }
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    return source_->newest_exposure(now_ns);
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override {
    source_->image(exposure, pixels);
  }

  /// Detections with at least one hand so far.
  int detections() const { return detections_; }

 private:
  std::unique_ptr<SensorFeed> source_;
  int detections_ = 0;
};

}  // namespace handcast::simulate
