// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/inherited.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>

namespace handcast::inherited {
namespace {

/// A limit as a rig sees it.
struct Limit {
  __rlimit_resource resource;
  std::uint64_t enough;  ///< the least value that no rig reaches
  std::uint64_t unit;    ///< what its figure counts
  const char* sentence;  ///< with {} for the figure
};

constexpr std::uint64_t kUnlimited = RLIM_INFINITY, kMega = 1'000'000;
constexpr std::array kLimits{
    Limit{RLIMIT_FSIZE, kUnlimited, kMega,
          "files may have {} MB at most (ulimit -f): logs and recordings end there, and rings "
          "that need more cannot be made"},
    Limit{RLIMIT_CPU, kUnlimited, 1,
          "each process is ended after {} s of processor time (ulimit -t)"},
    Limit{RLIMIT_AS, 8'000 * kMega, kMega,
          "each process may have {} MB of address space at most (ulimit -v)"},
    Limit{RLIMIT_DATA, 4'000 * kMega, kMega,
          "each process may have {} MB of data at most (ulimit -d)"},
    Limit{RLIMIT_NOFILE, 256, 1, "each process may open {} files at most (ulimit -n)"},
    Limit{RLIMIT_NPROC, 256, 1, "this user may have {} processes at most (ulimit -u)"},
};

std::optional<std::uint64_t> value_of(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

/// The resource that an error number is about.
std::optional<__rlimit_resource> resource_of(int error) {
  switch (error) {
    case EFBIG:
      return RLIMIT_FSIZE;
    case EMFILE:
      return RLIMIT_NOFILE;
    case ENOMEM:
      return RLIMIT_AS;
    case EAGAIN:
      return RLIMIT_NPROC;
    default:
      return std::nullopt;
  }
}

std::string sentence_of(const Limit& limit, std::uint64_t value) {
  return fmt::format(fmt::runtime(limit.sentence), value / limit.unit);
}

}  // namespace

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

bool is_terminal(int fd) {
  const char* kind = std::getenv("TERM");
  return isatty(fd) == 1 && kind && *kind && std::string_view(kind) != "dumb";
}

std::string reason_of(int error) {
  std::string reason = std::strerror(error);
  const auto resource = resource_of(error);
  const auto value = resource ? value_of(*resource) : std::nullopt;
  for (const auto& limit : kLimits)
    if (value && limit.resource == *resource) reason += "; " + sentence_of(limit, *value);
  return reason;
}

std::vector<std::string> obstacles() {
  std::vector<std::string> sentences;
  for (const auto& limit : kLimits)
    if (const auto value = value_of(limit.resource); value && *value < limit.enough)
      sentences.push_back(sentence_of(limit, *value));
  const auto mask = ::umask(0);
  ::umask(mask);
  if ((mask & S_IRWXU) != 0)
    sentences.push_back(fmt::format(
        "the umask {:04o} takes the owner's rights: files that are written cannot be opened again",
        mask));
  return sentences;
}

}  // namespace handcast::inherited
