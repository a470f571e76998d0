// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <set>
#include <vector>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {
namespace {

/// The homography from board space to the image, by least squares; empty if there is none.
cv::Mat map_of(const BoardView& view) {
  constexpr std::size_t kFewest = 4;
  if (view.ids.size() < kFewest) return {};
  const auto points = points_of(view);
  std::vector<cv::Point2d> board_m;
  for (const auto& point : points.board_m) board_m.emplace_back(point.x, point.y);
  try {
    return cv::findHomography(board_m, points.image_px);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

/// The third row of the homography is the distance, up to a factor. It is a linear function of the
/// position on the board, whose gradient the derivative of the homography carries to the image.
std::optional<glm::dvec2> tilt_of(const BoardView& view, double scale_px) {
  const cv::Mat1d map = map_of(view);
  if (map.empty()) return {};
  glm::dvec3 middle(0, 0, 1);
  for (const auto& m : view.board_m)
    middle += glm::dvec3(m.x, m.y, 0) / static_cast<double>(view.board_m.size());
  glm::dmat3 h;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) h[column][row] = map(row, column);
  const auto image = h * middle;
  const glm::dvec2 px = glm::dvec2(image) / image.z;
  const glm::dvec2 growth = glm::dvec2(h[0].z, h[1].z) / image.z;  // per metre
  glm::dmat2 px_per_m;
  for (int axis = 0; axis < 2; ++axis)
    px_per_m[axis] = glm::dvec2(h[axis]) / image.z - px * growth[axis];
  const auto tilt = glm::inverse(glm::transpose(px_per_m)) * growth * scale_px;
  if (!std::isfinite(tilt.x + tilt.y)) return {};
  return tilt;
}

double mistake_of(const BoardView& view) {
  const cv::Mat map = map_of(view);
  if (map.empty()) return std::numeric_limits<double>::infinity();
  const auto points = points_of(view);
  std::vector<cv::Point2d> board_m, expected_px;
  for (const auto& point : points.board_m) board_m.emplace_back(point.x, point.y);
  cv::perspectiveTransform(board_m, expected_px, map);
  double worst = 0;
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    double pitch_px = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < expected_px.size(); ++j)
      if (j != i) pitch_px = std::min(pitch_px, cv::norm(expected_px[i] - expected_px[j]));
    worst = std::max(worst, cv::norm(expected_px[i] - points.image_px[i]) / pitch_px);
  }
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

namespace {

/// Tangent of the angle from which a board counts as tilted, about 11 degrees.
constexpr double kTilted = 0.2;

/// How the board is tilted: towards a corner counts for both sides.
std::vector<Tilt> tilts_of(glm::dvec2 tilt) {
  if (glm::length(tilt) < kTilted) return {Tilt::flat};
  const bool is_across = std::abs(tilt.x) > std::abs(tilt.y);
  std::vector<Tilt> tilts;
  if (is_across || std::abs(tilt.x) >= kTilted)
    tilts.push_back(tilt.x < 0 ? Tilt::left : Tilt::right);
  if (!is_across || std::abs(tilt.y) >= kTilted)
    tilts.push_back(tilt.y < 0 ? Tilt::up : Tilt::down);
  return tilts;
}

std::string_view tilt_advice(Tilt tilt) {
  switch (tilt) {
    case Tilt::flat:
      return "Hold the board flat towards the camera.";
    case Tilt::left:
      return "Tilt the board to the left, its left side away from the camera.";
    case Tilt::right:
      return "Tilt the board to the right, its right side away from the camera.";
    case Tilt::up:
      return "Tilt the board up, its upper side away from the camera.";
    case Tilt::down:
      return "Tilt the board down, its lower side away from the camera.";
  }
  return {};
}

/// The names of the thirds of the image.
std::string place_name(int column, int row) {
  constexpr std::array<std::string_view, 3> kAcross{"left", "", "right"},
      kDown{"top", "", "bottom"};
  const auto across = kAcross[static_cast<std::size_t>(column)];
  const auto down = kDown[static_cast<std::size_t>(row)];
  if (across.empty() && down.empty()) return "in the middle";
  if (across.empty() || down.empty()) return fmt::format("at the {}{} edge", down, across);
  return fmt::format("in the {} {} corner", down, across);
}

}  // namespace

void Coverage::add(const BoardView& view) {
  std::set<std::size_t> seen;
  for (const auto& px : view.image_px) {
    const double across = (px.x + 0.5) / width_px_, down = (px.y + 0.5) / height_px_;
    if (!(across >= 0 && across < 1 && down >= 0 && down < 1)) continue;
    seen.insert(index(static_cast<int>(across * kColumns), static_cast<int>(down * kRows)));
  }
  for (const auto cell : seen) ++cells_[cell];
  if (const auto tilt = tilt_of(view, usual_focal_length_px(width_px_)))
    for (const auto bin : tilts_of(*tilt)) ++tilts_[static_cast<std::size_t>(bin)];
}

double Coverage::area() const {
  return 1 -
         static_cast<double>(std::ranges::count(cells_, 0)) / static_cast<double>(cells_.size());
}

int Coverage::tilts_seen() const {
  return static_cast<int>(tilts_.size()) - static_cast<int>(std::ranges::count(tilts_, 0));
}

double Coverage::share() const { return (area() + tilts_seen() / 5.) / 2; }

std::string Coverage::place_advice() const {
  int most = 0;
  std::string place;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      int missing = 0;
      for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x)
          missing += x * 3 / kColumns == column && y * 3 / kRows == row && views_in(x, y) == 0;
      if (missing > most) most = missing, place = place_name(column, row);
    }
  return most > 0 ? fmt::format("Hold the board {} of the image.", place) : std::string();
}

std::string Coverage::advice() const {
  const auto missing = std::ranges::find(tilts_, 0);
  if (missing == tilts_.end() || area() < tilts_seen() / 5.) return place_advice();
  return std::string(tilt_advice(static_cast<Tilt>(missing - tilts_.begin())));
}

}  // namespace handcast::calib
