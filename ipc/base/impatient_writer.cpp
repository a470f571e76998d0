// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/impatient_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast {
namespace {

constexpr int kLook_ms = 5;

bool is_writable(int fd, int within_ms) {
  pollfd writable{.fd = fd, .events = POLLOUT, .revents = 0};
  return ::poll(&writable, 1, within_ms) > 0;
}

}  // namespace

ImpatientWriter::ImpatientWriter(int fd, std::chrono::milliseconds patience)
    : fd_(fd), patience_(patience) {
  const auto path = fmt::format("/proc/self/fd/{}", fd);
  const UniqueFd own(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (own) ::dup2(own.get(), fd);
}

bool ImpatientWriter::takes(std::string_view text) {
  const auto limit = Deadline::in(is_waited_for_ ? patience_ : std::chrono::milliseconds(0));
  for (;;) {
    const auto taken = write_some(text);
    if (taken > 0) is_cut_ = text[taken - 1] != '\n';
    text.remove_prefix(taken);
    is_waited_for_ = text.empty();
    if (text.empty() || limit.passed()) return text.empty();
    if (taken == 0) is_writable(fd_, kLook_ms);
  }
}

/// The number of bytes that are taken without waiting.
std::size_t ImpatientWriter::write_some(std::string_view text) const {
  if (!is_writable(fd_, 0)) return 0;
  const auto size = std::min<std::size_t>(text.size(), PIPE_BUF);
  auto count = ::send(fd_, text.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (count < 0 && errno == ENOTSOCK) count = ::write(fd_, text.data(), size);
  if (count < 0 && errno != EAGAIN && errno != EINTR) return text.size();  // the reader is gone
  return static_cast<std::size_t>(std::max<ssize_t>(count, 0));
}

}  // namespace handcast
