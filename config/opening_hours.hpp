// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// When a place is open, in the local time of the computer (watch.hours).
class OpeningHours {
 public:
  /// Reads sentences "DAYS RANGES" or "DATES RANGES". Days: "mon", "mon-fri", "sat,sun", "daily".
  /// Dates: "2026-12-24", "12-24" (of each year), two of a kind with ".." between them. Ranges:
  /// "closed", or "10:00-12:30, 14:00-18:00"; one that ends before it begins goes on until the next
  /// day. Without days, those that are no date are open. Errors: bad_config.
  static Result<OpeningHours> parse(std::span<const std::string> sentences);

  /// Whether it is always open.
  bool is_always_open() const { return !has_days_ && dated_.empty(); }
  /// Whether it is open at a time.
  bool is_open(std::time_t time) const;

 private:
  /// Minutes since the begin of the day; `end` may be on the next one.
  struct Range {
    int begin = 0, end = 0;
  };
  using Ranges = std::vector<Range>;
  /// Dates from first to last, as 10000 year + 100 month + day; year 0: each year.
  struct Dated {
    int first = 0, last = 0;
    Ranges open;
  };
  struct Reader;

  const Ranges& ranges_on(const std::tm& day) const;

  std::array<Ranges, 7> week_;  ///< from Sunday on, as std::tm::tm_wday
  bool has_days_ = false;
  std::vector<Dated> dated_;
};

}  // namespace handcast::config
