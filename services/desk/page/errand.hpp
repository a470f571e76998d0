// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// A program of handcast that a page has started; one at a time. It has the priority of the thread
/// that makes this, and ends with it. Any thread.
class Errand {
 public:
  /// The most that is kept of what a program writes; what is more is dropped.
  static constexpr std::size_t kMostBytes = 256 << 10;

  struct State {
    bool is_running = false;
    double seconds = 0;       ///< since its start, or how long it took
    std::string output, log;  ///< what it wrote so far to its standard output and error
    int exit_code = -1;       ///< -1: it was not started, still runs, or was killed
  };

  /// A program that runs for longer is stopped.
  explicit Errand(std::chrono::seconds longest);
  /// Stops the program and waits for its end, 5 s at most.
  ~Errand();
  Errand(const Errand&) = delete;
  Errand& operator=(const Errand&) = delete;

  /// Starts a program: words[0] is its path. Errors: unavailable (one is running).
  Result<void> start(std::vector<std::string> words);
  /// Asks it to stop (SIGTERM); false if none is running.
  bool stop();
  State state() const;

 private:
  struct Child;
  void work();
  void run(std::vector<std::string> words);
  bool is_over(std::int64_t begin_ns) const;
  void keep(std::string State::*where, std::string_view bytes);

  std::chrono::seconds longest_;
  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable news_;
  State state_;
  std::int64_t begun_ns_ = 0;
  std::optional<std::vector<std::string>> wanted_;
  bool must_stop_ = false, is_closed_ = false;
  std::thread thread_;
};

}  // namespace handcast::desk
