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

/// The state of one reader of a ring.
struct ReaderView {
  int row = 0;           ///< number of the reader row
  pid_t pid = 0;         ///< low 24 bits of the pid of the owner; 0: the row is free
  bool waiting = false;  ///< sleeps and wants to be woken
  /// The counters of the reader: see ReaderTally.
  /// @{
  std::uint64_t received = 0, skipped = 0, unusable = 0, copied = 0;
  /// @}
  std::uint64_t lag = 0;    ///< number of messages after the last one taken, up to the newest
  std::int64_t age_ns = 0;  ///< age of the origin of the last message when it was taken
  /// Time since each leased message was published; -1: not leased.
  std::array<std::int64_t, kLeasesPerRow> lease_ages_ns{};
};

/// The state of a ring. The values are read one after the other while other processes write, so
/// they may belong to slightly different moments.
struct RingSnapshot {
  std::string stream;          ///< name of the stream
  int slots = 0;               ///< number of slots
  std::uint64_t epoch = 0;     ///< number of the last writer
  std::uint64_t sequence = 0;  ///< sequence of the newest message; 0: none yet
  /// The counters of the writer: see WriterTally.
  /// @{
  std::uint64_t published = 0, dropped = 0;
  std::int64_t pause_ns = 0;
  /// @}
  /// The time stamps in the header of the newest message; 0: none.
  /// @{
  std::int64_t newest_origin_ns = 0, newest_published_ns = 0;
  /// @}
  std::vector<ReaderView> readers;  ///< the rows that have an owner
};

/// A read-only view of a ring for observers, without a reader row and without a lock. Any thread.
class RingView {
 public:
  /// Takes ownership of `fd` and maps it read-only. Errors: see Segment::open().
  static Result<RingView> open(UniqueFd fd);

  /// Reads the state of the ring now.
  RingSnapshot look() const;
  /// Name of the stream.
  std::string stream() const { return segment_.stream(); }
  /// Number of slots.
  int slots() const { return segment_.slots(); }
  /// Number of the writer that published the newest message; 0: no message.
  std::uint64_t epoch() const;
  /// Sequence of the newest message; 0: no message.
  std::uint64_t sequence() const;

 private:
  explicit RingView(Segment segment) : segment_(std::move(segment)) {}
  ReaderView reader_in(int row, std::uint64_t newest, std::int64_t time_ns) const;
  std::int64_t lease_age_ns(int row, int index, std::int64_t time_ns) const;
  Segment segment_;
};

}  // namespace handcast::ipc
