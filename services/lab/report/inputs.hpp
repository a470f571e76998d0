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

/// A JSON file of the folder.
struct Source {
  std::string file;                         ///< name of the file: "paper.json"
  std::optional<nlohmann::json> content{};  ///< an object; empty if there is a problem
  std::string problem{};                    ///< "paper.json is missing"; "" without a problem
  bool missing = false;                     ///< the problem is that there is no such file

  /// The number at a place of the content; empty if there is none.
  std::optional<double> number(const nlohmann::json::json_pointer& place) const;
  /// The same for a place as text: "/interior_mm/p95".
  std::optional<double> number(const char* place) const {
    return number(nlohmann::json::json_pointer(place));
  }
};

/// One simulated method. All runs of a report have the same truth.
struct Run {
  std::string name;                             ///< name on the page: "handcast"
  std::string sentence;                         ///< description on the page
  Source metrics;                               ///< of `handcast simulate --json`
  std::vector<std::filesystem::path> pictures;  ///< in the order of their numbers
};

/// The input of a report.
struct Inputs {
  std::array<Run, 3> runs;  ///< baseline, paper, handcast
  Source equal_legs;        ///< handcast with the software time of the paper
  Source live;              ///< rates, restarts and stage times of a live run, from the supervisor
  Source observer;          ///< the observer's score of the live run
};

/// Reads the files of a folder. A missing or malformed file is a problem of its Source. Errors:
/// bad_config (there is no such folder, or none of the files).
Result<Inputs> read_inputs(const std::filesystem::path& folder);

/// The problems of the files that are there, a sentence each.
std::vector<std::string> faults_of(const Inputs& inputs);

}  // namespace handcast::report
