// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

namespace {

constexpr int kStateField = 3, kParentField = 4, kStartField = 22;

/// A field of a process; "" if there is no such process, or only a zombie.
std::string field_of_living(pid_t pid, int number) {
  const std::filesystem::path folder = fmt::format("/proc/{}", pid);
  const auto state = stat_field(folder, kStateField);
  return state == "Z" || state == "X" ? "" : stat_field(folder, number);
}

}  // namespace

std::string proc_text(const std::filesystem::path& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  std::string text;
  std::array<char, 4096> bytes;
  for (;;) {
    const auto count = fd ? ::read(fd.get(), bytes.data(), bytes.size()) : -1;
    if (count < 0) return {};
    if (count == 0) return text;
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

// "PID (name) state ppid ...": the name may contain any characters, so fields are counted after it.
std::string stat_field(const std::filesystem::path& folder, int number) {
  const auto text = proc_text(folder / "stat");
  const auto behind_name = text.rfind(") ");
  if (behind_name == std::string::npos) return {};
  std::istringstream fields(text.substr(behind_name + 2));
  std::string field;
  for (int i = kStateField; i <= number; ++i)
    if (!(fields >> field)) return {};
  return field;
}

std::string status_line(const std::filesystem::path& folder, std::string_view name) {
  std::istringstream lines(proc_text(folder / "status"));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name) && line.substr(name.size()).starts_with(":\t"))
      return line.substr(name.size() + 2);
  return {};
}

std::uint64_t inode_of(int fd) {
  struct stat status {};
  return fd >= 0 && fstat(fd, &status) == 0 ? status.st_ino : 0;
}

std::optional<std::uint64_t> start_ticks_of(pid_t pid) {
  const auto field = field_of_living(pid, kStartField);
  return field.empty() ? std::nullopt : std::optional(std::strtoull(field.c_str(), nullptr, 10));
}

std::optional<pid_t> parent_of(pid_t pid) {
  const auto field = field_of_living(pid, kParentField);
  return field.empty() ? std::nullopt
                       : std::optional(static_cast<pid_t>(std::strtol(field.c_str(), nullptr, 10)));
}

std::int64_t start_ns_of(std::uint64_t ticks) {
  timespec since_boot{};
  clock_gettime(CLOCK_BOOTTIME, &since_boot);
  const auto started_ns = static_cast<std::int64_t>(ticks) * (1'000'000'000 / sysconf(_SC_CLK_TCK));
  return now_ns() - (since_boot.tv_sec * 1'000'000'000 + since_boot.tv_nsec - started_ns);
}

}  // namespace handcast::supervisor
