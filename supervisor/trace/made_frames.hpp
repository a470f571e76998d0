// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// The mark of `stage` in a frame; null where it has none.
const msg::StageMark* find_mark(const FrameRecord& frame, msg::Stage stage);

/// The mark that ends with the frame's light; with its presentation where no more is known; null
/// for what is not a projector's.
const msg::StageMark* find_light(const FrameRecord& frame);

/// The time from `origin_ns` to the end of `mark`. Empty if there is no origin before that.
std::optional<std::int64_t> age_of(std::int64_t origin_ns, const msg::StageMark& mark);

/// A projector frame and the records of its inputs, as indices into the snapshot's frames. An input
/// that is not in the snapshot is empty.
struct MadeFrame {
  std::size_t frame = 0;
  std::optional<std::size_t> image;      ///< the camera frame it shows
  std::optional<std::size_t> detection;  ///< the newest landmarks it knew
  std::optional<std::size_t> sample;     ///< the tracker's newest sample it knew
};

/// Every frame of the projector, in the order in which they were begun.
std::vector<MadeFrame> made_frames(const HistorySnapshot& history);

/// The records of one kind, by the time of their origin.
class Records {
 public:
  /// Those that have a mark of `stage`.
  Records(const HistorySnapshot& history, msg::Stage stage);
  /// The first with this origin, and with this number if one is given; empty if there is none.
  std::optional<std::size_t> of(std::int64_t origin_ns,
                                std::optional<std::uint64_t> frame_id = std::nullopt) const;

 private:
  struct Record {
    std::int64_t origin_ns;
    std::uint64_t frame_id;
    std::size_t index;
    auto operator<=>(const Record&) const = default;
  };
  std::vector<Record> sorted_;
};

}  // namespace handcast::supervisor
