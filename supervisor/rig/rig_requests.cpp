// SPDX-License-Identifier: Apache-2.0
// What a rig does when it is asked over its control socket.
#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "config/renamed_settings.hpp"
#include "config/settings/join.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/clock.hpp"
#include "supervisor/rig/fingerprint.hpp"
#include "supervisor/rig/rig_runner.hpp"

namespace handcast::supervisor {
namespace {

// The rig's data path does not pass through the supervisor, so asking a daemon for its list may
// take a moment.
constexpr int kListLimit_ms = 3000;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The back end that `word` names now. Errors (bad_config): an old word that stands for a second
/// setting, too, of which the rig has another value; a swap changes the back end alone.
Result<std::string> current_backend(const std::string& service, const std::string& word,
                                    config::Rig rig) {
  std::string sentence;
  const auto current =
      config::current_form({service + ".backend", word}, "swap", config::renamed_settings(),
                           [&](const std::string& renamed) { sentence = renamed; });
  const auto listing = config::list_settings(rig);
  for (std::size_t i = 1; i < current.size(); ++i) {
    const auto has = config::print_value(*config::find_setting(listing, current[i].setting));
    if (has != fmt::format("\"{}\"", current[i].value))
      return fail(Errc::bad_config,
                  fmt::format("{}, but the rig has {} = {}: change the rig file and use "
                              "`handcast reload`",
                              sentence, current[i].setting, has));
  }
  return current.front().value;
}

}  // namespace

Service* RigRunner::find(std::string_view name) const {
  const auto found = std::ranges::find_if(
      services_, [&](const auto& service) { return service->spec().name == name; });
  return found == services_.end() ? nullptr : found->get();
}

void RigRunner::on_request(const Request& request, ControlServer::Reply reply) {
  switch (request.verb) {
    case Verb::status: {
      auto answer = success();
      recorder_.poll();
      answer["status"] = status_of(view());
      return reply(answer);
    }
    case Verb::down:
      waiting_for_stop_.push_back(std::move(reply));
      if (phase_ != Phase::stopping) begin_stop(0);
      return;
    case Verb::restart:
    case Verb::swap:
      return change(request, std::move(reply));
    case Verb::reload:
      return reload(config::load_rig(options_.rig_file, options_.settings), true, std::move(reply));
    case Verb::rings:
      return give_rings(reply);
    case Verb::history:
      recorder_.poll();
      return give_history(request, reply);
  }
}

/// Read-only: a tool that is given them cannot disturb the rig by accident.
void RigRunner::give_rings(const ControlServer::Reply& reply) const {
  auto answer = success();
  answer["rings"] = nlohmann::json::array();
  std::vector<UniqueFd> owned;
  std::vector<int> descriptors;
  for (const auto& [stream, fd] : launch_.rings) {
    owned.emplace_back(::open(fmt::format("/proc/self/fd/{}", fd).c_str(), O_RDONLY | O_CLOEXEC));
    if (!owned.back())
      return reply(failure(
          fmt::format("ring '{}' cannot be opened again: {}", stream, std::strerror(errno))));
    answer["rings"].push_back(stream);
    descriptors.push_back(owned.back().get());
  }
  reply(answer, descriptors);
}

void RigRunner::give_history(const Request& request, const ControlServer::Reply& reply) const {
  const auto longest_s = ns_to_seconds(now_ns());
  const auto since_ns = now_ns() - seconds_to_ns(std::min(request.seconds, longest_s));
  const auto snapshot = recorder_.history().snapshot(since_ns);
  if (!snapshot) return reply(failure(snapshot.error().what));
  reply(success(), {snapshot->get()});
}

void RigRunner::change(const Request& request, ControlServer::Reply reply) {
  const auto service = find(request.service);
  if (!service) {
    std::vector<std::string> names;
    for (const auto& each : services_) names.push_back(each->spec().name);
    return reply(failure(fmt::format("rig '{}' has no service '{}'; it has: {}", name_,
                                     request.service, config::join(names, ", "))));
  }
  if (phase_ == Phase::stopping) return reply(failure("the rig stops"));
  if (reload_) return reply(failure("the rig is being reloaded; try again when that is done"));
  if (pending_.contains(request.service))
    return reply(failure(request.service + " is being restarted already"));

  if (request.verb == Verb::restart) {
    pending_[request.service] = {std::move(reply), {}, {}, {}};
    return service->restart();
  }
  const auto backend = current_backend(request.service, request.backend, rig_);
  if (!backend) return reply(failure(backend.error().what));
  if (const auto known = check_backend(request.service, *backend); !known)
    return reply(failure(known.error().what));
  pending_[request.service] = {std::move(reply), *backend, service->spec().backend, {}};
  give_backend(*service, *backend, true);
}

void RigRunner::give_backend(Service& service, const std::string& backend, bool on_trial) {
  auto spec = service.spec();
  spec.fingerprint = fingerprint_of(spec.name, with_backend(rig_, spec.name, backend));
  service.update(spec);
  service.use_backend(backend, on_trial);
}

Result<void> RigRunner::check_backend(const std::string& service,
                                      const std::string& backend) const {
  const auto output =
      output_of(launch_.program_folder / ("handcast-" + service), {"--backends"}, kListLimit_ms);
  if (!output) return tl::make_unexpected(output.error());
  const auto known = lines_of(*output);
  if (known.empty()) return fail(Errc::bad_config, service + " has no back ends to choose from");
  if (std::ranges::find(known, backend) != known.end()) return {};
  return fail(Errc::bad_config, fmt::format("{} has no back end '{}'; it has: {}", service, backend,
                                            config::join(known, ", ")));
}

}  // namespace handcast::supervisor
