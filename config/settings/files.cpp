// SPDX-License-Identifier: Apache-2.0
#include "config/settings/files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "ipc/base/input_file.hpp"
#include "ipc/base/output_file.hpp"

namespace handcast::config {
namespace {

bool is_written_in_place(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto kind = std::filesystem::symlink_status(file, unknown);
  return std::filesystem::exists(kind) && !std::filesystem::is_regular_file(kind);
}

}  // namespace

Result<std::string> read_text(const std::filesystem::path& file) {
  return read_input(file, kMostText);
}

Result<void> write_whole(const std::filesystem::path& file, const std::string& text) {
  if (auto possible = check_output(file); !possible) return possible;
  const bool in_place = is_written_in_place(file);
  const auto target = in_place ? file.string() : file.string() + ".tmp";
  errno = 0;
  std::ofstream stream(target, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream || (!in_place && std::rename(target.c_str(), file.c_str()) != 0))
    return fail(Errc::unavailable,
                fmt::format("'{}' cannot be written: {}", file.string(), std::strerror(errno)));
  return {};
}

Result<void> check_writable(const std::filesystem::path& file) {
  if (auto possible = check_output(file); !possible) return possible;
  const auto written_to =
      is_written_in_place(file) ? file : std::filesystem::absolute(file).parent_path();
  if (::access(written_to.c_str(), W_OK) == 0) return {};
  return fail(Errc::bad_config,
              fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

}  // namespace handcast::config
