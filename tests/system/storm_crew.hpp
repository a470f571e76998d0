// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "ipc/ring/reader.hpp"
#include "ipc/shm/segment.hpp"

/// The processes of the ring storm: one writer and several readers per ring. Each may be killed at
/// any time.
namespace handcast::storm {

struct ReaderKind {
  const char* name;
  ipc::Wait wait;
  ipc::Hold hold;
  bool in_order;  ///< reads by next(), otherwise by latest()
};
inline constexpr std::array<ReaderKind, 5> kReaderKinds{{
    {"copies, futex, next", ipc::Wait::futex, ipc::Hold::copy, true},
    {"copies, predictive, latest", ipc::Wait::predictive, ipc::Hold::copy, false},
    {"leases, futex, latest", ipc::Wait::futex, ipc::Hold::lease, false},
    {"leases, predictive, next", ipc::Wait::predictive, ipc::Hold::lease, true},
    {"leases, eventfd, next", ipc::Wait::eventfd, ipc::Hold::lease, true},
}};

/// The notes of a process in memory that outlives it. `seen` and `turn` are of the last process.
struct Notes {
  std::atomic<std::uint64_t> turn{0};  ///< odd while it waits for a message
  std::atomic<std::uint64_t> seen{0};  ///< sequence of the last message
  std::atomic<std::uint64_t> messages{0}, torn{0}, backwards{0}, refused{0}, no_slot{0};
};

/// A writer or a reader, over many processes.
class Seat {
 public:
  Seat(const ipc::Segment& ring, const ReaderKind* reader, Notes& notes)
      : ring_(ring), reader_(reader), notes_(notes) {}
  ~Seat() { kill(); }
  Seat(const Seat&) = delete;

  void start(std::uint64_t seed);
  void kill();  ///< kills the process and waits for its end
  void stop_for_a_while(bool stop);

  bool is_reader() const { return reader_ != nullptr; }
  std::string name() const;
  pid_t pid() const { return pid_; }
  const ipc::Segment& ring() const { return ring_; }
  const Notes& notes() const { return notes_; }

 private:
  const ipc::Segment& ring_;
  const ReaderKind* reader_;  ///< null: the writer
  Notes& notes_;
  pid_t pid_ = -1;
};

}  // namespace handcast::storm
