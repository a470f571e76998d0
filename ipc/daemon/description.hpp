// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::daemon {

/// A back end of a service, e.g. a driver of a camera.
struct BackendDescription {
  std::string name;      ///< in the rig file
  std::string sentence;  ///< what it is, for people
  /// The sections and settings that it reads, besides those of ServiceDescription::settings.
  std::vector<std::string> settings{};
  bool exclusive = false;  ///< only one process at a time can have its device open
};

/// A service as its program describes itself (`handcast-NAME --describe`, for an instance with
/// `--as INSTANCE`). The build writes one
/// file per service; the supervisor, the reference of settings and the picture in
/// docs/architecture.md are made from them.
struct ServiceDescription {
  std::string name;      ///< "camera"; of an instance of handcast-camera, "camera2"
  std::string summary;   ///< one sentence
  std::string paced_by;  ///< what its loop waits for: "its device", a ring, a setting
  std::vector<std::string> publishes{};   ///< rings it writes, besides its stage marks
  std::vector<std::string> subscribes{};  ///< rings it reads
  /// The sections and settings that it reads with every back end. A change of one of them restarts
  /// the service.
  std::vector<std::string> settings{};
  std::vector<BackendDescription> backends{};  ///< empty if it has none to choose from
};

/// The description as JSON, with a line end.
std::string print_description(const ServiceDescription& description);
/// Reads what print_description() wrote. Errors: bad_data (not JSON, a field is missing or of
/// another type).
Result<ServiceDescription> parse_description(std::string_view json);

/// The table that `--backends` prints: a name and a sentence per line. Empty without back ends.
std::string print_backends(const ServiceDescription& description);

}  // namespace handcast::daemon
