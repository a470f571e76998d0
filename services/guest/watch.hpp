// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "config/sections/external.hpp"
#include "ipc/ring/ring_view.hpp"

namespace handcast::guest {

/// The heart of a program that knows no supervisor: that it sends. One thread.
class Watch {
 public:
  /// `ring`: where it sends to. It was started at `started_ns`.
  Watch(ipc::RingView ring, const config::External& settings, std::int64_t started_ns);

  /// True from its first message on.
  bool has_sent();
  /// Why it must be started again: it has sent nothing for too long. Empty if it need not.
  std::optional<std::string> fault(std::int64_t now_ns);

 private:
  ipc::RingView ring_;
  double silent_s_, first_s_;
  std::uint64_t before_;      ///< the newest message before the program was started
  std::uint64_t newest_ = 0;  ///< the newest one that was seen
  std::int64_t heard_ns_;
};

}  // namespace handcast::guest
