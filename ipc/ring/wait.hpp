// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::ipc {

/// How a reader waits for the next message.
enum class Wait {
  spin,        ///< seen within 1 us, for a whole core
  predictive,  ///< sleeps until shortly before a regular stream's next message is due: nearly as
               ///< fast, for some 5 % of a core
  futex,       ///< is woken: 30-60 us
  eventfd,     ///< as futex, and has a descriptor to put into epoll: some 30 us more
};
/// The name of a Wait: "spin", "predictive", … Errors: bad_config, with the names there are.
Result<Wait> parse_wait(std::string_view name);

}  // namespace handcast::ipc
