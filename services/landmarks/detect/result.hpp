// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::detect {

/// What was found in one picture.
struct Result {
  std::filesystem::path image;
  std::vector<landmarks::FoundHand> hands;
  landmarks::HandFinder::Times times;  ///< medians over the repetitions
};

const char* name_of(msg::Side side);

/// A line for the picture, a line a hand, a table of its points.
std::string print_text(const Result& result);
/// {"images":[{"image","ms":{"all","crop","network","palm"},"hands":[{"side","presence","points_px":[[x,y],...]}]}]}
std::string print_json(const std::vector<Result>& results);

}  // namespace handcast::detect
