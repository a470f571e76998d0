// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ipc/base/log.hpp"
#include "supervisor/look/figures/figures.hpp"

namespace handcast::supervisor {

/// What `handcast up` logs of the rates of a rig that nobody watches in a terminal: a summary at
/// first and then every hour, and the streams that become slow or hold their rate again. A stream
/// that wavers is not a change: it has to be slow, or not slow, for a while. One thread.
class Diary {
 public:
  static constexpr std::int64_t kLook_ns = 5'000'000'000;         ///< time between two looks
  static constexpr std::int64_t kWhile_ns = 30'000'000'000;       ///< for how long a change lasts
  static constexpr std::int64_t kSummary_ns = 3'600'000'000'000;  ///< time between two summaries

  /// A line of the log.
  struct Entry {
    log::Level level;
    std::string text;
  };

  /// The entries of a moment. `summary`: the text of a summary, if one is due.
  std::vector<Entry> look(std::int64_t now_ns, const Figures& figures, const std::string& summary);

 private:
  struct Pace {
    bool told_slow = false;     ///< as it was logged
    std::int64_t since_ns = 0;  ///< since when it has been otherwise; 0: it is not
  };
  void tell_changes(std::int64_t now_ns, const Figures& figures, std::vector<Entry>& entries);

  std::map<std::string, Pace> paces_;  ///< by stream
  std::int64_t next_summary_ns_ = 0;
};

}  // namespace handcast::supervisor
