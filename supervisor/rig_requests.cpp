// What a rig does when it is asked over its control socket.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "config/join.hpp"
#include "supervisor/rig_runner.hpp"

namespace handcast::supervisor {
namespace {

// The rig's data path does not pass through the supervisor, so asking a daemon for its list may take a moment.
constexpr int kListLimit_ms = 3000;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

Service* RigRunner::find(std::string_view name) const {
  const auto found = std::ranges::find_if(services_, [&](const auto& service) { return service->spec().name == name; });
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
  }
}

void RigRunner::change(const Request& request, ControlServer::Reply reply) {
  const auto service = find(request.service);
  if (!service) {
    std::vector<std::string> names;
    for (const auto& each : services_) names.push_back(each->spec().name);
    return reply(failure(fmt::format("rig '{}' has no service '{}'; it has: {}", name_, request.service, config::join(names, ", "))));
  }
  if (phase_ == Phase::stopping) return reply(failure("the rig stops"));
  if (pending_.contains(request.service)) return reply(failure(request.service + " is being restarted already"));

  if (request.verb == Verb::restart) {
    pending_[request.service] = {std::move(reply), {}, {}, {}};
    return service->restart();
  }
  if (const auto known = check_backend(request.service, request.backend); !known) return reply(failure(known.error().what));
  pending_[request.service] = {std::move(reply), request.backend, service->spec().backend, {}};
  service->use_backend(request.backend, true);
}

Result<void> RigRunner::check_backend(const std::string& service, const std::string& backend) const {
  const auto output = output_of(launch_.program_folder / ("handcast-" + service), {"--backends"}, kListLimit_ms);
  if (!output) return tl::make_unexpected(output.error());
  const auto known = lines_of(*output);
  if (known.empty()) return fail(Errc::bad_config, service + " has no back ends to choose from");
  if (std::ranges::find(known, backend) != known.end()) return {};
  return fail(Errc::bad_config, fmt::format("{} has no back end '{}'; it has: {}", service, backend, config::join(known, ", ")));
}

}  // namespace handcast::supervisor
