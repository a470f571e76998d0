// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "config/guests.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/ring/ring_view.hpp"
#include "services/guest/guest_program.hpp"
#include "services/guest/watch.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Ends this process as one that died, so that it is started again with growing pauses.
[[noreturn]] static void give_in(const std::string& why) {
  log::error("{}", why);
  std::_Exit(kExitBadResult);
}

/// Waits until nobody writes to a ring: after a reload, the program before this one still stops.
static void await_leave(const ipc::Segment& ring) {
  for (const auto limit = Deadline::in(2s); !limit.passed();
       sleep_until_ns(now_ns() + to_ns(5ms))) {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_len = 1;  // as ipc::RingWriter takes it
    if (::fcntl(ring.fd(), F_OFD_GETLK, &lock) != 0 || lock.l_type == F_UNLCK) return;
  }
}

/// Runs a program of somebody else until the service ends.
static void run_guest(service::Context& context, const config::Guest& guest) {
  const auto& settings = guest.settings(context.rig());
  context.stand_by();
  const auto ring = must(context.ring(guest.stream()));
  await_leave(ring);
  auto view = ipc::RingView::open(UniqueFd(::dup(ring.fd())));
  guest::Watch watch(must(std::move(view)), settings, now_ns());
  auto program = guest::GuestProgram::start(settings);
  if (!program) give_in(program.error().what);
  bool is_ready = false;
  while (context.running()) {
    program->pass_on_output(Deadline::in(20ms));
    if (const auto end = program->end()) give_in("the program has ended: " + *end);
    if (!is_ready && watch.has_sent()) context.ready(), is_ready = true;
    if (const auto fault = watch.fault(now_ns())) {
      program->stop(Deadline::in(200ms));
      const auto last = program->last_line();
      give_in(fmt::format("the program is started again: {}{}{}", *fault,
                          last.empty() ? "" : "; its last line: ", last));
    }
  }
  program->stop(Deadline::in(1s));
}

static service::Instance instance_of(const config::Guest& guest) {
  daemon::ServiceDescription description{
      .name = std::string(guest.service),
      .summary = "Runs the program that is the back end `external` of " + std::string(guest.feeds),
      .paced_by = "the program",
      .settings = {guest.section()}};
  for (const auto* name : {"wait", "priority", "cores", "lock_memory"})
    description.settings.push_back(fmt::format("{}.process.{}", guest.feeds, name));
  return {std::move(description), [guest](service::Context& context) { run_guest(context, guest); },
          [guest](const config::Rig& rig, const calib::Calibration&) {
            const auto fits = guest::check_command(guest.settings(rig));
            return fits ? fits : fail_in(guest.section(), fits.error());
          }};
}

int main(int argc, char** argv) {
  std::vector<service::Instance> instances;
  instances.reserve(config::kGuests.size());
  for (const auto& guest : config::kGuests) instances.push_back(instance_of(guest));
  return service::run(instances, argc, argv, "guest");
}
