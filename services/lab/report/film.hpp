// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/lab/report/inputs.hpp"

namespace handcast::report {

/// The pictures of the runs side by side, as shown on the page.
struct Film {
  /// Base64 of an H.264 MP4; empty if this build of OpenCV cannot write one, which browsers need.
  std::string video;
  std::vector<std::string> stills;    ///< base64 of JPEG pictures: kStills for each row
  std::vector<std::string> rows;      ///< names of the runs with pictures
  std::vector<std::string> problems;  ///< reasons why something is not shown, without a full stop
};

/// Stills per run.
inline constexpr int kStills = 5;

/// Makes the film. Writes `video_file`, and a PNG picture of its middle beside it. Pictures are
/// cropped to the part in which the light moves. Runs without pictures are left out; they and all
/// errors are in the problems.
Film make_film(const Inputs& inputs, const std::filesystem::path& video_file);

/// The HTML of the film.
std::string film_section(const Film& film);

}  // namespace handcast::report
