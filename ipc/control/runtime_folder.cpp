// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/runtime_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace handcast::control {
namespace {

constexpr std::string_view kSuffix = ".sock";
constexpr std::string_view kNameCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

Result<void> check_owner(const std::filesystem::path& folder) {
  struct stat status {};
  if (lstat(folder.c_str(), &status) != 0)
    return fail(Errc::bad_config, fmt::format("{}: {}", folder.string(), std::strerror(errno)));
  if (!S_ISDIR(status.st_mode) || status.st_uid != getuid() || (status.st_mode & 077) != 0)
    return fail(Errc::bad_config,
                fmt::format("{} must be a folder that belongs to you and that no other user has "
                            "access to (mode 0700); remove it or correct it",
                            folder.string()));
  return {};
}

bool somebody_listens(const std::filesystem::path& socket) {
  const auto connection = connect_to(socket);
  return connection || connection.error().code != Errc::unavailable;
}

}  // namespace

Result<std::filesystem::path> runtime_folder() {
  const char* base = std::getenv("XDG_RUNTIME_DIR");
  const auto folder =
      std::filesystem::path(base && *base ? base : "/tmp") / fmt::format("handcast-{}", getuid());
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return fail(Errc::bad_config,
                fmt::format("{} cannot be created: {}", folder.string(), std::strerror(errno)));
  if (const auto owned = check_owner(folder); !owned) return tl::make_unexpected(owned.error());
  return folder;
}

Result<std::filesystem::path> socket_of(std::string_view rig) {
  if (rig.empty() || rig.find_first_not_of(kNameCharacters) != std::string_view::npos)
    return fail(
        Errc::bad_config,
        fmt::format("'{}' is not a valid name of a rig; use letters, digits, '_' and '-'", rig));
  const auto folder = runtime_folder();
  if (!folder) return tl::make_unexpected(folder.error());
  auto path = *folder / fmt::format("{}{}", rig, kSuffix);
  if (path.native().size() >= sizeof(sockaddr_un::sun_path))
    return fail(
        Errc::bad_config,
        fmt::format("{} is too long for a socket; give the rig a shorter name", path.string()));
  return path;
}

Result<std::vector<std::string>> living_rigs() {
  const auto folder = runtime_folder();
  if (!folder) return tl::make_unexpected(folder.error());
  std::vector<std::string> rigs;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(*folder, error))
    if (entry.path().extension() == kSuffix && somebody_listens(entry.path()))
      rigs.push_back(entry.path().stem().string());
  std::ranges::sort(rigs);
  return rigs;
}

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

Result<UniqueFd> connect_to(const std::filesystem::path& path) {
  UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto address = address_of(path);
  if (!socket ||
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return errno == EAGAIN
               ? fail(Errc::timeout,
                      fmt::format("the supervisor at {} hangs: it accepts no connections",
                                  path.string()))
               : fail(Errc::unavailable, fmt::format("no supervisor answers at {}: {}",
                                                     path.string(), std::strerror(errno)));
  if (!is_of_this_user(socket.get()))
    return fail(Errc::bad_config,
                fmt::format("the process that listens at {} belongs to another user; the "
                            "connection was closed",
                            path.string()));
  return socket;
}

bool is_of_this_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == getuid();
}

}  // namespace handcast::control
