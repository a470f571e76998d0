// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/apart.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::trial {
namespace {

/// The child: one report a line.
[[noreturn]] void draw_into(int fd, const Wanted& wanted, const Draw& draw) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  draw(wanted, [fd](const Report& report) {
    const auto line = report.dump(-1, ' ', false, Report::error_handler_t::replace) + "\n";
    for (std::size_t done = 0; done < line.size();) {
      const auto count = write(fd, line.data() + done, line.size() - done);
      if (count < 0) _exit(1);
      done += static_cast<std::size_t>(count);
    }
  });
  _exit(0);
}

/// Reads reports until the child ends, or no further one comes in time. Returns the last one, and
/// whether the child has to be ended.
struct Heard {
  std::string last;
  bool is_hung = false;
};
Heard listen(int fd, double patience_s) {
  Heard heard;
  std::string begun;
  std::array<char, 65536> part;
  for (;;) {
    pollfd readable{.fd = fd, .events = POLLIN, .revents = 0};
    const int ready = poll(&readable, 1, static_cast<int>(1000 * patience_s));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return heard.is_hung = true, heard;
    const auto count = read(fd, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return heard;
    begun.append(part.data(), static_cast<std::size_t>(count));
    const auto end = begun.rfind('\n');
    if (end == begun.npos) continue;
    const auto before = end == 0 ? begun.npos : begun.rfind('\n', end - 1);
    heard.last = begun.substr(before == begun.npos ? 0 : before + 1,
                              end - (before == begun.npos ? 0 : before + 1));
    begun.erase(0, end + 1);
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

Report failed(const Wanted& wanted, const char* what) {
  auto report = blank_report(wanted.source);
  report["error"] = fmt::format("no process can be started: {}", what);
  return report;
}

}  // namespace

Report draw_apart(const Wanted& wanted, const Draw& draw) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return failed(wanted, std::strerror(errno));
  const UniqueFd output(ends[0]);
  UniqueFd input(ends[1]);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return failed(wanted, std::strerror(errno));
  if (child == 0) draw_into(input.get(), wanted, draw);
  input.reset();
  const auto heard = listen(output.get(), wanted.patience_s);
  if (heard.is_hung) kill(child, SIGKILL);
  const int status = wait_for(child);
  auto report = heard.last.empty() ? blank_report(wanted.source) : Report::parse(heard.last);
  if (!heard.is_hung && WIFEXITED(status) && WEXITSTATUS(status) == 0) return report;
  report["end"] = heard.is_hung ? "hang" : "crash";
  report["drawn"] = false;
  report["error"] =
      heard.is_hung
          ? fmt::format("it hangs: no step has ended within {:g} s", wanted.patience_s)
          : fmt::format("it crashes ({})",
                        WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "it ended the process");
  return report;
}

}  // namespace handcast::trial
