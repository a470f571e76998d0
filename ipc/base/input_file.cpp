// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace handcast {
namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

/// What a person need not mend is not for good: trying again may help.
tl::unexpected<Error> unreadable(const std::filesystem::path& file, int error) {
  const bool may_pass = error == EIO || error == ESTALE || error == EMFILE || error == ENFILE ||
                        error == ENOMEM || error == ETIMEDOUT;
  return fail(may_pass ? Errc::unavailable : Errc::bad_config,
              fmt::format("{}: cannot be read: {}", file.string(), std::strerror(error)));
}

tl::unexpected<Error> too_large(const std::filesystem::path& file, std::uint64_t size,
                                std::uint64_t most_bytes) {
  return fail(Errc::bad_config, fmt::format("{}: has {} MB; at most {} MB are read", file.string(),
                                            size >> 20, most_bytes >> 20));
}

Result<std::uint64_t> size_of_regular(int fd, const std::filesystem::path& file,
                                      std::uint64_t most_bytes) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return unreadable(file, errno);
  if (!S_ISREG(status.st_mode))
    return fail(Errc::bad_config, fmt::format("{}: cannot be read: it is {}, not a file",
                                              file.string(), kind_of(status.st_mode)));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > most_bytes) return too_large(file, size, most_bytes);
  return size;
}

}  // namespace

Result<UniqueFd> open_input(const std::filesystem::path& file, std::uint64_t most_bytes) {
  // O_NONBLOCK: the other end of a pipe may be missing. It has no effect on a regular file.
  UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  if (!fd) {
    // A socket cannot be opened at all; the kernel's words for it do not help.
    if (errno == ENXIO)
      return fail(Errc::bad_config, file.string() + ": cannot be read: it is not a file");
    return unreadable(file, errno);
  }
  const auto size = size_of_regular(fd.get(), file, most_bytes);
  if (!size) return tl::make_unexpected(size.error());
  return fd;
}

Result<std::string> read_input(const std::filesystem::path& file, std::uint64_t most_bytes) {
  const auto fd = open_input(file, most_bytes);
  if (!fd) return tl::make_unexpected(fd.error());
  const auto size = size_of_regular(fd->get(), file, most_bytes);
  if (!size) return tl::make_unexpected(size.error());
  // Files of /proc and of some network file systems have more bytes than their size says.
  constexpr std::size_t kMore = 4096;
  std::string bytes(*size + kMore, '\0');
  std::size_t count = 0;
  for (;;) {  // a file that is cut meanwhile ends the loop, too
    const auto got = ::read(fd->get(), bytes.data() + count, bytes.size() - count);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(file, errno);
    if (got == 0) break;
    count += static_cast<std::size_t>(got);
    if (count > most_bytes) return too_large(file, count, most_bytes);
    if (count == bytes.size()) bytes.resize(2 * count);
  }
  bytes.resize(count);
  return bytes;
}

}  // namespace handcast
