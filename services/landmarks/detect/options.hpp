// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::detect {

struct Options {
  std::vector<std::filesystem::path> images;
  std::vector<std::filesystem::path> joints;  ///< one per image, or none
  msg::Side joints_side = msg::Side::left;
  std::string backend = "onednn";
  std::string models;                 ///< empty: the usual folder
  std::filesystem::path output = "";  ///< folder for pictures; empty: none are drawn
  int hands = 2;
  int repeat = 1;
  bool json = false;
  bool quiet = false;
};

}  // namespace handcast::detect
