// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/missing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "calib/solve/board/board_finder.hpp"
#include "calib/solve/board/board_name.hpp"

namespace handcast::calib {
namespace {

/// The brightest pixels of an image that is too dark for any search.
constexpr int kDarkGrey = 24;
/// Fewer markers than this are found in noise.
constexpr std::size_t kFewestMarkers = 4;

/// Boards of a kind that are taken for this one: larger ones first, because a part of a
/// checkerboard looks like a smaller one.
std::vector<Board> alternatives(const Board& wanted, BoardKind kind) {
  std::vector<Board> boards;
  for (const int more_rows : {1, 0, -1})
    for (const int more_columns : {1, 0, -1})
      for (const bool exchanged : {false, true}) {
        int columns = wanted.columns + more_columns, rows = wanted.rows + more_rows;
        if (exchanged) std::swap(columns, rows);
        const Board board{kind, columns, rows, wanted.square_mm};
        if (check_board(board)) boards.push_back(board);
      }
  return boards;
}

/// The charuco board of which most corners are found, the smallest of them. A board of more rows
/// has the same markers, and more.
std::optional<Board> charuco_in(GreyView image, const Board& wanted) {
  std::optional<Board> best;
  std::size_t most = 0;
  for (const Board& board : alternatives(wanted, BoardKind::charuco)) {
    const auto view = BoardFinder(board).find(image);
    const auto corners = view ? view->ids.size() : 0;
    if (corners == 0 || corners < most) continue;
    if (corners == most && points_of(board).size() >= points_of(*best).size()) continue;
    most = corners;
    best = board;
  }
  return best;
}

std::optional<Board> unmarked_in(GreyView image, const Board& wanted) {
  std::array kinds{BoardKind::checkerboard, BoardKind::circles};
  if (wanted.kind == BoardKind::circles) std::swap(kinds[0], kinds[1]);
  for (const auto kind : kinds)
    for (const Board& board : alternatives(wanted, kind))
      if (BoardFinder(board).find(image)) return board;
  return std::nullopt;
}

cv::Mat1b matrix_of(GreyView view) {
  return {view.height_px, view.width_px, const_cast<std::uint8_t*>(view.pixels),
          static_cast<std::size_t>(view.stride)};
}

GreyPicture mirrored(GreyView view) {
  GreyPicture picture{view.width_px, view.height_px, {}};
  for (int y = 0; y < view.height_px; ++y) {
    const auto* row = view.pixels + y * view.stride;
    picture.pixels.insert(picture.pixels.end(), std::reverse_iterator(row + view.width_px),
                          std::reverse_iterator(row));
  }
  return picture;
}

std::size_t markers_in(const cv::Mat1b& image, int dictionary) {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(dictionary), corners, ids);
  return ids.size();
}

/// "10 x 7 squares".
std::string size_of(const Board& board) {
  return fmt::format("{} x {} {}", board.columns, board.rows,
                     board.kind == BoardKind::circles ? "circles" : "squares");
}

std::string describe(const Board& seen, const Board& wanted) {
  const auto option = fmt::format("--board {}", print_board_name(seen));
  if (seen.kind != wanted.kind)
    return fmt::format("this is another kind of board, of {}: {}", size_of(seen), option);
  if (seen.columns == wanted.rows && seen.rows == wanted.columns)
    return fmt::format("columns and rows are exchanged, the board has {}: {}", size_of(seen),
                       option);
  const auto is_inside = [&seen](int columns, int rows) {
    return seen.columns == columns + 1 && seen.rows == rows + 1;
  };
  if (seen.kind != BoardKind::circles &&
      (is_inside(wanted.columns, wanted.rows) || is_inside(wanted.rows, wanted.columns)))
    return fmt::format("the board has {}, {} x {} is the number of its inner corners: {}",
                       size_of(seen), wanted.columns, wanted.rows, option);
  return fmt::format("the board has {}: {}", size_of(seen), option);
}

constexpr std::string_view kMirrored =
    "the camera's image is mirrored: a mirror is in the way, or the camera turns its image round; "
    "switch that off (ReverseX, hflip), or look past the mirror";

/// What its markers say of a board whose squares are not where they are expected.
std::optional<std::string> describe_markers(const cv::Mat1b& image) {
  struct Dictionary {
    int number;
    const char* name;
  };
  constexpr Dictionary kOthers[] = {{cv::aruco::DICT_5X5_250, "DICT_5X5"},
                                    {cv::aruco::DICT_6X6_250, "DICT_6X6"},
                                    {cv::aruco::DICT_7X7_250, "DICT_7X7"},
                                    {cv::aruco::DICT_ARUCO_ORIGINAL, "DICT_ARUCO_ORIGINAL"},
                                    {cv::aruco::DICT_APRILTAG_36h11, "DICT_APRILTAG_36h11"}};
  for (const auto& [number, name] : kOthers)
    if (markers_in(image, number) >= kFewestMarkers)
      return fmt::format(
          "this board has markers of {}, and a charuco board has those of DICT_4X4_250; print one "
          "with `handcast calibrate --print-board board.pdf`",
          name);
  if (const auto count = markers_in(image, cv::aruco::DICT_4X4_250); count >= kFewestMarkers)
    return fmt::format(
        "{} markers are seen, but not where this board has them: give its numbers of squares to "
        "--board; a board of OpenCV before 4.6 begins with a white square and cannot be used",
        count);
  return std::nullopt;
}

std::string explain(const Board& wanted, GreyView image) {
  const auto pixels = matrix_of(image);
  double brightest = 0;
  cv::Mat1b smooth;
  cv::blur(pixels, smooth, {5, 5});
  cv::minMaxLoc(smooth, nullptr, &brightest);
  if (brightest < kDarkGrey)
    return fmt::format(
        "the camera's image is dark, its brightest place has the grey value {:.0f} of 255: more "
        "infrared light, a longer exposure or a wider aperture",
        brightest);
  constexpr auto kOurs = cv::aruco::DICT_4X4_250;
  if (markers_in(pixels, kOurs) >= kFewestMarkers)
    if (const auto seen = charuco_in(image, wanted)) return describe(*seen, wanted);
  // Only markers show that an image is mirrored: the other patterns look the same in a mirror.
  const auto mirror_image = mirrored(image);
  if (markers_in(matrix_of(mirror_image.view()), kOurs) >= kFewestMarkers) {
    const auto seen = charuco_in(mirror_image.view(), wanted);
    const bool is_wanted = !seen || print_board_name(*seen) == print_board_name(wanted);
    return is_wanted ? std::string(kMirrored)
                     : fmt::format("{}; and {}", kMirrored, describe(*seen, wanted));
  }
  if (const auto seen = unmarked_in(image, wanted)) return describe(*seen, wanted);
  if (const auto markers = describe_markers(pixels)) return *markers;
  return fmt::format("no board of {} is seen: all of it must be in the image, sharp and evenly lit",
                     size_of(wanted));
}

}  // namespace

std::string why_missing(const Board& wanted, GreyView image) {
  try {
    return explain(wanted, image);
  } catch (const cv::Exception&) {  // of an image in which OpenCV's search loses its way
    return "the board is not seen";
  }
}

}  // namespace handcast::calib
