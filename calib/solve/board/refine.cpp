// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "calib/solve/board/find.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

/// Half the window in which a corner is refined, as a share of the distance to the next corner. A
/// marker begins at 1/8.
/// @{
constexpr double kWindow = 0.3, kWindowBesideMarker = 0.12;
/// @}
constexpr int kLeastWindow_px = 2, kLargestWindow_px = 16;
constexpr std::size_t kFewestPoints = 6;
/// Points farther from the others' homography are mistakes, in squares. A lens bends less.
constexpr double kMistake = 0.5;
/// If a smaller share of the points agrees, they are those of another board.
constexpr double kLeastAgreeing = 0.6;
/// How far a corner may be from where its neighbours place it, as a share of the distance to them.
constexpr double kOutOfLine = 0.1;
/// How far from a corner the four squares are looked at, in squares: before a marker begins. A
/// corner of which less than this share of the usual contrast is seen is covered by something.
/// @{
constexpr float kLook = 0.08F;
constexpr double kLeastContrast = 0.3;
/// @}
/// Standard deviation of the points across the line that fits them best, in squares: 0 for one
/// line, 0.5 for two. One point beside a line is not enough for a homography.
constexpr double kLeastWidth = 0.4;

int columns_of(const Board& board) {
  return board.columns - (board.kind == BoardKind::circles ? 0 : 1);
}

double nearest_px(const std::vector<Found>& corners, cv::Point2f corner) {
  double nearest_px = std::numeric_limits<double>::infinity();
  for (const auto& other : corners)
    if (const double px = cv::norm(other.image_px - corner); px > 0)
      nearest_px = std::min(nearest_px, px);
  return nearest_px;
}

std::vector<cv::Point2f> in_squares(const Board& board, const std::vector<Found>& found) {
  const int columns = columns_of(board);
  std::vector<cv::Point2f> points;
  points.reserve(found.size());
  for (const auto& point : found) {
    const int column = point.id % columns, row = point.id / columns;
    points.emplace_back(column, row);
  }
  return points;
}

std::vector<cv::Point2f> in_image(const std::vector<Found>& found) {
  std::vector<cv::Point2f> points_px(found.size());
  std::ranges::transform(found, points_px.begin(), &Found::image_px);
  return points_px;
}

bool is_wide(const std::vector<cv::Point2f>& points) {
  cv::Mat mean, covariance, widths;
  cv::calcCovarMatrix(cv::Mat(points).reshape(1), covariance, mean,
                      cv::COVAR_NORMAL | cv::COVAR_ROWS | cv::COVAR_SCALE, CV_64F);
  cv::eigen(covariance, widths);
  return widths.at<double>(1) > kLeastWidth * kLeastWidth;
}

/// The points by their row and column, for their neighbours.
class Grid {
 public:
  Grid(int columns, const std::vector<Found>& found) : columns_(columns) {
    for (const auto& point : found) places_[point.id] = point.image_px;
  }
  /// The point so many columns and rows from another one; nothing if it was not found.
  std::optional<cv::Point2f> at(int id, int right, int down) const {
    const int column = id % columns_ + right;
    if (column < 0 || column >= columns_) return {};
    const auto place = places_.find(id + right + down * columns_);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
  }

 private:
  int columns_;
  std::map<int, cv::Point2f> places_;
};

/// True if two neighbours on one line with the point place it where it is, or if there are none.
bool is_in_line(const Grid& grid, const Found& point) {
  bool alone = true;
  for (const auto& [right, down] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    const auto next = grid.at(point.id, right, down);
    const auto other_side = grid.at(point.id, -right, -down);
    const auto second = grid.at(point.id, 2 * right, 2 * down);
    if (!next || (!other_side && !second)) continue;
    const auto placed = other_side ? (*next + *other_side) / 2 : 2 * *next - *second;
    if (cv::norm(placed - point.image_px) < kOutOfLine * cv::norm(*next - point.image_px))
      return true;
    alone = false;
  }
  return alone;
}

/// By how much the darker one of the two white squares at a corner is brighter than the brighter
/// black one. `map`: homography from squares to pixels.
double contrast_at(const cv::Mat1b& image, const cv::Mat& map, const Found& corner,
                   cv::Point2f square) {
  std::vector<cv::Point2f> around{square};
  for (const cv::Point2f side : {cv::Point2f(1, 1), {-1, -1}, {1, -1}, {-1, 1}})
    around.push_back(square + side * kLook);
  cv::perspectiveTransform(around, around, map);
  std::array<double, 4> grey{};
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const cv::Point px = corner.image_px + around[i + 1] - around[0];
    if (!cv::Rect({}, image.size()).contains(px)) return 0;
    grey[i] = image(px);
  }
  const bool begins_black = static_cast<int>(square.x + square.y) % 2 == 0;
  if (!begins_black) std::swap_ranges(grey.begin(), grey.begin() + 2, grey.begin() + 2);
  return std::min(grey[2], grey[3]) - std::max(grey[0], grey[1]);
}

/// Leaves out the corners at which there are no four squares.
void erase_covered(const Board& board, const cv::Mat1b& image, std::vector<Found>& found) {
  const auto squares = in_squares(board, found);
  const auto map = cv::findHomography(squares, in_image(found));
  std::vector<double> contrasts;
  for (std::size_t i = 0; i < found.size(); ++i)
    contrasts.push_back(contrast_at(image, map, found[i], squares[i]));
  const double least = kLeastContrast * std::max(median(contrasts), 0.);
  std::vector<Found> kept;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (contrasts[i] > least) kept.push_back(found[i]);
  found = std::move(kept);
}

bool enough(const Board& board, const std::vector<Found>& found) {
  const bool whole = board.kind != BoardKind::charuco;
  if (found.size() < (whole ? points_of(board).size() : kFewestPoints)) return false;
  return is_wide(in_squares(board, found));
}

}  // namespace

std::vector<Found> consistent(const Board& board, std::vector<Found> found) {
  if (!enough(board, found)) return {};
  std::vector<std::uint8_t> agrees;
  cv::findHomography(in_image(found), in_squares(board, found), cv::RANSAC, kMistake, agrees);
  std::vector<Found> kept;
  for (std::size_t i = 0; i < agrees.size(); ++i)
    if (agrees[i]) kept.push_back(found[i]);
  const auto fewest = kLeastAgreeing * static_cast<double>(found.size());
  return enough(board, kept) && static_cast<double>(kept.size()) >= fewest ? kept
                                                                           : std::vector<Found>{};
}

std::vector<Found> refined(const Board& board, const cv::Mat1b& image, std::vector<Found> found) {
  if (board.kind == BoardKind::circles || found.empty()) return found;
  const double share = board.kind == BoardKind::charuco ? kWindowBesideMarker : kWindow;
  const cv::TermCriteria done(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 40, 0.002);
  const auto before = found;
  for (auto& corner : found) {
    const int half_px =
        std::clamp(static_cast<int>(std::lround(share * nearest_px(before, corner.image_px))),
                   kLeastWindow_px, kLargestWindow_px);
    std::vector<cv::Point2f> saddle{corner.image_px};
    cv::cornerSubPix(image, saddle, {half_px, half_px}, {-1, -1}, done);
    corner.image_px = saddle.front();
  }
  const Grid grid(columns_of(board), found);
  std::erase_if(found, [&grid](const Found& corner) { return !is_in_line(grid, corner); });
  if (enough(board, found)) erase_covered(board, image, found);
  return enough(board, found) ? found : std::vector<Found>{};
}

}  // namespace handcast::calib
