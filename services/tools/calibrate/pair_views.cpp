// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

#include "calib/solve/board/board_finder.hpp"
#include "calib/solve/lens/auto_capture.hpp"
#include "calib/solve/lens/board_pose.hpp"
#include "calib/solve/pair/pair_off.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/board_watch.hpp"
#include "services/tools/calibrate/lens_step.hpp"
#include "services/tools/calibrate/pair_step.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::size_t kEnoughPairs = 15, kEnoughOfOnePlace = 5;
constexpr std::size_t kAlmost = 3;    ///< so few views are missing at the end
constexpr double kDepthRange = 1.25;  ///< farthest distance of the board to its nearest one
/// Images of a still board may be so far apart in time, and those of triggered cameras are not.
/// @{
constexpr std::int64_t kStill_ns = 50'000'000, kTriggered_ns = 1'000'000;
/// @}

using Frames = client::Stream<msg::CameraFrame>;

/// The image that was exposed nearest to a time; waits a little for one that was exposed then.
/// Errors: timeout (there is none within kStill_ns), those of the stream.
Result<ipc::Sample<msg::CameraFrame>> image_at(Frames& frames, std::int64_t time_ns) {
  const auto until = Deadline::in(std::chrono::nanoseconds(kStill_ns));
  for (;;) {
    auto nearest = frames.at(time_ns);
    if (!nearest && nearest.error().code != Errc::timeout) return nearest;
    const auto later_ns = nearest ? (*nearest)->header.origin_ns - time_ns : -2 * kStill_ns;
    const bool is_near = std::llabs(later_ns) <= kStill_ns;
    if (is_near && later_ns >= -kTriggered_ns) return nearest;
    const auto newer = frames.latest(until);
    if (newer) continue;
    if (newer.error().code != Errc::timeout) return tl::make_unexpected(newer.error());
    if (is_near) return nearest;
    return fail(Errc::timeout, "the second camera has no image of this time");
  }
}

/// Finds the board in both images of a time, and keeps what is wanted. One thread.
class PairViews {
 public:
  PairViews(Desk& desk, PairWanted wanted)
      : camera_(desk.draft.camera),
        second_camera_(*desk.draft.camera2),
        wanted_(wanted),
        board_(desk.options.board),
        second_board_(desk.options.board),
        capture_(camera_.width_px) {}

  /// Looks at an image of the first camera and at the one of the second camera that was taken with
  /// it. Errors: those of the stream.
  Result<void> look(const msg::CameraFrame& image, Frames& second_frames) {
    const auto time_ns = image.header.origin_ns;
    const auto other = image_at(second_frames, time_ns);
    if (!other && other.error().code != Errc::timeout) return tl::make_unexpected(other.error());
    if (!other) return {};
    auto first = board_.find(view_of(image));
    auto second = second_board_.find(view_of(**other));
    sees_first_ = first.has_value();
    sees_second_ = second.has_value();
    // Both must look each time.
    const bool is_still = first && first_.see(time_ns, *first),
               is_second_still = second && second_.see((*other)->header.origin_ns, *second);
    if (is_still && !second) note_missing(*first);
    if (!is_still || !is_second_still) return {};
    if (wanted_ == PairWanted::places && !capture_.take_still(*first)) return {};
    note_distance(*first);
    views_.push_back({std::move(*first), std::move(*second)});
    return {};
  }

  bool are_enough() const {
    if (wanted_ == PairWanted::one_place) return views_.size() >= kEnoughOfOnePlace;
    return views_.size() >= kEnoughPairs && is_deep();
  }
  double share() const {
    const auto enough = wanted_ == PairWanted::one_place ? kEnoughOfOnePlace : kEnoughPairs;
    return std::min(0.99, static_cast<double>(views_.size()) / static_cast<double>(enough));
  }
  std::string advice() const {
    if (!sees_first_ && !sees_second_)
      return board_.why_missing().empty() ? "Hold the board where both cameras see it, still"
                                          : board_.why_missing();
    if (!sees_first_) return "Only the second camera sees the board; hold it before the first, too";
    if (!sees_second_)
      return "Only the first camera sees the board; hold it before the second, too";
    if (wanted_ == PairWanted::one_place) return "Hold the board still";
    if (2 * views_.size() > kEnoughPairs && !is_deep())
      return views_.size() < kEnoughPairs
                 ? "Hold the board nearer, or farther away"
                 : "Almost done: hold the board nearer, or farther away than before";
    if (kEnoughPairs - views_.size() <= kAlmost)
      return fmt::format("Almost done: {} more {}, tilted to another side",
                         kEnoughPairs - views_.size(),
                         kEnoughPairs - views_.size() == 1 ? "place" : "places");
    return "Hold the board still at another place, tilted to another side";
  }
  PairSeen taken() && { return {std::move(views_), missing_}; }

 private:
  bool is_deep() const { return farthest_m_ >= kDepthRange * nearest_m_; }
  /// The first camera sees a still board, and the second one does not.
  void note_missing(const calib::BoardView& view) {
    if (calib::is_whole_in_second(view, camera_, second_camera_)) ++missing_;
  }
  void note_distance(const calib::BoardView& view) {
    const auto pose = calib::board_pose(camera_, view);
    if (!pose) return;
    nearest_m_ = std::min(nearest_m_, (*pose)[3].z);
    farthest_m_ = std::max(farthest_m_, (*pose)[3].z);
  }

  calib::CameraModel camera_;
  calib::SecondCamera second_camera_;
  PairWanted wanted_;
  BoardWatch board_;
  calib::BoardFinder second_board_;
  calib::AutoCapture capture_;
  calib::Stillness first_, second_;
  std::vector<calib::PairView> views_;
  int missing_ = 0;
  bool sees_first_ = false, sees_second_ = false;
  double nearest_m_ = std::numeric_limits<double>::max(), farthest_m_ = 0;
};

}  // namespace

Result<PairSeen> take_pair_views(Desk& desk, PairWanted wanted) {
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  auto second_frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera2.frames");
  if (!second_frames) return tl::make_unexpected(second_frames.error());
  PairViews views(desk, wanted);
  Progress progress(desk, "pair");
  while (!views.are_enough() && progress.goes_on()) {
    progress.show(views.share(), views.advice());
    const auto frame = progress.latest(*frames);
    if (!frame) continue;
    if (auto seen = views.look(**frame, *second_frames); !seen)
      return tl::make_unexpected(seen.error());
  }
  return progress.result().map([&] { return std::move(views).taken(); });
}

}  // namespace handcast::calibrate
