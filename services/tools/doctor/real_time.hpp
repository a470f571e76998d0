// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Tries whether the process of a service may have a real-time priority. Returns why not; "" if it
/// may.
using TryPriority = std::function<std::string(const std::string& service, int priority)>;

/// Lets the program of the service try, because it may have capabilities that this one lacks.
std::string try_in_its_program(const std::string& service, int priority);

/// Whether the services get the real-time priorities of the rig.
Finding examine_real_time(const config::Rig& rig, const TryPriority& may = try_in_its_program);

}  // namespace handcast::doctor
