// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <vector>

#include "services/lab/sweep/results.hpp"
#include "services/lab/sweep/runs.hpp"

namespace handcast::sweep {

/// The runs to be done, and how.
struct Work {
  Shard shard;         ///< part of the plan
  int jobs = 0;        ///< worker threads; 0: one per core
  bool quiet = false;  ///< prints no progress
  /// Where the images, messages and true hands of each case are written, in a folder with its
  /// number (`simulate --record`); nothing is drawn. "": nowhere.
  std::string record{};
};

/// Numbers of runs of the shard.
struct Outcome {
  std::size_t scored = 0;  ///< runs that were scored
  std::size_t failed = 0;  ///< runs that ended with an error
  std::size_t kept = 0;    ///< runs that an earlier sweep had scored
  std::size_t absent = 0;  ///< runs whose motion or hand is not on this machine
  std::size_t left = 0;    ///< runs that were not begun because of `stop`
};

/// Does the runs of the shard that `results` does not hold. A run that fails is written as a line
/// with its error. No run begins after `stop` has become true. The figures do not depend on the
/// number of threads. Errors: those of Results.
Result<Outcome> run_all(const Plan& plan, const std::vector<Run>& runs, const Work& work,
                        Results& results, const std::atomic<bool>& stop);

}  // namespace handcast::sweep
