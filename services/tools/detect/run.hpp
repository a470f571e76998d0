// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::detect {

/// The command line of `handcast detect`.
struct Options {
  std::vector<std::filesystem::path> images;  ///< the pictures
  std::vector<std::filesystem::path> joints;  ///< --joints: one per image, or none
  msg::Side joints_side = msg::Side::left;    ///< --side: of the hand in `joints`
  std::string backend;  ///< the landmark model; empty: MediaPipe, or ours if its files are missing
  std::string models;   ///< folder of the networks' files; empty: see models_folder()
  std::filesystem::path output = "";  ///< --out: folder for drawings; empty: no drawings
  int hands = 2;                      ///< the largest number of hands
  int repeat = 1;                     ///< number of detections per picture
  bool json = false;                  ///< print JSON
  bool quiet = false;                 ///< print no progress
};

/// What was found.
struct Report {
  std::string text;       ///< for standard output; of a picture without a hand, it says why
  bool has_hand = false;  ///< in at least one picture
};

/// Detects hands in the pictures and draws them. Without joints it searches for them: with
/// MediaPipe's palm network or, without its file, in the bright parts. Progress goes to standard
/// error. Errors: bad_config, bad_data, unavailable.
handcast::Result<Report> run(const Options& options);

}  // namespace handcast::detect
