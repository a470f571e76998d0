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

/// How old the frame's origin was when `mark` ended; empty where the frame has no origin before
/// that.
std::optional<std::int64_t> age_of(const FrameRecord& frame, const msg::StageMark& mark);

/// A projector frame and what it was made of, as indices into the snapshot's frames; empty: not in
/// the snapshot.
struct MadeFrame {
  std::size_t frame = 0;
  std::optional<std::size_t> image;      ///< the camera frame it showed
  std::optional<std::size_t> detection;  ///< the newest that was done when it was begun
  std::optional<std::size_t> sample;     ///< the tracker's, likewise
};

/// Every frame of the projector, in the order in which they were begun. Marks say which image a
/// frame used; that it used the newest detection and sample there were is how the projector works
/// (services/projector/inputs.cpp).
std::vector<MadeFrame> made_frames(const HistorySnapshot& history);

/// The camera frame each of the others was derived from, by its id and origin.
class Images {
 public:
  explicit Images(const HistorySnapshot& history);
  std::optional<std::size_t> of(const msg::Header& derived) const;

 private:
  struct Image {
    std::int64_t origin_ns;
    std::uint64_t frame_id;
    std::size_t index;
    auto operator<=>(const Image&) const = default;
  };
  std::vector<Image> sorted_;
};

}  // namespace handcast::supervisor
