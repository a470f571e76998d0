// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/sections/executor.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::detect {

/// The command line of `handcast detect`.
struct Options {
  std::vector<std::filesystem::path> images;
  std::vector<std::filesystem::path> joints;  ///< one per image, or none
  msg::Side joints_side = msg::Side::left;
  std::string backend = "mediapipe";  ///< the landmark model: this one needs no tracker
  config::Executor executor = config::Executor::onednn;
  std::string models;                 ///< folder of the networks' files; empty: the usual one
  std::filesystem::path output = "";  ///< folder for drawings; empty: nothing is drawn
  int hands = 2;
  int repeat = 1;
  bool json = false;
  bool quiet = false;
};

/// Sets the landmark model. An old name is read as the current one, may set the executor as well,
/// and is reported on stderr.
void set_backend(Options& options, const std::string& name);

}  // namespace handcast::detect
