// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::camera::leap {
namespace {

constexpr std::int64_t kPatience_ns = 50'000'000;
/// For the first image of a session.
constexpr std::int64_t kFirstImage_ns = 1'000'000'000;
constexpr std::int64_t kTurn_ns = 5'000'000, kAbsent_ns = 20'000'000;
constexpr int kPatientPeriods = 3;

}  // namespace

Keeper::Keeper(const config::Camera& settings, const calib::Calibration& calibration,
               std::unique_ptr<Session> session, std::shared_ptr<Mailbox> mailbox)
    : settings_(settings),
      calibration_(calibration),
      session_(std::move(session)),
      mailbox_(std::move(mailbox)),
      name_(session_->name()),
      patience_ns_(
          std::max(kPatience_ns, seconds_to_ns(kPatientPeriods / session_->mode().rate_hz))),
      started_ns_(now_ns()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Keeper::~Keeper() {
  thread_.request_stop();
  thread_.join();
}

std::optional<Error> Keeper::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

void Keeper::say(Error trouble) {
  trouble.what = fmt::format("camera 'leap': {}", trouble.what);
  // Whatever it is, it may pass, and the service goes on until then.
  if (trouble.code != Errc::bad_config) trouble.code = Errc::timeout;
  const std::scoped_lock lock(mutex_);
  if (!trouble_ || trouble_->what != trouble.what) log::warning("{}", trouble.what);
  trouble_ = std::move(trouble);
}

void Keeper::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (session_)
      watch();
    else
      reopen();
  }
}

bool Keeper::is_silent() const {
  const std::int64_t last_ns = mailbox_->last_sign_ns();
  return now_ns() > (last_ns > started_ns_ ? last_ns + patience_ns_ : started_ns_ + kFirstImage_ns);
}

void Keeper::watch() {
  sleep_until_ns(now_ns() + kTurn_ns);
  const bool has_come = mailbox_->last_sign_ns() > started_ns_;
  if (has_come && trouble()) {
    log::info("camera: {} is back after {:.0f} ms", name_, ns_to_ms(now_ns() - lost_ns_));
    const std::scoped_lock lock(mutex_);
    trouble_.reset();
  }
  const auto ended = session_->trouble();
  if (!ended && !is_silent()) return;
  vain_starts_ = has_come ? 0 : vain_starts_ + 1;
  if (has_come) lost_ns_ = now_ns();
  if (ended)
    say({ended->code, fmt::format("{}; it is opened again as soon as it answers", ended->what)});
  else if (has_come)
    say({Errc::timeout, fmt::format("{} sends no images; it is opened again", name_)});
  else
    say({Errc::timeout,
         fmt::format("{} answers, but sends no images; firmware before 1.7.1 needs a longer "
                     "bring-up sequence (camera.leap.bring_up)",
                     name_)});
  session_.reset();
}

void Keeper::reopen() {
  // The one that was lost, also if another one is attached meanwhile.
  auto session = Session::start(name_, settings_, calibration_, mailbox_, vain_starts_ > 0);
  if (!session) {
    say({session.error().code, fmt::format("{}: {}; it is opened again as soon as it answers",
                                           name_, session.error().what)});
    return sleep_until_ns(now_ns() + kAbsent_ns);
  }
  session_ = std::move(*session);
  started_ns_ = now_ns();
}

}  // namespace handcast::camera::leap
