// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/results.hpp"

#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

namespace handcast::pose::openxr {

Errc code_of(XrResult result) {
  switch (result) {
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_SESSION_LOST:
    case XR_ERROR_RUNTIME_FAILURE:
    case XR_ERROR_HANDLE_INVALID:
    case XR_SESSION_LOSS_PENDING:
      return Errc::disconnected;
    default:
      return Errc::bad_data;
  }
}

std::string word_of(XrResult result) {
  switch (result) {
#define HANDCAST_RESULT(name, value) \
  case name:                         \
    return #name;
    XR_LIST_ENUM_XrResult(HANDCAST_RESULT)
#undef HANDCAST_RESULT
        default : return fmt::format("result {}", static_cast<int>(result));
  }
}

}  // namespace handcast::pose::openxr
