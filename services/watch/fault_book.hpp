// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "config/sections/watch.hpp"
#include "services/watch/day.hpp"
#include "services/watch/faults.hpp"

namespace handcast::watch {

/// Keeps the faults of a day, and decides who is told what: a fault at most once in
/// alert.again_s for each kind, its end if the fault was told. One thread.
class FaultBook {
 public:
  FaultBook(Day& day, const config::Alert& settings) : day_(day), settings_(settings) {}

  struct Notice {
    std::string kind, text;
    bool is_over = false;  ///< the fault has ended
  };
  /// Takes what is wrong now. Returns what is to be told.
  std::vector<Notice> look(const Wrongs& wrongs, std::int64_t now_ns, std::time_t time);
  /// True if a fault is open.
  bool has_open() const;
  /// How long the fault that was seen first has been open, that of the disk aside: a reboot gives
  /// no space. 0: there is none.
  double lasting_s(std::int64_t now_ns) const;

 private:
  bool may_tell(const std::string& kind, std::time_t time) const;

  Day& day_;
  config::Alert settings_;
  struct Seen {
    std::int64_t first_ns = 0, last_ns = 0;
  };
  std::map<std::string, Seen> seen_;  ///< of each open fault, since the watch was started
};

}  // namespace handcast::watch
