// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/log_tail.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "ipc/base/text.hpp"

namespace handcast::supervisor {
void LogTail::append(std::string_view bytes, const std::function<void(std::string_view)>& on_line) {
  for (const char byte : bytes) {
    if (byte != '\n') unfinished_ += byte;
    const bool is_cut = unfinished_.size() == kLongestLine;
    if (byte == '\n' || is_cut) finish_line(on_line);
    if (is_cut) unfinished_ = "  ";  // as log::write() begins the further lines of a sentence
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

/// The line without the prefix of handcast's log, or without its indentation.
static std::string_view sentence_of(std::string_view line) {
  const auto logged = log::parse(line);
  return logged ? logged->sentence : trimmed(line);
}

bool LogTail::is_known(std::string_view line) const {
  return std::ranges::any_of(lines_, [sentence = sentence_of(line)](const std::string& other) {
    return sentence_of(other) == sentence;
  });
}

void LogTail::finish_line(const std::function<void(std::string_view)>& on_line) {
  const auto logged = log::parse(unfinished_);
  const bool repeats =
      logged && logged->level == log::Level::error && logged->sentence == last_sentence();
  if (repeats && !leaves_out_known_)
    on_line(unfinished_.substr(0, unfinished_.size() - logged->sentence.size()) + "as before");
  else if (!leaves_out_known_ || !is_known(unfinished_))
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
  return lines_.empty() ? "" : std::string(sentence_of(lines_.back()));
}

}  // namespace handcast::supervisor
