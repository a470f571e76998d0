// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::watch {

/// Runs programs of the person who set up the rig, one after the other, without a shell and without
/// waiting for them. One that takes too long is killed with all that it has started. One thread.
class Errands {
 public:
  struct Settings {
    double longest_s = 20;
    std::filesystem::path folder;  ///< in which they are started; empty: the present one
    /// Is told of one that did not do its work: "'mail' ended with exit 1: no such host".
    std::function<void(const std::string&)> on_failure;
  };
  explicit Errands(Settings settings) : settings_(std::move(settings)) {}
  Errands(const Errands&) = delete;
  Errands& operator=(const Errands&) = delete;
  /// Kills the one that runs.
  ~Errands();

  /// Starts `words` when those before have ended; `input` is its standard input. Empty words are
  /// no errand. Of too many that wait, the oldest is left out.
  void add(std::vector<std::string> words, std::string input);
  /// Looks after the errands; call it some times a second.
  void turn(std::int64_t now_ns);
  /// True if none runs or waits.
  bool is_done() const { return pid_ <= 0 && waiting_.empty(); }

 private:
  struct Errand {
    std::vector<std::string> words;
    std::string input;
  };
  Result<void> start(const Errand& errand);
  bool has_ended(std::int64_t now_ns);
  void read_output();
  void fail_with(const std::string& why) const;

  Settings settings_;
  std::deque<Errand> waiting_;
  std::string name_;           ///< of the one that runs
  pid_t pid_ = -1;             ///< also of its process group
  std::vector<pid_t> killed_;  ///< not yet ended
  std::int64_t ends_ns_ = 0;   ///< when it is killed
  UniqueFd output_;
  std::string printed_;  ///< the end of what it printed
};

}  // namespace handcast::watch
