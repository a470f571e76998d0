// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "supervisor/record/history.hpp"
#include "supervisor/record/ledger.hpp"

namespace handcast::supervisor {

/// Reads the stage marks of all services into a ledger and a history. Runs in the event loop of the
/// supervisor. One thread.
class Recorder {
 public:
  /// `history_s`: length of the history in seconds.
  explicit Recorder(double history_s = 60) : history_(history_s) {}
  /// Starts reading the ring "marks.<service>", whose descriptor remains owned by the caller. Has
  /// no effect if this service is read already. Errors: those of ipc::Segment::open() and
  /// ipc::Reader::attach().
  Result<void> follow(std::string service, int ring_fd);
  /// Reads the new marks of all services. Call it a few dozen times per second.
  void poll();
  /// The statistics of the run.
  const Ledger& ledger() const { return ledger_; }
  /// The frames of the last seconds.
  const History& history() const { return history_; }
  /// Changes the length of the history.
  void set_history(double history_s) { history_.set_span(history_s); }
  /// Time since the last frame or heartbeat of a service; empty if there was none.
  std::optional<double> silence_ms(std::string_view service, std::int64_t now_ns) const;

 private:
  struct Source {
    std::string service;
    ipc::Reader<msg::StageMarks> marks;
    std::uint64_t skipped = 0;  ///< Reader::skipped() at the last message
    std::int64_t last_sign_ns = 0;
  };
  std::vector<Source> sources_;
  Ledger ledger_;
  History history_;
};

}  // namespace handcast::supervisor
