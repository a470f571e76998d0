// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// Says whether a board has been still for a while. One thread.
class Stillness {
 public:
  /// Looks at the views of successive images. `time_ns`: when the image was exposed, by any one
  /// clock.
  bool see(std::int64_t time_ns, const BoardView& view);

 private:
  BoardView rest_;  ///< where the board came to rest, perhaps
  std::int64_t rest_ns_ = 0, last_ns_ = 0;
};

/// Says when a view is worth taking without anybody pressing a key: the board has been still, and
/// it is not where it was in any view taken before. One thread.
class AutoCapture {
 public:
  explicit AutoCapture(int width_px) : width_px_(width_px) {}

  /// Looks at the views of successive images; true if this one should be taken. `time_ns`: when the
  /// image was exposed, by any one clock.
  bool take(std::int64_t time_ns, const BoardView& view) {
    return stillness_.see(time_ns, view) && take_still(view);
  }
  /// The same for a view of a board that is known to be still.
  bool take_still(const BoardView& view);

 private:
  bool is_new(const BoardView& view) const;

  struct Taken {
    BoardView view;
    std::optional<glm::dvec2> tilt;
  };

  int width_px_;
  Stillness stillness_;
  std::vector<Taken> taken_;
};

}  // namespace handcast::calib
