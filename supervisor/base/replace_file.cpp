// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

Result<void> replace_file(const std::filesystem::path& path, const std::string& text) {
  const auto fresh = path.string() + ".new";
  unlink(fresh.c_str());
  const UniqueFd file(
      ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  const bool written =
      file && ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (written && rename(fresh.c_str(), path.c_str()) == 0) return {};
  auto error = fail(Errc::unavailable,
                    fmt::format("{} cannot be written: {}", path.string(), std::strerror(errno)));
  unlink(fresh.c_str());
  return error;
}

}  // namespace handcast::supervisor
