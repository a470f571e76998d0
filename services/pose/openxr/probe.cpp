// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/probe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "ipc/base/unique_fd.hpp"
#include "services/pose/openxr/session.hpp"

namespace handcast::pose::openxr {
namespace {

using namespace std::chrono_literals;

constexpr auto kReady = 5s;
constexpr unsigned kAnswer_s = 10;
constexpr char kGood = '+';  ///< before a name; other first characters: 'a' + code of an error

/// The child: writes its answer and ends.
[[noreturn]] void answer(const config::OpenXr& settings, int to) {
  std::signal(SIGALRM, SIG_DFL);
  ::alarm(kAnswer_s);
  const auto session = Session::open(settings, Deadline::in(kReady));
  const auto text = session ? kGood + (*session)->name()
                            : static_cast<char>('a' + static_cast<int>(session.error().code)) +
                                  session.error().what;
  const bool is_written =
      ::write(to, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::_exit(is_written ? 0 : 1);
}

std::string read_to_end(int from) {
  std::string text;
  std::array<char, 1024> bytes;
  for (ssize_t count = 0; (count = ::read(from, bytes.data(), bytes.size())) != 0;) {
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) break;
  }
  return text;
}

}  // namespace

Result<std::string> probe(const config::OpenXr& settings) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(Errc::unavailable, "no pipe to a process that asks the runtime");
  const UniqueFd from(ends[0]);
  UniqueFd to(ends[1]);
  const auto child = ::fork();
  if (child == 0) answer(settings, to.get());
  to = UniqueFd();
  if (child < 0) return fail(Errc::unavailable, "no process that asks the runtime");
  const auto text = read_to_end(from.get());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return fail(Errc::unavailable,
                fmt::format("the OpenXR runtime does not answer within {} s", kAnswer_s));
  if (text.empty())
    return fail(Errc::unavailable,
                fmt::format("the OpenXR runtime has crashed (status {:#x})", status));
  if (text.front() == kGood) return text.substr(1);
  return fail(static_cast<Errc>(text.front() - 'a'), text.substr(1));
}

}  // namespace handcast::pose::openxr
