// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::report {

/// A JSON file of the folder: its content, or why there is none.
struct Source {
  std::string file;  ///< "paper.json"
  std::optional<nlohmann::json> content;
  std::string problem;  ///< "paper.json is missing"

  /// The number at a place of the content ("/interior_mm/p95"); nothing where there is none.
  std::optional<double> number(const nlohmann::json::json_pointer& place) const;
  std::optional<double> number(const char* place) const {
    return number(nlohmann::json::json_pointer(place));
  }
};

/// One way to light the hand, simulated against the same truth as the others.
struct Run {
  std::string name;      ///< as the page calls it: "handcast"
  std::string sentence;  ///< what it is
  Source metrics;
  std::vector<std::filesystem::path> pictures;  ///< in the order of their numbers
};

/// All that a report is made of.
struct Inputs {
  std::array<Run, 3> runs;  ///< baseline, paper, handcast
  Source equal_legs;        ///< handcast once more, given as much software time as the paper
  Source live;              ///< what the supervisor saw of a live run
  Source observer;          ///< what the observer scored in it
};

/// Reads what a folder holds. What is missing or damaged is a problem of its own source.
/// Errors (bad_config): the folder is not there; nothing in it can go into a report.
Result<Inputs> read_inputs(const std::filesystem::path& folder);

}  // namespace handcast::report
