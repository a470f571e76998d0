// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/rig_address.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "ipc/base/rig_name.hpp"

namespace handcast::control {
namespace {

std::string scope() {
  const char* scope = std::getenv(kScopeVariable);
  return scope ? scope : "";
}

/// The text before the name in the addresses of this user and scope.
std::string prefix() { return fmt::format("handcast-{}/{}/", getuid(), scope()); }

/// Splits the address of a rig of this scope, whoever's it is.
std::optional<std::pair<uid_t, std::string>> user_and_name_in(std::string_view address) {
  constexpr std::string_view kBegin = "handcast-";
  if (!address.starts_with(kBegin)) return std::nullopt;
  address.remove_prefix(kBegin.size());
  uid_t user{};
  const auto [end, error] = std::from_chars(address.data(), address.data() + address.size(), user);
  address.remove_prefix(static_cast<std::size_t>(end - address.data()));
  const auto between = fmt::format("/{}/", scope());
  if (error != std::errc{} || !address.starts_with(between)) return std::nullopt;
  const auto name = address.substr(between.size());
  return is_rig_name(name) ? std::optional(std::pair(user, std::string(name))) : std::nullopt;
}

std::string name_of_user(uid_t user) {
  const auto* entry = getpwuid(user);
  return entry ? entry->pw_name : fmt::format("#{}", user);
}

/// A listening socket in the abstract namespace.
struct Listening {
  std::string name;
  std::string inode;
};

/// All of them (proc(5), /proc/net/unix).
std::vector<Listening> listening_sockets() {
  constexpr std::string_view kListening = "00010000";  // __SO_ACCEPTCON
  std::vector<Listening> found;
  std::ifstream table("/proc/net/unix");
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number, references, protocol, flags, type, state, inode, name;
    words >> number >> references >> protocol >> flags >> type >> state >> inode >> std::ws;
    if (flags == kListening && std::getline(words, name) && name.starts_with('@'))
      found.push_back({name.substr(1), inode});
  }
  return found;
}

/// The entries of a folder; those that can be read, because processes end meanwhile.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    entries.push_back(entry->path());
  return entries;
}

/// A process that has the socket open and that this user may examine; -1 if there is none.
pid_t holder_of(const std::string& inode) {
  const auto wanted = "socket:[" + inode + "]";
  std::error_code ignored;
  for (const auto& process : entries_of("/proc"))
    for (const auto& file : entries_of(process / "fd"))
      if (std::filesystem::read_symlink(file, ignored) == wanted)
        return static_cast<pid_t>(std::atoi(process.filename().c_str()));
  return -1;
}

/// The process at the other end; its pid is -1 if the kernel does not know it.
ucred peer_of(int socket) {
  ucred peer{.pid = -1, .uid = static_cast<uid_t>(-1), .gid = static_cast<gid_t>(-1)};
  socklen_t size = sizeof peer;
  if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) peer.pid = -1;
  return peer;
}

Result<RigAddress> to_address(std::string text) {
  RigAddress address{.text = std::move(text)};
  if (address.text.size() >= sizeof address.socket.sun_path)
    return fail(
        Errc::bad_config,
        fmt::format("{} is too long for a socket; give the rig a shorter name", address.text));
  address.socket.sun_family = AF_UNIX;  // the first byte of sun_path stays 0: abstract
  std::memcpy(address.socket.sun_path + 1, address.text.data(), address.text.size());
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + address.text.size());
  return address;
}

/// The process that listens at an address, whoever's it is; its pid is -1 if none accepts.
ucred listener_at(const std::string& text) {
  const auto address = to_address(text);
  const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!address || !socket ||
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address->socket), address->size) !=
          0)
    return {.pid = -1, .uid = static_cast<uid_t>(-1), .gid = static_cast<gid_t>(-1)};
  return peer_of(socket.get());
}

}  // namespace

Result<RigAddress> address_of(std::string_view rig) {
  if (!is_rig_name(rig))
    return fail(Errc::bad_config,
                fmt::format("'{}' is not a valid name of a rig; {}", rig, kRigNameRule));
  return to_address(prefix().append(rig));
}

std::string name_in(std::string_view address) {
  const auto before = prefix();
  if (!address.starts_with(before)) return {};
  const auto name = address.substr(before.size());
  return address_of(name) ? std::string(name) : std::string();
}

std::vector<std::string> living_rigs() {
  std::vector<std::string> rigs;
  for (const auto& socket : listening_sockets())
    if (auto name = name_in(socket.name); !name.empty() && has_supervisor(name))
      rigs.push_back(std::move(name));
  std::ranges::sort(rigs);
  return rigs;
}

std::vector<std::string> rigs_of_others() {
  std::vector<std::string> sentences;
  for (const auto& socket : listening_sockets()) {
    const auto rig = user_and_name_in(socket.name);
    if (!rig || rig->first == getuid()) continue;
    const auto listener = listener_at(socket.name);
    if (listener.pid < 0 || listener.uid != rig->first) continue;  // anybody can take the name
    sentences.push_back(fmt::format(
        "rig '{0}' of user {1} is up (pid {2}): `sudo -u {3} handcast status --rig {0}` shows it, "
        "`sudo -u {3} handcast down --rig {0}` stops it",
        rig->second, name_of_user(rig->first), listener.pid,
        getpwuid(rig->first) ? name_of_user(rig->first) : fmt::format("'#{}'", rig->first)));
  }
  std::ranges::sort(sentences);
  return sentences;
}

bool has_supervisor(const std::string& rig) {
  const auto address = address_of(rig);
  if (!address) return false;
  const auto connection = connect_to(*address);
  return connection || connection.error().code == Errc::timeout;
}

Result<UniqueFd> connect_to(const RigAddress& address) {
  UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto* where = reinterpret_cast<const sockaddr*>(&address.socket);
  if (!socket || ::connect(socket.get(), where, address.size) != 0)
    return errno == EAGAIN
               ? fail(Errc::timeout,
                      fmt::format("the supervisor at {} hangs: it accepts no connections",
                                  address.text))
               : fail(Errc::unavailable, fmt::format("no supervisor answers at {}: {}",
                                                     address.text, std::strerror(errno)));
  if (!is_of_this_user(socket.get()))
    return fail(Errc::bad_config,
                fmt::format("the process that listens at {} belongs to another user; the "
                            "connection was closed",
                            address.text));
  return socket;
}

bool is_of_this_user(int socket) {
  const auto peer = peer_of(socket);
  return peer.pid >= 0 && peer.uid == getuid();
}

pid_t listener_of(const RigAddress& address) {
  const auto connection = connect_to(address);
  if (connection) return peer_of(connection->get()).pid;
  if (connection.error().code == Errc::timeout)
    for (const auto& socket : listening_sockets())
      if (socket.name == address.text) return holder_of(socket.inode);
  return -1;
}

}  // namespace handcast::control
