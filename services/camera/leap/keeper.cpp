// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/keeper.hpp"

#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::camera::leap {
namespace {

constexpr std::int64_t kAbsent_ns = 20'000'000;

}  // namespace

Keeper::Keeper(const config::Camera& settings, const calib::PlacedCamera& camera,
               std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox)
    : settings_(settings),
      camera_(camera),
      session_(std::move(session)),
      mailbox_(std::move(mailbox)),
      name_(session_->name()),
      silence_(Silence::patience_of(session_->mode().rate_hz)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Keeper::~Keeper() {
  thread_.request_stop();
  thread_.join();
}

void Keeper::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (session_)
      watch();
    else
      reopen();
  }
}

void Keeper::watch() {
  sleep_until_ns(now_ns() + Silence::kTurn_ns);
  const std::int64_t last_ns = mailbox_->last_sign_ns();
  const bool has_come = silence_.is_broken(last_ns);
  if (has_come && trouble()) {
    log::info("{} is back after {:.0f} ms", name_, ns_to_ms(now_ns() - lost_ns_));
    trouble_.end();
  }
  const auto ended = session_->trouble();
  if (!ended && !silence_.is_too_long(last_ns, now_ns())) return;
  vain_starts_ = has_come ? 0 : vain_starts_ + 1;
  if (has_come) lost_ns_ = now_ns();
  if (ended)
    trouble_.say(
        {ended->code, fmt::format("{}; it is opened again as soon as it answers", ended->what)});
  else if (has_come)
    trouble_.say({Errc::timeout, fmt::format("{} sends no images; it is opened again", name_)});
  else
    trouble_.say(
        {Errc::timeout,
         fmt::format("{} answers, but sends no images; firmware before 1.7.1 needs a longer "
                     "bring-up sequence (leap.bring_up)",
                     name_)});
  session_.reset();
}

void Keeper::reopen() {
  // The one that was lost, even if another one is attached meanwhile.
  auto session = Session::start(name_, settings_, camera_, mailbox_, vain_starts_ > 0);
  if (!session) {
    trouble_.say(
        {session.error().code, fmt::format("{}: {}; it is opened again as soon as it answers",
                                           name_, session.error().what)});
    return sleep_until_ns(now_ns() + kAbsent_ns);
  }
  session_ = std::move(*session);
  silence_.begin_again();
}

}  // namespace handcast::camera::leap
