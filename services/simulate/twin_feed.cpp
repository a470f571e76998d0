#include <algorithm>

#include "services/simulate/sensor_feed.hpp"

namespace handcast::simulate {
namespace {

/// The detector takes the newest frame whenever it is free, and sleeps until there is a newer one.
class BackToBackDetector {
 public:
  explicit BackToBackDetector(const twin::Twin& twin) : twin_(twin) {}

  /// Runs that are done by `now_ns`.
  void until(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    while (true) {
      const auto frame = next_frame();
      const auto detection = twin_.detect(runs_, frame, twin_.camera_origin_ns(frame));
      const auto done_ns = std::max(twin_.camera_origin_ns(frame) + detection.age_ns, twin_.camera_arrival_ns(frame));
      if (done_ns > now_ns) return;
      events.push_back({done_ns, detection.landmarks});
      last_frame_ = static_cast<std::int64_t>(frame);
      free_ns_ = done_ns;
      ++runs_;
    }
  }

 private:
  std::uint64_t next_frame() const {
    auto frame = static_cast<std::uint64_t>(last_frame_ + 1);
    while (twin_.camera_arrival_ns(frame + 1) <= free_ns_) ++frame;
    return frame;
  }

  const twin::Twin& twin_;
  std::uint64_t runs_ = 0;
  std::int64_t last_frame_ = -1;
  std::int64_t free_ns_ = 0;
};

class TwinFeed : public SensorFeed {
 public:
  explicit TwinFeed(const twin::Twin& twin) : twin_(twin), detector_(twin) {}

  std::vector<SensorEvent> until(std::int64_t now_ns) override {
    std::vector<SensorEvent> events;
    take_tracker_samples(now_ns, events);
    detector_.until(now_ns, events);
    std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.arrival_ns < b.arrival_ns; });
    return events;
  }

  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    while (twin_.camera_arrival_ns(next_frame_) <= now_ns) ++next_frame_;
    if (next_frame_ == 0) return std::nullopt;
    return Exposure{next_frame_ - 1, twin_.camera_origin_ns(next_frame_ - 1)};
  }

  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override { twin_.camera_image(exposure.frame_id, pixels); }

 private:
  /// Samples may overtake one another: every sample taken before `now_ns` that has not arrived stays pending.
  void take_tracker_samples(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    for (; twin_.tracker_time_ns(next_sample_) <= now_ns; ++next_sample_) pending_.push_back(twin_.tracker_sample(next_sample_));
    std::erase_if(pending_, [&](const twin::Twin::TrackerSample& sample) {
      if (sample.arrival_ns > now_ns) return false;
      if (sample.poses.count > 0) events.push_back({sample.arrival_ns, sample.poses});
      return true;
    });
  }

  const twin::Twin& twin_;
  BackToBackDetector detector_;
  std::vector<twin::Twin::TrackerSample> pending_;
  std::uint64_t next_sample_ = 0;
  std::uint64_t next_frame_ = 0;
};

}  // namespace

std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin) { return std::make_unique<TwinFeed>(twin); }

}  // namespace handcast::simulate
