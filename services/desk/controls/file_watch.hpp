// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/stat.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

namespace handcast::desk {

/// Notices that a file has been written: looks at it once a second. One thread.
class FileWatch {
 public:
  explicit FileWatch(std::string file) : file_(std::move(file)), seen_(look()) {}

  /// True once after the file was written or replaced, and has stayed as it is from one look to the
  /// next. A file that is gone has not changed: editors take it away for a moment.
  bool has_changed(std::int64_t now_ns) {
    if (now_ns < next_look_ns_) return false;
    next_look_ns_ = now_ns + kPause_ns;
    const auto now = look();
    const bool is_settled = now == std::exchange(last_, now);
    if (now == Look{} || now == seen_ || !is_settled) return false;
    seen_ = now;
    return true;
  }

 private:
  static constexpr std::int64_t kPause_ns = 500'000'000;
  /// Its inode, size and time of the last change.
  using Look = std::tuple<std::uint64_t, std::int64_t, std::int64_t, std::int64_t>;

  Look look() const {
    struct stat found {};
    if (::stat(file_.c_str(), &found) != 0) return {};
    return {found.st_ino, found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
  }

  std::string file_;
  Look seen_, last_{};
  std::int64_t next_look_ns_ = 0;
};

}  // namespace handcast::desk
