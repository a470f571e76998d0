// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <termios.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

enum class Key { quit, up, down, page_up, page_down, marks };

/// The keys in what a terminal sent; what means nothing is passed over.
std::vector<Key> keys_in(std::string_view bytes);

/// The whole screen of the terminal, given back as it was: at the end, at SIGINT, SIGTERM and
/// SIGHUP, after a crash. One at a time.
class Terminal {
 public:
  static bool present();  ///< keys and screen both

  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;

  struct Size {
    std::size_t columns = 80, rows = 24;
  };
  Size size() const;
  /// Replaces the picture in one write, so that nothing flickers.
  void show(const std::vector<std::string>& lines) const;
  /// Waits for keys, or a signal to quit (Key::quit), or a new size (no key). Empty: it is
  /// `until_ns`.
  std::optional<std::vector<Key>> wait(std::int64_t until_ns) const;

 private:
  UniqueFd signals_;
};

}  // namespace handcast::supervisor
