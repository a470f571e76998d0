// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>

#include "ipc/control/pairing.hpp"

namespace handcast::desk {

/// Trades the code that `handcast desk --lan` has printed for a role, once. Any thread.
class Pairings {
 public:
  /// After so many wrong codes the right one is no longer valid either: whoever guesses has one
  /// chance in twenty million.
  static constexpr int kMostWrong = 5;

  explicit Pairings(std::filesystem::path file) : file_(std::move(file)) {}

  /// Errors: bad_data (a wrong code), unavailable (none is valid).
  Result<control::Role> trade(std::string_view code);

 private:
  std::filesystem::path file_;
  std::mutex mutex_;
  std::string guessed_;  ///< the code that the wrong ones were tried for
  int wrong_ = 0;
};

/// Takes as long for every text of the same length.
bool is_same_secret(std::string_view a, std::string_view b);

}  // namespace handcast::desk
