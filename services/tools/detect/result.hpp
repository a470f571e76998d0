// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::detect {

/// The hands in one picture.
struct Result {
  std::filesystem::path image;              ///< file of the picture
  std::vector<landmarks::FoundHand> hands;  ///< the hands
  landmarks::HandFinder::Times times;       ///< medians over the repetitions
};

/// "left" or "right".
const char* name_of(msg::Side side);

/// One line for the picture; for each hand one line and a table of its points.
std::string print_text(const Result& result);
/// JSON of all pictures:
/// {"images":[{"image","ms":{"all","crop","network","palm"},"hands":[{"side","presence","points_px":[[x,y],...]}]}]}
std::string print_json(const std::vector<Result>& results);

}  // namespace handcast::detect
