// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/screen_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "calib/solve/lens/board_pose.hpp"
#include "calib/solve/screen/gray_code.hpp"

namespace handcast::calibrate {
namespace {

constexpr int kTries = 3;        ///< of a pattern
constexpr double kMoved_px = 1;  ///< by which the board may have moved during the patterns

/// The largest move of a point that both views have; infinite if they share none.
double largest_move_px(const calib::BoardView& a, const calib::BoardView& b) {
  double largest = -1;
  for (std::size_t i = 0; i < a.ids.size(); ++i)
    for (std::size_t j = 0; j < b.ids.size(); ++j)
      if (a.ids[i] == b.ids[j])
        largest = std::max(largest, glm::distance(a.image_px[i], b.image_px[j]));
  return largest < 0 ? std::numeric_limits<double>::infinity() : largest;
}

}  // namespace

ScreenViews::ScreenViews(Desk& desk, client::Stream<msg::CameraFrame> frames,
                         PatternImages& patterns)
    : desk_(desk),
      frames_(std::move(frames)),
      patterns_(patterns),
      board_(desk.options.board),
      code_(desk.screen.width_px(), desk.screen.height_px()),
      capture_(desk.used.camera.width_px),
      seen_(desk.used.camera.width_px, desk.used.camera.height_px) {}

Result<std::vector<calib::DepthView>> ScreenViews::take(std::size_t wanted) {
  std::vector<calib::DepthView> views;
  progress_.emplace(desk_, "screen");
  of_each_ = 1 / static_cast<double>(wanted);
  std::string advice = "Hold the board still in the light";
  std::string failed = "the board was never still in the projector's light";
  while (views.size() < wanted && progress_->goes_on()) {
    begun_ = of_each_ * static_cast<double>(views.size());
    progress_->show(begun_, board_.why_missing().empty() ? advice : board_.why_missing());
    if (!is_ready()) continue;
    auto view = measure_twice();
    if (!view && view.error().code != Errc::bad_data) return tl::make_unexpected(view.error());
    if (!view) {
      advice = failed = view.error().what;
      continue;
    }
    for (const auto& point : view->points) seen_.add(point.camera_px);
    views.push_back(std::move(*view));
    advice = fmt::format(
        "Now hold it nearer or farther, tilted, and more to the {} of the camera's image",
        seen_.emptiest());
  }
  const auto done = progress_->result();
  progress_.reset();
  if (!done) return tl::make_unexpected(done.error());
  if (!views.empty()) return views;
  return fail(Errc::bad_data, board_.why_missing().empty() ? failed : board_.why_missing());
}

/// All patterns once more if they could not be read.
Result<calib::DepthView> ScreenViews::measure_twice() {
  auto view = measure();
  if (view || view.error().code != Errc::bad_data) return view;
  progress_->note(fmt::format("{}; all patterns are shown again", view.error().what));
  return measure();
}

/// True if the next image has the board, still and at a new place.
bool ScreenViews::is_ready() {
  const auto frame = progress_->latest(frames_);
  const auto board = frame ? board_.find(calibrate::view_of(**frame)) : std::nullopt;
  return board && capture_.take((*frame)->header.origin_ns, *board);
}

calib::GreyView ScreenViews::view_of(const PatternImages::Image& image) const {
  const auto& camera = desk_.draft.camera;
  return {image.data(), camera.width_px, camera.height_px, camera.width_px};
}

/// Tells why a pattern is shown again.
void ScreenViews::repeat(int pattern, const std::string& why) {
  ++repeated_;
  why_repeated_ = fmt::format("pattern {} of {}: {}", pattern + 1, code_.patterns(), why);
  progress_->note(why_repeated_ + "; it is shown again");
}

/// While the projector shows patterns, and no text.
void ScreenViews::say_pattern(int pattern) {
  const double shown = static_cast<double>(pattern) / code_.patterns();
  progress_->say(begun_ + of_each_ * shown, "Hold still while the patterns are shown");
}

/// Shows a pattern, several times if its image does not come.
Result<PatternImages::Image> ScreenViews::shoot_one(int pattern) {
  for (int tries = 1;; ++tries) {
    auto image = patterns_.image([&](std::uint8_t* levels) { code_.draw(pattern, levels); });
    if (image || image.error().code != Errc::timeout || tries == kTries) return image;
    repeat(pattern, "no image of it came within 2 s");
  }
}

/// Shows a pattern and its inverse, several times if they do not fit to white and black. Error
/// bad_data: they never do.
Result<void> ScreenViews::shoot_pair(int pattern, std::vector<PatternImages::Image>& images) {
  for (int tries = 1;; ++tries) {
    auto image = shoot_one(pattern);
    if (!image) return tl::make_unexpected(image.error());
    auto inverse = shoot_one(pattern + 1);
    if (!inverse) return tl::make_unexpected(inverse.error());
    const double misfit = calib::pattern_misfit(view_of(images[0]), view_of(images[1]),
                                                view_of(*image), view_of(*inverse));
    if (misfit <= calib::kMostPatternMisfit) {
      images.push_back(std::move(*image));
      images.push_back(std::move(*inverse));
      return {};
    }
    if (tries == kTries)
      return fail(Errc::bad_data,
                  fmt::format("Pattern {} of {} did not come out in {} tries: the board moved, or "
                              "the light flickers; hold it still",
                              pattern + 1, code_.patterns(), kTries));
    repeat(pattern,
           fmt::format("the board moved, or the light flickers (off by {:.1f} times the light, at "
                       "most {:.1f})",
                       misfit, calib::kMostPatternMisfit));
  }
}

/// Shows all patterns, and then the first one, white, again.
Result<std::vector<PatternImages::Image>> ScreenViews::shoot() {
  std::vector<PatternImages::Image> images;
  for (const int pattern : {0, 1}) {  // white, black
    auto image = shoot_one(pattern);
    if (!image) return tl::make_unexpected(image.error());
    images.push_back(std::move(*image));
  }
  for (int pattern = 2; pattern < code_.patterns(); pattern += 2) {
    say_pattern(pattern);
    if (auto pair = shoot_pair(pattern, images); !pair) return tl::make_unexpected(pair.error());
  }
  auto image = shoot_one(0);
  if (!image) return tl::make_unexpected(image.error());
  images.push_back(std::move(*image));
  return images;
}

/// Error bad_data: the board is not at the same place in both white images, or the patterns cannot
/// be read.
Result<calib::DepthView> ScreenViews::measure() {
  auto shot = shoot();
  if (!shot) return tl::make_unexpected(shot.error());
  auto& images = *shot;
  const auto& camera = desk_.draft.camera;
  const auto before = board_.find(view_of(images.front())),
             after = board_.find(view_of(images.back()));
  if (!before || !after) return fail(Errc::bad_data, "The whole board must be in the light");
  if (!(largest_move_px(*before, *after) < kMoved_px))
    return fail(Errc::bad_data, "The board moved: hold it still");
  const auto pose = calib::board_pose(camera, *before);
  if (!pose) return fail(Errc::bad_data, "The board is not flat, or the lens is wrong");
  images.pop_back();
  darken_beside(*pose, images);
  std::vector<calib::GreyView> views;
  views.reserve(images.size());
  for (const auto& image : images) views.push_back(view_of(image));
  auto decoded = code_.decode(views);
  if (!decoded) return tl::make_unexpected(decoded.error());
  light_.contrast = std::max(light_.contrast, decoded->contrast);
  light_.saturated_share = std::max(light_.saturated_share, decoded->saturated_share);
  const glm::dvec3 normal((*pose)[2]), origin((*pose)[3]);
  return calib::DepthView{std::move(decoded->points),
                          glm::dvec4(normal, -glm::dot(normal, origin))};
}

/// Sets the pixels beside the board to 0 in all images: what is behind it is lit, too.
void ScreenViews::darken_beside(const glm::dmat4& camera_from_board,
                                std::vector<PatternImages::Image>& images) const {
  const auto& camera = desk_.draft.camera;
  const auto& board = desk_.options.board;
  const glm::dvec2 size_m(1e-3 * board.square_mm * board.columns,
                          1e-3 * board.square_mm * board.rows);
  // The homography from undistorted camera pixels to the board's plane, metres.
  const auto board_from_camera =
      glm::inverse(camera.matrix() * glm::dmat3(glm::dvec3(camera_from_board[0]),
                                                glm::dvec3(camera_from_board[1]),
                                                glm::dvec3(camera_from_board[3])));
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const auto at = board_from_camera * glm::dvec3(camera.undistort({x, y}), 1);
      const glm::dvec2 at_m = glm::dvec2(at) / at.z;
      if (glm::all(glm::greaterThan(at_m, glm::dvec2(0))) && glm::all(glm::lessThan(at_m, size_m)))
        continue;
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
                     static_cast<std::size_t>(x);
      for (auto& image : images) image[i] = 0;
    }
}

}  // namespace handcast::calibrate
