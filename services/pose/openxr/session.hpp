// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "config/sections/openxr.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "services/pose/openxr/sampler.hpp"

namespace handcast::pose::openxr {

/// A session without a display with an OpenXR runtime, through the loader. A process may have one
/// at a time. One thread.
class Session {
 public:
  /// Starts the runtime that the settings name and waits until it has made a session ready. Errors:
  /// unavailable (there is no runtime now, or nothing is attached to it, or it is not ready by the
  /// deadline), bad_config (it lacks an extension).
  static Result<std::unique_ptr<Session>> open(const config::OpenXr& settings, Deadline deadline);
  virtual ~Session() = default;

  /// Reacts to what the runtime has to say. Call it before each locate(). Errors: timeout (the
  /// runtime has stopped the session and may start it again), disconnected (session or instance
  /// are lost).
  virtual Result<void> tend() = 0;
  /// Both hands at a time of CLOCK_MONOTONIC. Errors: disconnected (as tend()), bad_data (the
  /// runtime cannot tell for this time).
  virtual Result<Answers> locate(std::int64_t time_ns) = 0;
  /// Runtime and system, for people: "Monado 21.0.0, 'Simulated HMD'".
  virtual const std::string& name() const = 0;
};

}  // namespace handcast::pose::openxr
