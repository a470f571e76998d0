// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/log_tail.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "ipc/base/log.hpp"

namespace handcast::supervisor {
void LogTail::append(std::string_view bytes, const std::function<void(std::string_view)>& on_line) {
  for (const char byte : bytes) {
    if (byte != '\n') unfinished_ += byte;
    if (byte == '\n' || unfinished_.size() == kLongestLine) finish_line(on_line);
  }
}

bool LogTail::read_from(int fd, const std::function<void(std::string_view)>& on_line,
                        int most_reads) {
  std::array<char, 4096> bytes;
  for (int i = 0; i < most_reads; ++i) {
    const auto count = ::read(fd, bytes.data(), bytes.size());
    if (count <= 0) return count < 0;
    append({bytes.data(), static_cast<std::size_t>(count)}, on_line);
  }
  return true;
}

void LogTail::finish_line(const std::function<void(std::string_view)>& on_line) {
  const auto logged = log::parse(unfinished_);
  if (logged && logged->level == log::Level::error && logged->sentence == last_sentence())
    on_line(unfinished_.substr(0, unfinished_.size() - logged->sentence.size()) + "as before");
  else
    on_line(unfinished_);
  lines_.push_back(std::move(unfinished_));
  unfinished_.clear();
  if (lines_.size() > kLines) lines_.pop_front();
}

std::vector<std::string> LogTail::last(std::size_t count) const {
  const auto from = lines_.size() - std::min(count, lines_.size());
  return {lines_.begin() + static_cast<std::ptrdiff_t>(from), lines_.end()};
}

std::string LogTail::last_sentence() const {
  if (lines_.empty()) return {};
  const auto logged = log::parse(lines_.back());
  return logged ? std::string(logged->sentence) : lines_.back();
}

}  // namespace handcast::supervisor
