// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/row_owner.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <string>

#include "ipc/base/unique_fd.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"

namespace handcast::ipc {
namespace {

struct ProcessStatus {
  char state = '?';         ///< 'Z': a zombie, dead but not reaped
  std::uint64_t start = 0;  ///< clock ticks since boot, the low 24 bits
};

/// Reads /proc/PID/stat: "PID (name) state ...", with the start time as field 22. The name may
/// contain any characters, so fields are counted from the last ") ".
std::optional<ProcessStatus> status_of(std::uint64_t pid) {
  const UniqueFd file(::open(fmt::format("/proc/{}/stat", pid).c_str(), O_RDONLY | O_CLOEXEC));
  std::array<char, 1024> buffer{};
  const auto length = file ? ::read(file.get(), buffer.data(), buffer.size()) : -1;
  if (length <= 0) return std::nullopt;
  const std::string text(buffer.data(), static_cast<std::size_t>(length));
  auto at = text.rfind(") ");
  if (at == std::string::npos || at + 2 >= text.size()) return std::nullopt;
  ProcessStatus status{.state = text[at + 2]};
  at += 2;
  for (int field = 3; field < 22 && at != std::string::npos; ++field) at = text.find(' ', at + 1);
  if (at == std::string::npos) return std::nullopt;
  status.start = std::strtoull(text.c_str() + at + 1, nullptr, 10) & kPidMask;
  return status;
}

/// True if the process that freed this row died before it had cleared the other words.
bool left_uncleared(const ControlWords<RealAtomics>& words, int row, std::uint64_t owner) {
  const auto stale = [&](const RealAtomics::Word& word) {
    return is_older(RealAtomics::load(word, std::memory_order_relaxed), generation_of(owner));
  };
  bool any = stale(words.wait(row));
  for (int index = 0; index < kLeasesPerRow; ++index) any = any || stale(words.lease(row, index));
  return any;
}

}  // namespace

std::optional<std::uint64_t> owner_word_of_this_process(std::uint64_t generation) {
  const auto pid = static_cast<std::uint64_t>(::getpid());
  const auto status = status_of(pid);
  if (!status) return std::nullopt;
  return owner_word(generation, status->start, pid);
}

bool owner_is_gone(std::uint64_t owner) {
  const auto pid = pid_of_owner(owner);
  if (pid == 0) return true;
  if (::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) return true;
  const auto status = status_of(pid);
  return status && (status->state == 'Z' || status->start != start_of_owner(owner));
}

int sweep_dead_rows(const Segment& segment) {
  const auto words = control_words_of(segment);
  int freed = 0;
  for (int row = 0; row < words.rows(); ++row) {
    const auto owner = RealAtomics::load(words.owner(row), std::memory_order_acquire);
    const bool dead =
        pid_of_owner(owner) == 0 ? left_uncleared(words, row, owner) : owner_is_gone(owner);
    if (dead && claim_row(words, row, owner, free_word(generation_of(owner) + 1))) ++freed;
  }
  return freed;
}

}  // namespace handcast::ipc
