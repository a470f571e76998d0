// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/requests.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/msg/test_picture.hpp"
#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {

namespace {

nlohmann::json success_of(const Service& service) {
  auto answer = control::success();
  if (const auto pause_ms = service.pause_ms()) answer["pause_ms"] = *pause_ms;
  return answer;
}

}  // namespace

void Changes::restart(Service& service, ControlServer::Reply reply) {
  auto& pending = pending_[service.spec().name] = {std::move(reply)};
  pending.until_ns = rig_.settled_by(now_ns());
  if (!service.works()) return service.restart();
  replace(service, service.spec().backend, pending);
}

void Changes::swap(Service& service, const std::string& backend, ControlServer::Reply reply) {
  const auto name = service.spec().name;
  if (const auto known = check_backend(rig_.catalogue, name, backend); !known)
    return reply(control::failure(known.error().what));
  auto& pending = pending_[name] = {std::move(reply), backend, service.spec().backend};
  pending.until_ns = rig_.settled_by(now_ns());
  if (!service.works()) return give_backend(service, backend, true);
  replace(service, backend, pending);
}

/// Prepares a replacement. A standby that was started with the same settings is one already.
void Changes::replace(Service& service, const std::string& backend, Pending& pending) {
  const auto& name = service.spec().name;
  const bool is_swap = !pending.wanted.empty();
  auto wanted = service.settings();
  wanted.spec.backend = backend;
  wanted.spec.fingerprint =
      fingerprint_of(name, with_backend(rig_.config, name, backend), rig_.catalogue);
  if (is_swap) wanted.swapped = backend;
  const bool is_same = !is_swap && wanted.spec.fingerprint == service.spec().fingerprint;
  const bool alone = is_exclusive(rig_.catalogue, name, service.spec().backend) &&
                     is_exclusive(rig_.catalogue, name, backend);
  pending.is_replacing = true;
  service.prepare(std::move(wanted), {.on_trial = is_swap, .alone = alone}, is_same);
  if (service.replacement_is_prepared()) hand_over(service, pending);
}

void Changes::hand_over(Service& service, Pending& pending) {
  pending.is_replacing = false;
  pending.until_ns = rig_.settled_by(now_ns());
  service.hand_over();
}

void Changes::tick(std::int64_t now_ns) {
  for (auto next = pending_.begin(); next != pending_.end();) {
    const auto found = next++;
    auto& [name, pending] = *found;
    auto& service = *rig_.services.find(name);
    if (!pending.is_replacing) {
      if (now_ns < pending.until_ns) continue;
      const auto sentence = fmt::format("{} is not ready yet, and goes on trying: {}", name,
                                        service.log().last_sentence());
      pending_.extract(found).mapped().reply(control::failure(sentence));
    } else if (service.replacement_is_prepared()) {
      hand_over(service, pending);
    } else if (!service.has_replacement()) {
      const auto what = pending.wanted.empty()
                            ? fmt::format("{} was not restarted", name)
                            : fmt::format("{} did not start with '{}'", name, pending.wanted);
      const auto old =
          pending.before.empty() ? "the old process" : fmt::format("'{}'", pending.before);
      const auto rest = old + (service.works() ? " goes on" : " does not work either");
      const auto sentence = fmt::format("{}, {}: {}", what, rest, service.replacement_problem());
      pending_.extract(found).mapped().reply(control::failure(sentence));
    }
  }
}

/// Restarts a service with another back end and updates its fingerprint.
void Changes::give_backend(Service& service, const std::string& backend, bool on_trial) {
  auto spec = service.spec();
  spec.fingerprint =
      fingerprint_of(spec.name, with_backend(rig_.config, spec.name, backend), rig_.catalogue);
  service.update(spec);
  service.use_backend(backend, on_trial);
}

bool Changes::is_replacing(const Service& service) const {
  const auto found = pending_.find(service.spec().name);
  return found != pending_.end() && found->second.is_replacing;
}

void Changes::on_ready(const Service& service) {
  if (is_replacing(service)) return;  // the old worker died and was started again
  const auto pending = pending_.extract(service.spec().name);
  if (!pending) return;
  const auto& name = pending.key();
  const auto& change = pending.mapped();
  if (!change.reason.empty())
    change.reply(
        control::failure(fmt::format("{} did not start with '{}', '{}' was started again: {}", name,
                                     change.wanted, change.before, change.reason)));
  else if (!service.replacement_problem().empty())
    change.reply(
        control::failure(fmt::format("the new process of {} failed, and the old one had "
                                     "stopped and was started again: {}",
                                     name, service.replacement_problem())));
  else
    change.reply(success_of(service));
}

void Changes::on_stopped(const Service& service) {
  if (is_replacing(service)) return;
  if (const auto pending = pending_.extract(service.spec().name))
    pending.mapped().reply(control::failure(pending.key() + " ended by itself"));
}

bool Changes::on_failed(Service& service) {
  const auto found = pending_.find(service.spec().name);
  if (found == pending_.end()) return false;
  if (found->second.is_replacing) return true;
  const auto sentence = service.log().last_sentence();
  auto& pending = found->second;
  if (!pending.wanted.empty() && pending.reason.empty()) {
    pending.reason = sentence;
    give_backend(service, pending.before, false);
    return true;
  }
  pending_.extract(found).mapped().reply(
      control::failure(fmt::format("{} failed: {}", service.spec().name, sentence)));
  return false;
}

void Changes::refuse_all(const std::string& sentence) {
  for (const auto& [name, pending] : std::exchange(pending_, {}))
    pending.reply(control::failure(sentence));
}

