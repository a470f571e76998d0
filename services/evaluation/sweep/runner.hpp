// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <vector>

#include "services/evaluation/sweep/results.hpp"
#include "services/evaluation/sweep/runs.hpp"

namespace handcast::sweep {

struct Work {
  Shard shard;
  int jobs = 0;  ///< worker threads; 0: one per core
  bool quiet = false;
};

struct Outcome {
  std::size_t scored = 0, failed = 0;
  std::size_t kept = 0;    ///< of an earlier sweep
  std::size_t absent = 0;  ///< their motion is not on this machine
  std::size_t left = 0;    ///< stopped before they began
};

/// Runs what the shard has and `results` has not. A run that cannot be done becomes a line with its
/// error, and the others go on. Once `stop` is true none begins any more. The same figures with any
/// number of threads: a run shares nothing. Errors: those of Results.
Result<Outcome> run_all(const Plan& plan, const std::vector<Run>& runs, const Work& work,
                        Results& results, const std::atomic<bool>& stop);

}  // namespace handcast::sweep
