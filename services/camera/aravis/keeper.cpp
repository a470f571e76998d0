// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::camera::aravis {
namespace {

/// An external trigger may pause for any time: only Aravis can tell that the camera is lost.
std::int64_t patience_of(const config::Camera& settings) {
  if (settings.aravis.trigger == config::Trigger::line) return seconds_to_ns(6);
  return Silence::patience_of(settings.rate_hz);
}

}  // namespace

Keeper::Keeper(Device device, const config::Camera& settings, const calib::PlacedCamera& camera,
               std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox)
    : device_(std::move(device)),
      settings_(settings),
      camera_(camera),
      session_(std::move(session)),
      mailbox_(std::move(mailbox)),
      presence_(device_),
      silence_(patience_of(settings)),
      next_trigger_ns_(now_ns()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Keeper::~Keeper() {
  thread_.request_stop();
  thread_.join();
  // Taking leave of an absent camera takes seconds, which nobody has to wait for.
  if (is_lost_) std::thread([session = std::move(session_)] {}).detach();
}

void Keeper::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (is_lost_)
      look_for_it();
    else
      watch();
  }
}

void Keeper::watch() {
  if (settings_.aravis.trigger == config::Trigger::software) {
    // Triggers that came too late are not made up for.
    next_trigger_ns_ = std::max(next_trigger_ns_ + seconds_to_ns(1 / settings_.rate_hz), now_ns());
    sleep_until_ns(next_trigger_ns_);
    (void)session_->trigger();  // if it fails, no image comes, which is seen below
  } else {
    sleep_until_ns(now_ns() + Silence::kTurn_ns);
  }
  const std::int64_t last_ns = mailbox_->last_sign_ns();
  if (is_reopened_ && silence_.is_broken(last_ns)) found("it was opened again");
  if (!silence_.is_too_long(last_ns, now_ns())) return;
  is_lost_ = true;
  if (!is_reopened_) lost_ns_ = now_ns();
}

Error Keeper::why_no_images(bool answers) const {
  if (!answers || silence_.is_broken(mailbox_->last_sign_ns()))
    return {Errc::timeout, fmt::format("{} sends no images; it is opened again as "
                                       "soon as it answers",
                                       device_.id)};
  if (!device_.is_gige() || !session_)
    return {Errc::timeout, fmt::format("{} answers, but none of its images arrives", device_.id)};
  return {Errc::timeout,
          fmt::format("{} answers, but none of its images arrives; packets of {} "
                      "bytes may be too large for the network (aravis.packet_bytes; 1500 "
                      "pass nearly everywhere), or a firewall stops them",
                      device_.id, session_->accepted().packet_bytes)};
}

void Keeper::miss_it(bool answers) {
  const auto why = why_no_images(answers);
  // That it answers is known later than that it is silent.
  if (const auto said = trouble(); said && (!answers || !session_ || said->what == why.what))
    return;
  trouble_.say(why);
}

void Keeper::look_for_it() {
  if (presence_.is_there()) return reopen();
  if (mailbox_->last_sign_ns() > lost_ns_) return found("its images came back");
  miss_it(false);
  sleep_until_ns(now_ns() + Silence::kTurn_ns);
}

void Keeper::reopen() {
  const std::int64_t answered_ns = now_ns();
  // After a cable was plugged in again, the images come back by themselves.
  sleep_until_ns(answered_ns +
                 std::max(2 * Silence::kTurn_ns, seconds_to_ns(3 / settings_.rate_hz)));
  if (mailbox_->last_sign_ns() > answered_ns) return found("its images came back");
  miss_it(true);
  session_.reset();
  auto session = Session::start(device_, settings_, camera_, mailbox_);
  if (!session) {
    trouble_.say(session.error());
    return sleep_until_ns(now_ns() + Silence::kTurn_ns);
  }
  session_ = std::move(*session);
  silence_.begin_again();
  next_trigger_ns_ = now_ns();
  is_lost_ = false;
  is_reopened_ = true;
}

void Keeper::found(std::string_view how) {
  if (trouble())
    log::info("{} is back after {:.0f} ms: {}", device_.id, ns_to_ms(now_ns() - lost_ns_), how);
  is_lost_ = is_reopened_ = false;
  trouble_.end();
}

}  // namespace handcast::camera::aravis
