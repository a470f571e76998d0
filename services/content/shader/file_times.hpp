// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace handcast::content::shader {

/// Tells whether files have changed, appeared or vanished since it was made.
class FileTimes {
 public:
  explicit FileTimes(std::vector<std::filesystem::path> files)
      : files_(std::move(files)), times_(now()) {}
  bool have_changed() const { return now() != times_; }

 private:
  std::vector<std::filesystem::file_time_type> now() const {
    std::vector<std::filesystem::file_time_type> times;
    std::error_code absent;
    for (const auto& file : files_) times.push_back(std::filesystem::last_write_time(file, absent));
    return times;
  }

  std::vector<std::filesystem::path> files_;
  std::vector<std::filesystem::file_time_type> times_;
};

}  // namespace handcast::content::shader
