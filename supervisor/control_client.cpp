#include "supervisor/control_client.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "config/join.hpp"
#include "supervisor/runtime_folder.hpp"

namespace handcast::supervisor {
namespace {

Result<std::string> read_line(int socket) {
  std::string line;
  std::array<char, 4096> bytes;
  while (line.find('\n') == std::string::npos) {
    const auto count = ::read(socket, bytes.data(), bytes.size());
    if (count <= 0) return fail(Errc::unavailable, "the rig went away before it answered");
    line.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return line;
}

}  // namespace

Result<std::string> choose_rig(const std::string& name) {
  const auto rigs = living_rigs();
  if (!rigs) return tl::make_unexpected(rigs.error());
  if (rigs->empty()) return fail(Errc::unavailable, "no rig is up; `handcast up RIG.toml` starts one");
  if (name.empty() && rigs->size() == 1) return rigs->front();
  if (name.empty())
    return fail(Errc::unavailable, fmt::format("several rigs are up, choose one with --rig: {}", config::join(*rigs, ", ")));
  if (std::ranges::find(*rigs, name) == rigs->end())
    return fail(Errc::unavailable, fmt::format("no rig named '{}' is up; there is: {}", name, config::join(*rigs, ", ")));
  return name;
}

Result<nlohmann::json> ask(const std::string& rig, const Request& request) {
  const auto path = socket_of(rig);
  if (!path) return tl::make_unexpected(path.error());
  const auto socket = connect_to(*path);
  if (!socket) return tl::make_unexpected(socket.error());

  const auto line = print_request(request) + "\n";
  if (::send(socket->get(), line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
    return fail(Errc::unavailable, fmt::format("rig '{}' does not take requests", rig));
  const auto reply = read_line(socket->get());
  if (!reply) return tl::make_unexpected(reply.error());
  auto answer = nlohmann::json::parse(*reply, nullptr, false);
  if (!answer.is_object()) return fail(Errc::bad_data, fmt::format("rig '{}' gave an answer that makes no sense", rig));
  if (answer["ok"] == true) return answer;
  return fail(Errc::bad_data, answer["error"].is_string() ? answer["error"].get<std::string>() : "the rig refused without a reason");
}

}  // namespace handcast::supervisor
