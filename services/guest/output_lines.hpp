// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace handcast::guest {

/// What a program prints, by lines, for the log of the rig. A program that prints without end fills
/// no log: kMostLines are passed on within a second, and then none, but a sentence a second that
/// says how many were left out, until it prints less.
class OutputLines {
 public:
  static constexpr int kMostLines = 50;              ///< of a second
  static constexpr std::size_t kLongestLine = 1000;  ///< bytes; longer lines are split

  /// `on_line` gets each line, without its end.
  explicit OutputLines(std::function<void(std::string_view)> on_line)
      : on_line_(std::move(on_line)) {}

  /// Takes bytes that the program has printed.
  void add(std::string_view bytes, std::int64_t now_ns);
  /// Passes on what is left, when the program has ended.
  void finish(std::int64_t now_ns);
  /// The last line that is not empty; "" if there is none. It was perhaps left out.
  const std::string& last() const { return last_; }

 private:
  void end_line(std::int64_t now_ns);
  void begin_second(std::int64_t now_ns);

  std::function<void(std::string_view)> on_line_;
  std::string line_, last_;
  std::int64_t second_ends_ns_ = 0;
  int passed_ = 0, left_out_ = 0;  ///< in this second
  bool is_quiet_ = false;          ///< too many came in the second before
};

}  // namespace handcast::guest
