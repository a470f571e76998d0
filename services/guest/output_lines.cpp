// SPDX-License-Identifier: Apache-2.0
#include "services/guest/output_lines.hpp"

#include <fmt/format.h>

#include <utility>

namespace handcast::guest {
namespace {
constexpr std::int64_t kSecond_ns = 1'000'000'000;
}

void OutputLines::add(std::string_view bytes, std::int64_t now_ns) {
  begin_second(now_ns);
  for (const char byte : bytes) {
    if (byte != '\n') line_ += byte;
    if (byte == '\n' || line_.size() == kLongestLine) end_line(now_ns);
  }
}

void OutputLines::finish(std::int64_t now_ns) {
  if (!line_.empty()) end_line(now_ns);
  begin_second(second_ends_ns_);
}

void OutputLines::begin_second(std::int64_t now_ns) {
  if (now_ns < second_ends_ns_) return;
  second_ends_ns_ = now_ns + kSecond_ns;
  if (left_out_ > 0) on_line_(fmt::format("it prints too much: {} lines were left out", left_out_));
  is_quiet_ = passed_ + left_out_ > kMostLines;
  passed_ = left_out_ = 0;
}

void OutputLines::end_line(std::int64_t now_ns) {
  begin_second(now_ns);
  if (line_.empty()) return;
  if (passed_ < kMostLines && !is_quiet_) {
    ++passed_;
    on_line_(line_);
  } else {
    ++left_out_;
  }
  last_ = std::exchange(line_, {});
}

}  // namespace handcast::guest