namespace {

using control::failure;
using control::success;
using control::Verb;
using Reply = ControlServer::Reply;

void give_status(LiveRig& rig, const Reply& reply) {
  rig.recorder.poll();
  auto answer = success();
  answer["status"] = to_json(figures_of(rig.view()));
  reply(answer);
}

/// Only the rings that no service writes to may be changed by a tool; the others not even by
/// accident.
int access_to(std::string_view stream) {
  const bool is_for_tools = stream == msg::kTestPictures || stream == msg::kLiveSettings;
  return msg::is_for_guests(stream) || is_for_tools ? O_RDWR : O_RDONLY;
}

void give_rings(const LiveRig& rig, const Reply& reply) {
  auto answer = success();
  answer["rings"] = nlohmann::json::array();
  std::vector<UniqueFd> owned;
  std::vector<int> descriptors;
  for (const auto& [stream, fd] : rig.launch.rings) {
    owned.emplace_back(
        ::open(fmt::format("/proc/self/fd/{}", fd).c_str(), access_to(stream) | O_CLOEXEC));
    if (!owned.back())
      return reply(failure(
          fmt::format("ring '{}' cannot be opened again: {}", stream, std::strerror(errno))));
    answer["rings"].push_back(stream);
    descriptors.push_back(owned.back().get());
  }
  reply(answer, descriptors);
}

void give_history(LiveRig& rig, const control::Request& request, const Reply& reply) {
  rig.recorder.poll();
  const auto longest_s = ns_to_seconds(now_ns());
  const auto since_ns = now_ns() - seconds_to_ns(std::min(request.seconds, longest_s));
  const auto snapshot = rig.recorder.history().snapshot(since_ns);
  if (!snapshot) return reply(failure(snapshot.error().what));
  reply(success(), {snapshot->get()});
}

/// Sends the rig as it runs, swapped back ends included, for tools that need its calibration and
/// settings.
void give_rig(const LiveRig& rig, const std::filesystem::path& file, const Reply& reply) {
  auto answer = success();
  answer["rig"] = rig.text();
  answer["file"] = file.string();
  reply(answer);
}

std::string no_service(const LiveRig& rig, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& each : rig.services.all()) names.push_back(each->spec().name);
  return fmt::format("rig '{}' has no service {}; it has: {}", rig.name, quote(name),
                     join(names, ", "));
}

}  // namespace

Requests::Requests(LiveRig& rig, Host host) : rig_(rig), host_(std::move(host)), changes_(rig) {}

void Requests::answer(const control::Request& request, Reply reply) {
  switch (request.verb) {
    case Verb::status:
      return give_status(rig_, reply);
    case Verb::down:
      waiting_for_stop_.push_back(std::move(reply));
      return host_.stop();
    case Verb::restart:
    case Verb::swap:
      return change(request, std::move(reply));
    case Verb::reload:
      return reload(host_.read_file(), true, std::move(reply));
    case Verb::rings:
      return give_rings(rig_, reply);
    case Verb::history:
      return give_history(rig_, request, reply);
    case Verb::rig:
      return give_rig(rig_, host_.rig_file, reply);
  }
}

void Requests::change(const control::Request& request, Reply reply) {
  if (const auto reason = why_not_change(request); !reason.empty()) return reply(failure(reason));
  auto& service = *rig_.services.find(request.service);
  if (request.verb == Verb::restart) return changes_.restart(service, std::move(reply));
  changes_.swap(service, request.backend, std::move(reply));
}

std::string Requests::why_not_change(const control::Request& request) const {
  if (!rig_.services.find(request.service)) return no_service(rig_, request.service);
  if (rig_.stops()) return "the rig is stopping";
  if (reloading_) return "the rig is being reloaded; try again when that is done";
  if (changes_.contains(request.service)) return request.service + " is being restarted already";
  return {};
}

void Requests::reload(Result<config::Rig> wanted, bool revives, Reply reply) {
  const auto refuse = [&](const std::string& sentence) {
    log::warning("not reloaded: {}", sentence);
    reply(failure(sentence));
  };
  if (const auto reason = why_not_reload(); !reason.empty()) return refuse(reason);
  if (!wanted) return refuse(wanted.error().what);
  auto begun = Reload::begin(rig_, std::move(*wanted), revives);
  if (!begun) return refuse(begun.error().what);
  reloading_ = std::make_unique<Reloading>(Reloading{std::move(*begun), std::move(reply)});
  tick(now_ns());
}

std::string Requests::why_not_reload() const {
  if (rig_.stops()) return "the rig is stopping";
  if (reloading_) return "the rig is being reloaded already";
  if (const auto service = changes_.any(); !service.empty())
    return service + " is being restarted; try again when that is done";
  return {};
}

void Requests::tick(std::int64_t now) {
  changes_.tick(now);
  if (!reloading_ || !reloading_->reload.advance(now)) return;
  const auto done = std::move(reloading_);
  done->reply(done->reload.finish());
}

bool Requests::on_failed(Service& service) {
  return changes_.on_failed(service) ||
         (reloading_ && reloading_->reload.waits_for(service.spec().name));
}

void Requests::on_stopping() {
  changes_.refuse_all("the rig is stopping");
  if (reloading_) reloading_->reply(failure("the rig is stopping"));
  reloading_.reset();
}

void Requests::on_done() {
  for (const auto& reply : waiting_for_stop_) reply(success());
}

}  // namespace handcast::supervisor
