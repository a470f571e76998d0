// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace handcast {
namespace {

bool is_descriptor(int fd, const struct stat& status) {
  struct stat other {};
  return ::fstat(fd, &other) == 0 && other.st_dev == status.st_dev && other.st_ino == status.st_ino;
}

const char* kind_of_output(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a disk";
}

}  // namespace

bool is_standard_output(const struct stat& status) {
  return is_descriptor(STDOUT_FILENO, status) || is_descriptor(STDERR_FILENO, status);
}

Result<void> check_output(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};  // opening it says why
  if (S_ISREG(status.st_mode) || S_ISCHR(status.st_mode) || is_standard_output(status)) return {};
  return fail(Errc::bad_config, fmt::format("{}: cannot be written: it is {}, not a file",
                                            file.string(), kind_of_output(status.st_mode)));
}

}  // namespace handcast
