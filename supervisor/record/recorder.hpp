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

/// Reads the services' stage marks into a ledger and a history: from the supervisor's event loop, a
/// few dozen times a second.
class Recorder {
 public:
  explicit Recorder(double history_s = 60) : history_(history_s) {}
  /// Follows "marks.<service>", behind the descriptor (which stays the caller's), unless it does
  /// already.
  Result<void> follow(std::string service, int ring_fd);
  void poll();
  const Ledger& ledger() const { return ledger_; }
  const History& history() const { return history_; }
  void remember(double history_s) { history_.reach(history_s); }
  /// Since the service's last sign of life, frame or heart-beat; empty if there was none.
  std::optional<double> silence_ms(std::string_view service, std::int64_t now_ns) const;

 private:
  struct Source {
    std::string service;
    ipc::Reader<msg::StageMarks> marks;
    std::uint64_t skipped = 0;  ///< as of the last message
    std::int64_t last_sign_ns = 0;
  };
  std::vector<Source> sources_;
  Ledger ledger_;
  History history_;
};

}  // namespace handcast::supervisor
