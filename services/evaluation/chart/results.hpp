// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::chart {

/// One scored run, as a sweep's file has it.
struct Run {
  std::string plan, variant;
  std::map<std::string, std::string> settings;  ///< that its grid turned, by path
  std::map<std::string, double> metrics;        ///< that were measured, by column

  std::optional<double> metric(const std::string& column) const;
  std::string setting(const std::string& path) const;  ///< "" where its grid does not turn it
  /// The settings that are more than which motion is played how fast, and by which seed.
  std::vector<std::string> turned() const;
};

using Runs = std::vector<const Run*>;

/// What a file holds, for the page.
struct Source {
  std::string plan, file;
  std::size_t scored = 0, failed = 0, planned = 0;
  bool ladder = false;  ///< its grid turns nothing but motion, speed and seed
};

struct Results {
  std::vector<Run> runs;
  std::vector<Source> sources;

  Runs select(const std::function<bool(const Run&)>& wanted) const;
  /// Runs of plans that turn nothing but motion, speed and seed, but for those that only time
  /// frames.
  Runs ladder() const;
};

/// Reads files of `handcast sweep`.
/// Errors: bad_config (a file cannot be read), bad_data (it is none of a sweep's, has a metric that
/// is no number, or no run was scored).
Result<Results> read_results(const std::vector<std::filesystem::path>& files);

/// Mean over the runs that have it; none where none has.
std::optional<double> mean_of(const Runs& runs, const std::string& column);

/// The variants in the order of the runs.
std::vector<std::string> variants_of(const Runs& runs);
Runs of_variant(const Runs& runs, const std::string& variant);

/// A setting of a run as a number; true is 1. None where it is neither.
std::optional<double> number_of(const std::string& setting);

}  // namespace handcast::chart
