// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/version.hpp"

namespace handcast {

std::string_view version() { return HANDCAST_VERSION; }

std::string_view absent_features() { return HANDCAST_ABSENT; }

}  // namespace handcast
