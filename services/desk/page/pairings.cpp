// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include "ipc/base/log.hpp"
#include "services/desk/page/access.hpp"

namespace handcast::desk {

bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

Result<control::Role> Pairings::trade(std::string_view code) {
  const std::lock_guard lock(mutex_);
  const auto pairing = control::read_pairing(file_);
  if (!pairing)
    return fail(Errc::unavailable,
                "There is no code that is valid; `handcast desk --lan` prints one.");
  if (guessed_ != pairing->code) wrong_ = 0;
  guessed_ = pairing->code;
  const bool is_right = is_same_secret(code, pairing->code);
  if (!is_right && ++wrong_ < kMostWrong)
    return fail(Errc::bad_data, "This is not the code that `handcast desk --lan` has printed.");
  // Whoever removes the file has it, also if two processes of the desk were asked.
  const bool is_first = ::unlink(file_.c_str()) == 0;
  if (is_right && is_first) return pairing->role;
  if (!is_right)
    log::warning("page: {} wrong codes were tried, so the right one is no longer valid", wrong_);
  return fail(Errc::unavailable,
              "The code is no longer valid; `handcast desk --lan` prints another one.");
}

}  // namespace handcast::desk
