// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/evaluation/report/inputs.hpp"

namespace handcast::report {

/// The pictures of the runs side by side.
struct Film {
  std::string
      video;  ///< base64 of an H.264 MP4; empty where this build cannot make one that browsers play
  std::vector<std::string>
      stills;  ///< base64 of JPEG pictures, a row of kStills per run that has any
  std::vector<std::string> rows;  ///< the name of the run of each row
  std::vector<std::string> problems;
};

inline constexpr int kStills = 5;

/// Writes `video_file`, beside it one moment as a PNG picture, and returns what the page shows of
/// it. Pictures are cropped to where anything moves. Runs without pictures are left out and named
/// in the problems.
Film make_film(const Inputs& inputs, const std::filesystem::path& video_file);

/// The film as HTML.
std::string film_section(const Film& film);

}  // namespace handcast::report
