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
#include <cstddef>
#include <cstdlib>
#include <mutex>

#include "ipc/base/clock.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast {
namespace {

/// Writes text to a descriptor whose reader may be slow or have stopped: a terminal, a pipe or a
/// socket. One thread at a time.
class ImpatientWriter {
 public:
  /// Makes writing to the descriptor, which stays the caller's, not block: it then refers to a file
  /// of its own, because O_NONBLOCK of the one it shares with other programs would hit these, too.
  /// What cannot be opened anew (a socket, a terminal of another user) is only written when poll(2)
  /// says that it is ready.
  ImpatientWriter(int fd, std::chrono::milliseconds patience);

  /// Writes text. Waits up to `patience` for a reader that is merely slow, but not again before it
  /// has taken all of a text. False if a part of it is lost. A reader that is gone takes
  /// everything.
  bool takes(std::string_view text);
  /// True if the last line that was taken has no end.
  bool is_cut() const { return is_cut_; }

 private:
  std::size_t write_some(std::string_view text) const;

  int fd_;
  std::chrono::milliseconds patience_;
  bool is_cut_ = false;
  bool is_waited_for_ = true;
};

constexpr int kLook_ms = 5;

bool is_writable(int fd, int within_ms) {
  pollfd writable{.fd = fd, .events = POLLOUT, .revents = 0};
  return ::poll(&writable, 1, within_ms) > 0;
}

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

constexpr std::size_t kLongestLine = 2000;

/// What printable() returns, with `indent` before each line but the first.
std::string shown(std::string_view text, std::string_view indent) {
  std::string shown;
  for (;;) {
    const auto end = text.find('\n');
    shown += shown_line(text.substr(0, end), kLongestLine);
    if (end == text.npos) return shown;
    shown.append("\n").append(indent);
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string printable(std::string_view text) { return shown(text, ""); }

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

std::atomic<Level>& threshold() {
  static std::atomic<Level> level{level_from_environment()};
  return level;
}

/// Texts from outside may have line ends: what follows must not look like a line of the log.
constexpr std::string_view kIndent = "  ";

std::string line_of(Level level, std::string_view sentence) {
  return for_journal(
      level, fmt::format("{:.3f} {:<10} {:<7} {}\n", ns_to_seconds(now_ns()), program(),
                         kNames[static_cast<std::size_t>(level)], shown(sentence, kIndent)));
}

/// Stderr after never_wait_for_stderr(), which may lose lines.
class Impatient {
 public:
  explicit Impatient(std::chrono::milliseconds patience) : writer_(STDERR_FILENO, patience) {}

  void put(std::string_view text) {
    const std::lock_guard lock(mutex_);
    if (lost_ > 0 && writer_.takes(missing())) lost_ = 0;
    if (lost_ > 0 || !writer_.takes(text)) lost_ += std::ranges::count(text, '\n');
  }

 private:
  std::string missing() const {
    return (writer_.is_cut() ? "\n" : "") +
           line_of(Level::warning,
                   fmt::format("{} lines that nobody read in time are missing here", lost_));
  }

  std::mutex mutex_;
  ImpatientWriter writer_;
  std::int64_t lost_ = 0;  ///< lines
};

/// Null: stderr is waited for.
std::atomic<Impatient*> impatient{nullptr};

}  // namespace

void set_program(std::string_view name) { program() = name; }
void set_level(Level level) { threshold() = level; }

std::optional<ParsedLine> parse(std::string_view line) {
  if (line.starts_with(kIndent)) return std::nullopt;
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
  if (auto* writer = impatient.load()) return writer->put(text);
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

void never_wait_for_stderr(std::chrono::milliseconds patience) {
  struct stat status {};
  if (::fstat(STDERR_FILENO, &status) != 0 || S_ISREG(status.st_mode)) return;
  if (S_ISCHR(status.st_mode) && ::isatty(STDERR_FILENO) != 1) return;
  static Impatient writer(patience);
  impatient = &writer;
}

}  // namespace handcast::log
