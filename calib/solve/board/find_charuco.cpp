// SPDX-License-Identifier: Apache-2.0
#include <opencv2/aruco/charuco.hpp>

#include "calib/solve/board/find.hpp"
#include "calib/solve/board/pattern.hpp"

namespace handcast::calib {

std::vector<Found> find_charuco(const Board& board, const cv::Mat1b& image) {
  const auto layout = cv::aruco::CharucoBoard::create(
      board.columns, board.rows, 1, static_cast<float>(kMarkerShare),
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_250));
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids, ids;
  cv::aruco::detectMarkers(image, layout->dictionary, markers, marker_ids);
  if (marker_ids.empty()) return {};
  std::vector<cv::Point2f> corners;
  cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, layout, corners, ids,
                                       cv::noArray(), cv::noArray(), 1);
  std::vector<Found> found;
  for (std::size_t i = 0; i < corners.size(); ++i) found.push_back({ids[i], corners[i]});
  return found;
}

}  // namespace handcast::calib
