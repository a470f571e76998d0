// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <dlfcn.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/pose/pose_source.hpp"
#include "tests/services/pose/leapc/fake_leapc.hpp"

namespace handcast::pose {

using namespace std::chrono_literals;
using test::FakeFault;
using test::FakeLeap;

/// The controls of the fake library, as they are at the start.
inline FakeLeap& fresh_leap() {
  static void* library = ::dlopen(FAKE_LEAPC, RTLD_NOW | RTLD_LOCAL);
  if (!library) throw std::runtime_error(::dlerror());
  auto* get = reinterpret_cast<FakeLeap* (*)()>(::dlsym(library, test::kFakeLeapSymbol));
  FakeLeap& leap = *get();
  leap.has_service = leap.has_device = true;
  leap.fault = FakeFault::none;
  leap.hands = 1;
  leap.rate_hz = 110;
  leap.age_ms = 9;
  leap.motion = nullptr;
  leap.mode = -1;
  leap.subscriptions = leap.connected = leap.concurrent_polls = 0;
  return leap;
}

inline config::Rig leapc_rig() {
  config::Rig rig;
  rig.pose.backend = "leapc";
  rig.pose.leapc.library = FAKE_LEAPC;
  return rig;
}

inline std::unique_ptr<PoseSource> open_leapc_source(const config::Rig& rig = leapc_rig()) {
  auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  if (!source) throw std::runtime_error(source.error().what);
  return std::move(*source);
}

/// The next sample within 5 s, whatever is wrong before it. Throws if there is none.
inline msg::HandPoses next_sample(PoseSource& source) {
  const auto until = Deadline::in(5s);
  msg::HandPoses poses;
  while (!until.passed())
    if (source.sample(poses, Deadline::in(100ms))) return poses;
  throw std::runtime_error("no sample");
}

/// Samples until an error of this code comes, for at most 20 s. Its sentence; "" if none came.
inline std::string next_error(PoseSource& source, Errc code) {
  const auto until = Deadline::in(20s);
  msg::HandPoses poses;
  while (!until.passed())
    if (const auto sampled = source.sample(poses, Deadline::in(100ms));
        !sampled && sampled.error().code == code)
      return sampled.error().what;
  return "";
}

}  // namespace handcast::pose
