// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/real_time.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "ipc/base/join.hpp"
#include "ipc/base/program.hpp"
#include "services/tools/devices/ask.hpp"

namespace handcast::doctor {

/// That of "camera2" is handcast-camera.
static std::string program_of(const std::string& service) {
  return program_folder() / ("handcast-" + service.substr(0, service.find('2')));
}

std::string try_in_its_program(const std::string& service, int priority) {
  const auto answer = devices::ask(
      {program_of(service), "--try-priority", fmt::to_string(priority)}, STDOUT_FILENO);
  if (!answer || answer->exit_code != 0) return "its program does not start";
  return answer->text.substr(0, answer->text.find('\n'));
}

Finding examine_real_time(const config::Rig& rig, const TryPriority& may) {
  std::vector<std::string> permitted, denied;
  std::set<std::string> programs;
  for (const auto* service :
       {"camera", "camera2", "pose", "landmarks", "landmarks2", "projector", "projector2"}) {
    const int priority = config::process_of(rig, service).priority;
    if (priority == 0) continue;
    const auto why = may(service, priority);
    if (why.empty()) {
      permitted.push_back(fmt::format("{} {}", service, priority));
    } else {
      denied.push_back(fmt::format("{} {} ({})", service, priority, why));
      programs.insert(program_of(service));
    }
  }
  if (permitted.empty() && denied.empty())
    return {"real time", Grade::advice, "no service has a real-time priority",
            "set camera.process.priority and projector.process.priority to 50"};
  if (denied.empty())
    return {"real time", Grade::good, "tried, and permitted: " + join(permitted, ", "), ""};
  return {"real time", Grade::fault, "tried, and denied: " + join(denied, ", "),
          getuid() == 0
              ? "the superuser lacks CAP_SYS_NICE here; start the container with "
                "--cap-add=SYS_NICE"
              : fmt::format("run it as a unit of `handcast install-units --system`; or add '{} - "
                            "rtprio 90' to /etc/security/limits.d/handcast.conf and log in again; "
                            "or sudo setcap cap_sys_nice+ep {}",
                            "@plugdev", join(programs, " "))};
}

}  // namespace handcast::doctor
