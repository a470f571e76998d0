// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::dlp {

/// How a controller is, each sentence without its name and full stop.
struct Health {
  std::vector<std::string> faults;  ///< what is wrong now
  std::vector<std::string> events;  ///< what has happened since the last look
  std::string waits_for;            ///< what its light waits for; "" if it lights
};

/// The controller of a DLP projector: LEDs, mode, sequence of patterns. It does not carry the
/// picture, which comes by a video cable. One thread. Each call returns by its deadline.
class DlpController {
 public:
  virtual ~DlpController() = default;

  /// What it is: "DLPC350 (serial 7), firmware 3.1.0".
  virtual Result<std::string> identify(Deadline deadline) = 0;

  /// The safe state: LEDs off, sequence stopped, no currents. Does all that can be done, even if a
  /// part of it fails. Errors: unavailable, bad_data, disconnected; it may still light then.
  virtual Result<void> darken(Deadline deadline) = 0;

  /// Reads its status and does the next step towards the light that the rig asks for; to be called
  /// again and again. Darkens it if the video signal or its settings are lost. Errors: bad_data (of
  /// this look), unavailable, disconnected, bad_config.
  virtual Result<Health> tend(Deadline deadline) = 0;
};

/// A row of the table of controllers, which are opened with the rig.
using DlpBackend = service::Backend<DlpController, config::Rig>;
std::span<const DlpBackend> dlp_backends();

/// Opens the controller that dlp.backend names; sends nothing. Errors: bad_config, unavailable.
Result<std::unique_ptr<DlpController>> open_dlp(const config::Rig& rig);

/// Checks what can be checked without a device. Errors: bad_config.
Result<void> check_dlp(const config::Rig& rig);

}  // namespace handcast::dlp
