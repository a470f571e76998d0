// SPDX-License-Identifier: Apache-2.0
#include "services/recording/playback.hpp"

#include <array>
#include <functional>
#include <numeric>
#include <utility>

#include "services/recording/about.hpp"

namespace handcast::recording {
namespace {

constexpr std::string_view kCamera = "camera.frames";
/// The streams that are played.
constexpr std::array kSensors{kCamera, std::string_view("pose.hands"),
                              std::string_view("landmarks.hands")};

/// The time from the first to the last message of all sensors, and the numbers that images take.
struct Whole {
  timing::Lap lap;
  std::uint64_t ids = 0;
};

bool increase(const std::vector<std::uint64_t>& ids) {
  return std::ranges::adjacent_find(ids, std::greater_equal<>{}) == ids.end();
}

std::vector<std::uint64_t> ids_of(const StreamReader& reader) {
  std::vector<std::uint64_t> ids;
  for (const auto& row : reader.rows()) ids.push_back(row.frame_id);
  return ids;
}

std::vector<std::int64_t> times_of(const StreamReader& reader) {
  std::vector<std::int64_t> times_ns;
  for (const auto& row : reader.rows()) times_ns.push_back(row.published_ns);
  return times_ns;
}

/// How many numbers a lap uses: those of all images, if there are any.
std::uint64_t numbers_of(const std::vector<std::uint64_t>& ids) {
  return ids.empty() || !increase(ids) ? ids.size() : ids.back() - ids.front() + 1;
}

Result<Whole> whole_of(const std::filesystem::path& folder) {
  const auto about = read_about(folder);
  if (!about) return tl::make_unexpected(about.error());
  Whole whole;
  for (const auto sensor : kSensors) {
    if (!about->layouts.contains(std::string(sensor))) continue;
    const auto reader = StreamReader::open(folder, sensor);
    if (!reader) return tl::make_unexpected(reader.error());
    whole.lap.add(times_of(*reader), timing::kLoneStep_ns);
    if (sensor == kCamera) whole.ids = numbers_of(ids_of(*reader));
  }
  return whole;
}

}  // namespace

Result<Schedule> Schedule::make(const std::filesystem::path& folder, const StreamReader& reader,
                                std::int64_t epoch_ns, bool repeat) {
  const auto whole = whole_of(folder);
  if (!whole) return tl::make_unexpected(whole.error());
  auto loop =
      timing::Loop::make(times_of(reader), whole->lap, epoch_ns, repeat, timing::kLoneStep_ns);
  if (!loop) return fail_in(folder.string(), loop.error());
  std::vector<std::int64_t> delays_ns;
  for (const auto& row : reader.rows()) delays_ns.push_back(row.published_ns - row.origin_ns);
  auto ids = ids_of(reader);
  const auto ids_of_a_lap = std::max(whole->ids, numbers_of(ids));
  if (!increase(ids)) std::iota(ids.begin(), ids.end(), 0);
  return Schedule(std::move(*loop), std::move(delays_ns), std::move(ids), ids_of_a_lap);
}

std::optional<Schedule::Item> Schedule::at_or_after(std::int64_t time_ns) const {
  const auto item = loop_.at_or_after(time_ns);
  if (!item) return std::nullopt;
  const auto lap = item->number / delays_ns_.size();
  return Item{item->index, item->number, item->due_ns, item->due_ns - delays_ns_[item->index],
              ids_[item->index] + lap * ids_of_a_lap_};
}

}  // namespace handcast::recording
