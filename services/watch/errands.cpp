// SPDX-License-Identifier: Apache-2.0
#include "services/watch/errands.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/wait_status.hpp"

namespace handcast::watch {
namespace {

constexpr std::size_t kMostWaiting = 20, kMostPrinted = 400;

/// A file in memory with this text, to be read from its begin: unlike a pipe, it never makes its
/// writer wait. Invalid if there is no memory.
UniqueFd file_with(std::string_view text) {
  UniqueFd file(::memfd_create("errand", MFD_CLOEXEC));
  if (file && ::write(file.get(), text.data(), text.size()) < 0) return {};
  if (file) ::lseek(file.get(), 0, SEEK_SET);
  return file;
}

/// Signals, scheduling and descriptors of a program that a person starts.
struct Plan {
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_t files{};

  Plan(int input, int output, const std::filesystem::path& folder) {
    ::posix_spawnattr_init(&attributes);
    ::posix_spawn_file_actions_init(&files);
    sigset_t all, none;
    ::sigfillset(&all);
    ::sigemptyset(&none);
    const sched_param normal{};
    ::posix_spawnattr_setsigdefault(&attributes, &all);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
    ::posix_spawnattr_setschedparam(&attributes, &normal);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF |
                                                POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSCHEDULER);
    ::posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&files, 3);
    if (!folder.empty()) ::posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  }
  Plan(const Plan&) = delete;
  ~Plan() {
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&files);
  }
};

/// The last line of what a program has printed.
std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return printable(text.substr(text.find_last_of('\n') + 1));
}

}  // namespace

Errands::~Errands() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Errands::add(std::vector<std::string> words, std::string input) {
  if (words.empty()) return;
  if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
  waiting_.push_back({std::move(words), std::move(input)});
}

void Errands::fail_with(const std::string& why) const {
  if (settings_.on_failure) settings_.on_failure(fmt::format("{} {}", quote(name_), why));
}

Result<void> Errands::start(const Errand& errand) {
  std::array<int, 2> ends{};
  const auto input = file_with(errand.input);
  if (!input || ::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(Errc::unavailable, std::strerror(errno));
  output_ = UniqueFd(ends[0]);
  const UniqueFd its_output(ends[1]);
  ::fcntl(output_.get(), F_SETFL, O_NONBLOCK);
  std::vector<char*> words;
  words.reserve(errand.words.size() + 1);
  for (const auto& word : errand.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const Plan plan(input.get(), its_output.get(), settings_.folder);
  const int fault =
      ::posix_spawnp(&pid_, words[0], &plan.files, &plan.attributes, words.data(), environ);
  if (fault == 0) return {};
  pid_ = -1;
  return fail(Errc::unavailable, std::strerror(fault));
}

void Errands::read_output() {
  std::array<char, 4096> bytes{};
  for (int turns = 0; turns < 16; ++turns) {
    const auto count = ::read(output_.get(), bytes.data(), bytes.size());
    if (count <= 0) return;
    printed_.append(bytes.data(), static_cast<std::size_t>(count));
    if (printed_.size() > kMostPrinted) printed_.erase(0, printed_.size() - kMostPrinted);
  }
}

/// Takes note of its end. False while it runs.
bool Errands::has_ended(std::int64_t now_ns) {
  read_output();
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == pid_) {
    read_output();
    const auto said = last_line(printed_);
    if (status != 0)
      fail_with(
          fmt::format("ended with {}{}{}", describe_end(status), said.empty() ? "" : ": ", said));
    return true;
  }
  if (now_ns < ends_ns_) return false;
  ::kill(-pid_, SIGKILL);
  killed_.push_back(pid_);  // it may hang in the kernel, and then it is not waited for
  fail_with(fmt::format("was killed: it took longer than {:g} s", settings_.longest_s));
  return true;
}

void Errands::turn(std::int64_t now_ns) {
  std::erase_if(killed_, [](pid_t pid) { return ::waitpid(pid, nullptr, WNOHANG) != 0; });
  if (pid_ > 0 && !has_ended(now_ns)) return;
  pid_ = -1;
  if (waiting_.empty()) return;
  const auto next = std::move(waiting_.front());
  waiting_.pop_front();
  name_ = next.words.front();
  printed_.clear();
  ends_ns_ = now_ns + seconds_to_ns(settings_.longest_s);
  if (const auto started = start(next); !started)
    fail_with("cannot be started: " + started.error().what);
}

}  // namespace handcast::watch
