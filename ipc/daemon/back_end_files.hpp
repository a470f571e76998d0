// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::daemon {

/// The back ends of a service that are files of their own, by name: SERVICE/NAME.so in lib/handcast
/// beside the folder of the programs, then in handcast in the folders of $LD_LIBRARY_PATH, which
/// counts as it does for the system's loader. "camera2" has those of "camera".
std::map<std::string, std::filesystem::path, std::less<>> back_end_files(std::string_view service);

/// What a file and the program that loads it must have in common.
struct Abi {
  const char* version;  ///< of handcast and its seams
  std::uint32_t bytes;  ///< of the types in most headers of the seams: others rarely have as many
};

/// The object handcast_SERVICE_back_end of a file, which begins with its Abi; null if there is no
/// such file. The file stays loaded. Errors: bad_config (it is no library, needs one that is not
/// there, has no such object, or was built for another Abi).
Result<const void*> load_back_end(std::string_view service, std::string_view name, const Abi& abi);

}  // namespace handcast::daemon
