// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// One reader of a ring, as anybody may see it.
struct ReaderView {
  int row = 0;
  pid_t pid = 0;  ///< 24 bits of it are all a row holds; 0: the row is free
  bool waiting = false;
  std::uint64_t received = 0, skipped = 0, unusable = 0, copied = 0;
  std::uint64_t lag = 0;    ///< messages after the last one taken, up to the newest
  std::int64_t age_ns = 0;  ///< of the last message's origin when it was taken
  std::array<std::int64_t, kLeasesPerRow>
      lease_ages_ns{};  ///< since the leased message was published; -1: not leased
};

/// A ring at one moment. Its parts are read one after the other while others write: each is true,
/// not all at the same time.
struct RingSnapshot {
  std::string stream;
  int slots = 0;
  std::uint64_t epoch = 0;     ///< number of the last writer
  std::uint64_t sequence = 0;  ///< of the newest message; 0: none yet
  std::uint64_t published = 0, dropped = 0;
  std::int64_t newest_origin_ns = 0, newest_published_ns = 0;
  std::vector<ReaderView> readers;  ///< of the rows that have an owner
};

/// Looks at a ring without taking part: mapped read-only, no row, no lock.
class RingView {
 public:
  /// Errors: as Segment::open.
  static Result<RingView> open(UniqueFd fd);

  RingSnapshot look() const;
  std::string stream() const { return segment_.stream(); }
  int slots() const { return segment_.slots(); }
  std::uint64_t epoch()
      const;  ///< of the newest message, which was published by that writer; 0: none
  std::uint64_t sequence() const;  ///< of the newest message; 0: none

 private:
  explicit RingView(Segment segment) : segment_(std::move(segment)) {}
  ReaderView reader_in(int row, std::uint64_t newest, std::int64_t time_ns) const;
  std::int64_t lease_age_ns(int row, int index, std::int64_t time_ns) const;
  Segment segment_;
};

}  // namespace handcast::ipc
