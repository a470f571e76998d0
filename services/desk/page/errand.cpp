// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/errand.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::desk {
namespace {

constexpr std::int64_t kGrace_ns = 5'000'000'000;  ///< between SIGTERM and SIGKILL
constexpr int kTurn_ms = 50;

/// In the child: only calls that are safe after a fork of a program with threads.
[[noreturn]] void become(char* const* arguments, int output, int log, pid_t parent) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  const bool in_place = nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 &&
                        ::dup2(output, STDOUT_FILENO) >= 0 && ::dup2(log, STDERR_FILENO) >= 0;
  ::setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // If the desk is killed, nothing that it has started goes on.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (in_place && ::getppid() == parent) ::execv(arguments[0], arguments);
  ::_exit(127);
}

}  // namespace

/// A program and what it writes.
struct Errand::Child {
  pid_t pid = -1;
  UniqueFd output, log;

  static Child start(std::vector<std::string> words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    Child child;
    std::array<int, 2> output{}, log{};
    if (::pipe2(output.data(), O_CLOEXEC | O_NONBLOCK) != 0) return child;
    child.output = UniqueFd(output[0]);
    const UniqueFd its_output(output[1]);
    if (::pipe2(log.data(), O_CLOEXEC | O_NONBLOCK) != 0) return child;
    child.log = UniqueFd(log[0]);
    const UniqueFd its_log(log[1]);
    for (const int fd : {output[1], log[1]}) ::fcntl(fd, F_SETFL, 0);  // it waits for this end
    const pid_t self = ::getpid();
    child.pid = ::fork();
    if (child.pid == 0) become(arguments.data(), output[1], log[1], self);
    return child;
  }

  void wait() const {
    std::array<pollfd, 2> ends{{{output.get(), POLLIN, 0}, {log.get(), POLLIN, 0}}};
    ::poll(ends.data(), ends.size(), kTurn_ms);
    // An end that was closed is ready all the time.
    if ((ends[0].revents | ends[1].revents) & POLLHUP) ::usleep(1000 * kTurn_ms);
  }
  /// With those that it has started.
  void signal(int what) const {
    if (::kill(-pid, what) != 0) ::kill(pid, what);
  }
};

Errand::Errand(std::chrono::seconds longest) : longest_(longest), thread_([this] { work(); }) {}

Errand::~Errand() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = must_stop_ = true;
  }
  news_.notify_all();
  thread_.join();
}

Result<void> Errand::start(std::vector<std::string> words) {
  {
    const std::lock_guard lock(mutex_);
    if (state_.is_running) return fail(Errc::unavailable, "It is running already.");
    state_ = {.is_running = true, .seconds = 0, .output = {}, .log = {}, .exit_code = -1};
    begun_ns_ = now_ns();
    must_stop_ = is_closed_;
    wanted_ = std::move(words);
  }
  news_.notify_all();
  return {};
}

bool Errand::stop() {
  const std::lock_guard lock(mutex_);
  if (state_.is_running) must_stop_ = true;
  return state_.is_running;
}

Errand::State Errand::state() const {
  const std::lock_guard lock(mutex_);
  auto state = state_;
  if (state.is_running) state.seconds = ns_to_seconds(now_ns() - begun_ns_);
  return state;
}

void Errand::work() {
  for (;;) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return is_closed_ || wanted_; });
    if (is_closed_) return;
    auto words = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    run(std::move(words));
  }
}

void Errand::keep(std::string State::*where, std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  auto& text = state_.*where;
  text += bytes.substr(0, kMostBytes - std::min(kMostBytes, text.size()));
}

bool Errand::is_over(std::int64_t begin_ns) const {
  const std::lock_guard lock(mutex_);
  return must_stop_ || now_ns() > begin_ns + std::chrono::nanoseconds(longest_).count();
}

void Errand::run(std::vector<std::string> words) {
  const auto name = words.front();
  const auto child = Child::start(std::move(words));
  const auto read_all = [&] {
    std::array<char, 4096> bytes;
    for (const auto& [fd, where] :
         {std::pair(child.output.get(), &State::output), std::pair(child.log.get(), &State::log)})
      for (ssize_t count = 0; (count = ::read(fd, bytes.data(), bytes.size())) > 0;)
        keep(where, {bytes.data(), static_cast<std::size_t>(count)});
  };
  int status = 127 << 8;
  const auto begin_ns = now_ns();
  std::int64_t asked_ns = 0;
  for (bool runs = child.pid > 0; runs;) {
    child.wait();
    read_all();
    const auto ended = ::waitpid(child.pid, &status, WNOHANG);
    runs = ended == 0 || (ended < 0 && errno == EINTR);
    if (!runs || !is_over(begin_ns)) continue;
    if (asked_ns == 0) child.signal(SIGTERM), asked_ns = now_ns();
    if (now_ns() > asked_ns + kGrace_ns) child.signal(SIGKILL);
  }
  if (child.pid > 0) read_all();
  const bool is_missing = WIFEXITED(status) && WEXITSTATUS(status) == 127;
  if (is_missing) keep(&State::log, name + " cannot be started\n");
  const std::lock_guard lock(mutex_);
  state_.seconds = ns_to_seconds(now_ns() - begun_ns_);
  state_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  state_.is_running = false;
}

}  // namespace handcast::desk
