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
#include "ipc/ring/words.hpp"

namespace handcast::ipc {
namespace {

struct ProcessStatus {
  char state = '?';         ///< 'Z': dead, but nobody has asked for its exit status yet
  std::uint64_t start = 0;  ///< clock ticks since the machine started
};

/// From /proc/PID/stat: "PID (name) state ...", the start time is field 22. The name may hold anything, so count behind it.
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

}  // namespace

std::uint64_t owner_word_of_this_process(std::uint64_t generation) {
  const auto pid = static_cast<std::uint64_t>(::getpid());
  const auto status = status_of(pid);
  return owner_word(generation, status ? status->start : 0, pid);
}

bool owner_is_gone(std::uint64_t owner) {
  const auto pid = pid_of_owner(owner);
  if (pid == 0) return true;
  if (::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) return true;
  const auto status = status_of(pid);
  return status && (status->state == 'Z' || status->start != start_of_owner(owner));
}

}  // namespace handcast::ipc
