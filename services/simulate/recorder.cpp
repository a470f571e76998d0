#include "services/simulate/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "services/simulate/png.hpp"

namespace handcast::simulate {
namespace {

constexpr const char* kSides[] = {"left", "right"};
constexpr std::size_t kColumns = 3;  ///< of a landmark: x, y, sigma (px)
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

/// The most hands that any of the messages saw.
template <class Kept, class CountOf>
std::uint32_t most_hands(const std::vector<Kept>& kept, const CountOf& count_of) {
  std::uint32_t most = 0;
  for (const auto& each : kept) most = std::max<std::uint32_t>(most, count_of(each));
  return most;
}

}  // namespace

RecordingFeed::RecordingFeed(std::unique_ptr<SensorFeed> source, std::filesystem::path folder)
    : source_(std::move(source)), folder_(std::move(folder)) {
  std::error_code ignored;
  std::filesystem::create_directories(folder_ / "camera", ignored);
}

std::vector<SensorEvent> RecordingFeed::until(std::int64_t now_ns) {
  auto events = source_->until(now_ns);
  for (const auto& event : events) std::visit([this](const auto& message) { keep(message); }, event.message);
  return events;
}

void RecordingFeed::keep(const msg::HandPoses& poses) { poses_.push_back(poses); }

void RecordingFeed::image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) {
  source_->image(exposure, pixels);
  const auto file = folder_ / "camera" / fmt::format("{:06}.png", image_times_us_.size());
  if (auto written = write_png(file, pixels); !written && pictures_) pictures_ = std::move(written);
  image_times_us_.push_back(exposure.origin_ns / 1000);
}

Result<void> RecordingFeed::save() const {
  if (!pictures_) return pictures_;
  twin::Recording recording;
  const auto hands = most_hands(poses_, [](const auto& poses) { return poses.count; });
  for (const auto& poses : poses_) {
    // A recording holds the same hands in every sample: those without all of them are left out.
    if (poses.count == 0 || poses.count != hands) continue;
    recording.time_ns.push_back(poses.header.origin_ns);
    for (std::uint32_t i = 0; i < poses.count; ++i)
      recording.hands[static_cast<std::size_t>(poses.hands[i].side)].push_back(poses.hands[i]);
  }
  if (recording.time_ns.empty()) return fail(Errc::bad_data, fmt::format("{}: no hand was seen, nothing to record", folder_.string()));
  if (auto saved = twin::write_recording(folder_, recording); !saved) return saved;
  if (auto saved = twin::write_npy_i64(folder_ / "camera_timestamps.npy", image_times_us_); !saved) return saved;
  return save_landmarks();
}

Result<void> RecordingFeed::save_landmarks() const {
  std::vector<std::int64_t> times_us;
  std::array<std::vector<float>, 2> points;
  const auto hands = most_hands(landmarks_, [](const auto& seen) { return seen.landmarks.count; });
  for (const auto& seen : landmarks_) {
    if (seen.landmarks.count == 0 || seen.landmarks.count != hands) continue;
    times_us.push_back(seen.origin_ns / 1000);
    for (std::uint32_t i = 0; i < seen.landmarks.count; ++i)
      for (const auto& point : seen.landmarks.hands[i].points) {
        auto& side = points[static_cast<std::size_t>(seen.landmarks.hands[i].side)];
        const bool was_seen = point.confidence > 0;
        side.insert(side.end(), {was_seen ? point.x_px : kUnseen, was_seen ? point.y_px : kUnseen, point.sigma_px});
      }
  }
  for (std::size_t side = 0; side < points.size(); ++side) {
    if (points[side].empty()) continue;
    const auto file = folder_ / fmt::format("landmarks_{}.npy", kSides[side]);
    if (auto saved =
            twin::write_npy_f32(file, {points[side].size() / (kColumns * msg::kLandmarks), msg::kLandmarks, kColumns}, points[side]);
        !saved)
      return saved;
  }
  return twin::write_npy_i64(folder_ / "landmarks_timestamps.npy", times_us);
}

}  // namespace handcast::simulate
