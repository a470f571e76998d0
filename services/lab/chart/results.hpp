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

/// One scored run of a sweep.
struct Run {
  std::string plan;                             ///< name of the plan
  std::string variant;                          ///< name of the variant
  std::map<std::string, std::string> settings;  ///< values of the axes, by path
  std::map<std::string, double> metrics;        ///< measured metrics, by column

  /// A metric; empty if it was not measured.
  std::optional<double> metric(const std::string& column) const;
  /// The value of a setting; "" if it is not an axis of the run's grid.
  std::string setting(const std::string& path) const;
  /// The paths of the axes other than motion, speed and seed.
  std::vector<std::string> turned() const;
};

/// Runs borrowed from Results.
using Runs = std::vector<const Run*>;

/// Summary of one file of results.
struct Source {
  std::string plan;         ///< name of the plan
  std::string file;         ///< name of the file
  std::size_t scored = 0;   ///< runs that were scored
  std::size_t failed = 0;   ///< runs that failed
  std::size_t planned = 0;  ///< runs of the plan
  bool ladder = false;      ///< the only axes are motion, speed and seed
};

/// The runs of several files.
struct Results {
  std::vector<Run> runs;        ///< in the order of the files
  std::vector<Source> sources;  ///< one per file

  /// The runs that satisfy a predicate. Valid as long as `runs`.
  Runs select(const std::function<bool(const Run&)>& wanted) const;
  /// The runs of the plans whose only axes are motion, speed and seed, except for the plan "times",
  /// which only measures frame times.
  Runs ladder() const;
};

/// Reads files of `handcast sweep`. Errors: bad_config (a file cannot be read), bad_data (a file
/// that is not of a sweep, has a metric that is not a number, or has no scored run).
Result<Results> read_results(const std::vector<std::filesystem::path>& files);

/// Mean of a metric over the runs that have it; empty if none has.
std::optional<double> mean_of(const Runs& runs, const std::string& column);

/// The variants in the order of the runs.
std::vector<std::string> variants_of(const Runs& runs);
/// The runs of one variant.
Runs of_variant(const Runs& runs, const std::string& variant);

/// A setting as a number: "true" is 1, "false" is 0; empty if it is none of these.
std::optional<double> number_of(const std::string& setting);

}  // namespace handcast::chart
