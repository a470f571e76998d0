// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board_finder.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "calib/solve/board/find.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

/// Share of the darkest and of the brightest pixels that may be cut off: dead pixels, lamps.
constexpr double kDark = 0.005, kBright = 0.03;
constexpr int kSmallestImage_px = 32;

cv::Mat1b stretched(const cv::Mat1f& image) {
  constexpr float kLeastRange = 1e-3F;
  const std::vector<float> values(image.begin(), image.end());
  const float low = quantile(values, kDark), high = quantile(values, 1 - kBright);
  const double gain = 255 / std::max(high - low, kLeastRange);
  cv::Mat1b result;
  image.convertTo(result, CV_8U, gain, -low * gain);
  return result;
}

/// Smoothed before it is rounded: the contrast of an infrared image may be a few grey values.
cv::Mat1f smoothed(GreyView view, double by_px) {
  const cv::Mat1b image(view.height_px, view.width_px, const_cast<std::uint8_t*>(view.pixels),
                        static_cast<std::size_t>(view.stride));
  cv::Mat1f smooth;
  image.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {}, by_px);
  return smooth;
}

/// Equal ratios of light become equal differences: for a board that is dark beside a lamp.
cv::Mat1f logarithm(const cv::Mat1f& image) {
  cv::Mat1f result;
  cv::log(image + 1, result);
  return result;
}

std::vector<Found> search(const Board& board, const cv::Mat1b& image) {
  switch (board.kind) {
    case BoardKind::checkerboard:
      return find_checkerboard(board, image);
    case BoardKind::circles:
      return find_circles(board, image);
    case BoardKind::charuco:
      return find_charuco(board, image);
  }
  return {};
}

/// Searches in different versions of the image until all points are found; the version in which
/// most boards are found comes first. `fine` is for the search, `smooth` to refine.
std::vector<Found> search_all(const Board& board, GreyView view) {
  constexpr double kFine_px = 1, kSmooth_px = 1.5, kVerySmooth_px = 2;
  const auto whole = points_of(board).size();
  std::vector<Found> best;
  const auto attempt = [&](const cv::Mat1f& fine, const cv::Mat1f& smooth) {
    if (best.size() == whole) return;
    auto found = consistent(board, search(board, stretched(fine)));
    found = refined(board, stretched(smooth), std::move(found));
    if (found.size() > best.size()) best = std::move(found);
  };
  const auto fine = smoothed(view, kFine_px), smooth = smoothed(view, kSmooth_px);
  attempt(fine, smooth);
  attempt(logarithm(fine), logarithm(smooth));
  const auto very_smooth = smoothed(view, kVerySmooth_px);
  attempt(very_smooth, very_smooth);
  return best;
}

}  // namespace

struct BoardFinder::Method {
  Board board;
  std::vector<glm::dvec3> points_m;
};

BoardFinder::BoardFinder(const Board& board)
    : method_(std::make_unique<const Method>(Method{board, points_of(board)})) {}
BoardFinder::~BoardFinder() = default;
BoardFinder::BoardFinder(BoardFinder&&) noexcept = default;
BoardFinder& BoardFinder::operator=(BoardFinder&&) noexcept = default;

std::optional<BoardView> BoardFinder::find(GreyView image) const {
  if (!image.pixels || std::min(image.width_px, image.height_px) < kSmallestImage_px) return {};
  std::vector<Found> found;
  try {
    found = search_all(method_->board, image);
  } catch (const cv::Exception&) {  // of an image in which OpenCV's search loses its way
    return {};
  }
  if (found.empty()) return {};
  BoardView view;
  for (const auto& point : found) {
    view.ids.push_back(point.id);
    view.image_px.emplace_back(point.image_px.x, point.image_px.y);
    view.board_m.push_back(method_->points_m[static_cast<std::size_t>(point.id)]);
  }
  return view;
}

}  // namespace handcast::calib
