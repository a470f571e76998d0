// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

namespace handcast::sweep {

/// How far a sweep is, on stderr: one line on a terminal that is written over; every tenth where
/// there is none. Any thread.
class Progress {
 public:
  Progress(std::string plan, std::size_t runs, bool quiet);
  ~Progress();

  void one_done(bool failed);
  /// A sentence of its own line.
  void say(const std::string& sentence);

 private:
  void show();

  std::string plan_;
  std::size_t runs_;
  bool quiet_, terminal_;
  std::mutex mutex_;
  std::size_t done_ = 0, failed_ = 0, tenths_ = 0;
  std::int64_t start_ns_, shown_ns_ = 0;
};

}  // namespace handcast::sweep
