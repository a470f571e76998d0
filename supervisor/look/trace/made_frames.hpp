// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// The mark of `stage` in a frame, inside `frame`; null if it has none.
const msg::StageMark* find_mark(const FrameRecord& frame, msg::Stage stage);

/// The mark that ends at the light of a projector frame, or at its presentation if the time of the
/// light is unknown. Null for other frames.
const msg::StageMark* find_light(const FrameRecord& frame);

/// The time from `origin_ns` to the end of `mark`; empty if the origin is 0 or later than that.
std::optional<std::int64_t> age_of(std::int64_t origin_ns, const msg::StageMark& mark);

/// A projector frame and its inputs (msg::MadeFrom), as indices into HistorySnapshot::frames. An
/// input that is not in the snapshot is empty.
struct MadeFrame {
  std::size_t frame = 0;                 ///< the projector frame
  std::optional<std::size_t> image;      ///< the camera frame that it was made from
  std::optional<std::size_t> detection;  ///< the landmarks that it was made from
  std::optional<std::size_t> sample;     ///< the tracker sample that it was made from
};

/// All projector frames in the order of their begin.
std::vector<MadeFrame> made_frames(const HistorySnapshot& history);

/// Finds frames of one kind by the time of their origin.
class Records {
 public:
  /// Uses the frames that have a mark of `stage`.
  Records(const HistorySnapshot& history, msg::Stage stage);
  /// The index of the first frame with this origin and, if given, this number; empty if there is
  /// none.
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
