// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/board_watch.hpp"

#include <chrono>

#include "calib/solve/board/missing.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::int64_t kPatience_ns = 4'000'000'000;

calib::GreyPicture copy_of(calib::GreyView view) {
  calib::GreyPicture picture{view.width_px, view.height_px, {}};
  for (int y = 0; y < view.height_px; ++y) {
    const auto* row = view.pixels + y * view.stride;
    picture.pixels.insert(picture.pixels.end(), row, row + view.width_px);
  }
  return picture;
}

}  // namespace

BoardWatch::BoardWatch(const calib::Board& board)
    : board_(board), finder_(board), quiet_since_ns_(now_ns()) {}

std::optional<calib::BoardView> BoardWatch::find(calib::GreyView image) {
  auto seen = finder_.find(image);
  if (search_.valid() && search_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    why_ = search_.get();
    quiet_since_ns_ = now_ns();
  }
  if (seen) {
    why_.clear();
    quiet_since_ns_ = now_ns();
  } else if (!search_.valid() && now_ns() - quiet_since_ns_ > kPatience_ns) {
    search_ = std::async(std::launch::async, [board = board_, picture = copy_of(image)] {
      return calib::why_missing(board, picture.view());
    });
  }
  return seen;
}

}  // namespace handcast::calibrate
