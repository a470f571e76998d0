// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"

#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/base/wording.hpp"

namespace handcast {

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f)
      shown += fmt::format("\\x{:02x}", byte);
    else
      shown += c;
  }
  return shown;
}

}  // namespace handcast

namespace handcast::log {
namespace {

constexpr std::array<std::string_view, 4> kNames{"debug", "info", "warning", "error"};

Level level_from_environment() {
  const char* wanted = std::getenv("HANDCAST_LOG");
  for (std::size_t i = 0; wanted && i < kNames.size(); ++i)
    if (kNames[i] == wanted) return static_cast<Level>(i);
  return Level::info;
}

/// systemd names its socket "DEVICE:INODE". Services of a rig inherit the variable, but their
/// stderr is a pipe to the supervisor, which adds the priority when it prints the line.
bool stderr_is_journal() {
  const char* journal = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  return journal && ::fstat(STDERR_FILENO, &status) == 0 &&
         fmt::format("{}:{}", status.st_dev, status.st_ino) == journal;
}

/// The priorities of syslog(3) for the levels.
std::string_view priority_of(Level level) {
  constexpr std::array<std::string_view, 4> kPriorities{"<7>", "<6>", "<4>", "<3>"};
  return kPriorities[static_cast<std::size_t>(level)];
}

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  const auto word = text.substr(0, text.find(' '));
  text.remove_prefix(word.size());
  return word;
}

std::string& program() {
  static std::string name = "handcast";
  return name;
}

using Wording = std::string (*)(std::string_view);
Wording& wording_of() {
  static Wording wording = printable;
  return wording;
}

std::atomic<Level>& threshold() {
  static std::atomic<Level> level{level_from_environment()};
  return level;
}

std::string line_of(Level level, std::string_view sentence) {
  return for_journal(level, fmt::format("{:.3f} {:<10} {:<7} {}\n", ns_to_seconds(now_ns()),
                                        program(), kNames[static_cast<std::size_t>(level)],
                                        printable(wording_of()(sentence))));
}

/// Set by never_wait_for_stderr(): how long stderr is waited for; negative: without end.
std::atomic<std::chrono::milliseconds> patience{std::chrono::milliseconds(-1)};

/// Writes to stderr, whose reader may be slow or have stopped.
class Impatient {
 public:
  void put(std::string_view text) {
    const std::lock_guard lock(mutex_);
    if (lost_ > 0 && takes((is_cut_ ? "\n" : "") +
                           line_of(Level::warning, fmt::format("{} lines that nobody read in time "
                                                               "are missing here",
                                                               lost_))))
      lost_ = 0;
    if (lost_ > 0 || !takes(text)) lost_ += std::ranges::count(text, '\n');
  }

 private:
  /// Waits for a reader that is merely slow, but not again before it has taken something.
  bool takes(std::string_view text) {
    const auto limit =
        Deadline::in(is_waited_for_ ? patience.load() : std::chrono::milliseconds(0));
    for (auto rest = text;;) {
      const auto taken = write_some(rest);
      is_cut_ = taken < rest.size() && (taken > 0 ? rest[taken - 1] != '\n' : is_cut_);
      rest.remove_prefix(taken);
      is_waited_for_ = rest.empty();
      if (rest.empty() || limit.passed()) return rest.empty();
      pollfd writable{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
      if (taken == 0) ::poll(&writable, 1, 5);
    }
  }

  /// Without waiting, if stderr is ready: what cannot be made non-blocking takes PIPE_BUF bytes
  /// then.
  static std::size_t write_some(std::string_view text) {
    pollfd writable{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    if (::poll(&writable, 1, 0) <= 0) return 0;
    const auto size = std::min<std::size_t>(text.size(), PIPE_BUF);
    auto count = ::send(STDERR_FILENO, text.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && errno == ENOTSOCK) count = ::write(STDERR_FILENO, text.data(), size);
    if (count < 0 && errno != EAGAIN && errno != EINTR) return text.size();  // it is gone
    return static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }

  std::mutex mutex_;
  std::int64_t lost_ = 0;      ///< lines
  bool is_cut_ = false;        ///< the last line that was taken has no end
  bool is_waited_for_ = true;  ///< it has taken all of the last text
};

}  // namespace

void set_program(std::string_view name) { program() = name; }
void set_level(Level level) { threshold() = level; }
void set_wording(std::string (*wording)(std::string_view sentence)) { wording_of() = wording; }

std::optional<ParsedLine> parse(std::string_view line) {
  take_word(line);  // time
  take_word(line);  // program
  const auto found = std::ranges::find(kNames, take_word(line));
  if (found == kNames.end()) return std::nullopt;
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return ParsedLine{static_cast<Level>(found - kNames.begin()), line};
}

std::string for_journal(Level level, std::string text) {
  if (!stderr_is_journal()) return text;
  std::string marked;
  for (std::string_view rest = text; !rest.empty();) {
    const auto line = rest.substr(0, rest.find('\n'));
    marked += fmt::format("{}{}\n", priority_of(level), line);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  return marked;
}

void write(Level level, std::string_view line) {
  if (level >= threshold().load(std::memory_order_relaxed)) put(line_of(level, line));
}

void put(std::string_view text) {
  if (patience.load().count() < 0) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    return;
  }
  static Impatient stderr_writer;
  stderr_writer.put(text);
}

void never_wait_for_stderr(std::chrono::milliseconds most) {
  struct stat status {};
  if (::fstat(STDERR_FILENO, &status) != 0) return;
  if (S_ISREG(status.st_mode) || (S_ISCHR(status.st_mode) && ::isatty(STDERR_FILENO) != 1)) return;
  // Opened anew, because O_NONBLOCK belongs to what is open, which the shell shares. A socket, and
  // what another user has opened, cannot be.
  const UniqueFd own(::open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (own) ::dup2(own.get(), STDERR_FILENO);
  patience = most;
}

}  // namespace handcast::log
