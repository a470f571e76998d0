// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "services/recording/recording_reader.hpp"
#include "services/runtime/loop.hpp"

namespace handcast::recording {

/// When the messages of a stream are due again: each as long after the first message of the
/// recording's sensors as it was published then, counted from the start of the rig. So all sensors
/// of a rig are at the same place of the recording, also after a restart. One thread.
class Schedule {
 public:
  /// A message to be played.
  struct Item {
    std::size_t index = 0;       ///< in StreamReader::rows()
    std::uint64_t number = 0;    ///< counted over all laps
    std::int64_t due_ns = 0;     ///< when it is to be published
    std::int64_t origin_ns = 0;  ///< when its sensor saw the world, as long before as it was then
    std::uint64_t frame_id = 0;  ///< as recorded in the first lap; they go on from lap to lap
  };

  /// One for items that are published the moment they were taken, and numbered from 0 on.
  Schedule(timing::Loop loop, std::size_t count)
      : loop_(std::move(loop)), delays_ns_(count), ids_of_a_lap_(count) {
    for (std::size_t i = 0; i < count; ++i) ids_.push_back(i);
  }
  /// The schedule of `reader`, a stream of `folder`. Errors: bad_data and bad_config as for
  /// StreamReader, and if the stream is empty.
  static Result<Schedule> make(const std::filesystem::path& folder, const StreamReader& reader,
                               std::int64_t epoch_ns, bool repeat);

  /// The first item that is due at `time_ns` or later; empty if the recording is over.
  std::optional<Item> at_or_after(std::int64_t time_ns) const;
  /// Number of messages.
  std::size_t count() const { return delays_ns_.size(); }

 private:
  Schedule(timing::Loop loop, std::vector<std::int64_t> delays_ns, std::vector<std::uint64_t> ids,
           std::uint64_t ids_of_a_lap)
      : loop_(std::move(loop)),
        delays_ns_(std::move(delays_ns)),
        ids_(std::move(ids)),
        ids_of_a_lap_(ids_of_a_lap) {}

  timing::Loop loop_;
  std::vector<std::int64_t> delays_ns_;  ///< from origin to publication
  std::vector<std::uint64_t> ids_;       ///< of the first lap
  std::uint64_t ids_of_a_lap_;           ///< the same for all streams that number images
};

}  // namespace handcast::recording
