#include "supervisor/control_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "supervisor/runtime_folder.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kLongestRequest = 1 << 16;

bool is_same_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == getuid();
}

/// Under a lock on the folder, so that of two rigs that start at once only one finds the name free.
Result<UniqueFd> bind_to(const std::filesystem::path& path, const std::string& rig) {
  const UniqueFd lock(open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  flock(lock.get(), LOCK_EX);
  if (connect_to(path))
    return fail(Errc::unavailable, fmt::format("a rig named '{}' is up already; `handcast down --rig {}` stops it", rig, rig));
  unlink(path.c_str());  // left by a supervisor that was killed

  UniqueFd listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto address = address_of(path);
  if (!listener || bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener.get(), 16) != 0)
    return fail(Errc::unavailable, fmt::format("control socket {}: {}", path.string(), std::strerror(errno)));
  return listener;
}

std::vector<std::string> take_lines(std::string& text) {
  std::vector<std::string> lines;
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    lines.push_back(text.substr(0, end));
    text.erase(0, end + 1);
  }
  return lines;
}

}  // namespace

Result<std::unique_ptr<ControlServer>> ControlServer::listen(const std::string& rig, EventLoop& loop, OnRequest on_request) {
  const auto path = socket_of(rig);
  if (!path) return tl::make_unexpected(path.error());
  auto listener = bind_to(*path, rig);
  if (!listener) return tl::make_unexpected(listener.error());
  return std::unique_ptr<ControlServer>(new ControlServer(std::move(*listener), *path, loop, std::move(on_request)));
}

ControlServer::ControlServer(UniqueFd listener, std::filesystem::path path, EventLoop& loop, OnRequest on_request)
    : listener_(std::move(listener)), path_(std::move(path)), loop_(loop), on_request_(std::move(on_request)) {
  loop_.watch(listener_.get(), [this] { accept(); });
}

void ControlServer::close_door() {
  if (!listener_) return;
  unlink(path_.c_str());
  loop_.forget(listener_.get());
  listener_.reset();
}

ControlServer::~ControlServer() {
  close_door();
  for (const auto& [id, client] : clients_) loop_.forget(client.socket.get());
}

void ControlServer::accept() {
  UniqueFd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!socket || !is_same_user(socket.get())) return;
  const auto id = next_id_++;
  loop_.watch(socket.get(), [this, id] { read(id); });
  clients_.emplace(id, Client{std::move(socket), {}});
}

void ControlServer::read(std::uint64_t id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  auto& client = found->second;
  std::array<char, 4096> bytes;
  const auto count = ::read(client.socket.get(), bytes.data(), bytes.size());
  if (count < 0 && errno == EAGAIN) return;
  if (count > 0) client.unread.append(bytes.data(), static_cast<std::size_t>(count));
  if (count <= 0 || client.unread.size() > kLongestRequest) return drop(id);

  for (const auto& line : take_lines(client.unread)) answer_line(id, line);  // `client` may be gone after the first
}

void ControlServer::answer_line(std::uint64_t id, const std::string& line) {
  const auto request = parse_request(line);
  if (!request) return send(id, failure(request.error().what));
  on_request_(*request, [this, id](const nlohmann::json& answer) { send(id, answer); });
}

// An answer fits into the socket's buffer; a client that has not read its earlier answers is dropped, not waited for.
void ControlServer::send(std::uint64_t id, const nlohmann::json& answer) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  const auto line = answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  const auto sent = ::send(found->second.socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(line.size())) drop(id);
}

void ControlServer::drop(std::uint64_t id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  loop_.forget(found->second.socket.get());
  clients_.erase(found);
}

}  // namespace handcast::supervisor
