// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/desk_address.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

#include "ipc/base/input_file.hpp"
#include "ipc/base/rig_name.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/control/control_message.hpp"
#include "ipc/control/rig_address.hpp"

namespace handcast::control {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTokenBytes = 32;

std::string new_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    std::abort();
  std::string token;
  for (const auto byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_token(const std::string& text) {
  return text.size() == 2 * kTokenBytes &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Where the folder may be, best first. A service and a person's shell may know different ones. The
/// first one is that of the unit of a rig, to which all others are read-only.
std::vector<fs::path> folders(std::string_view rig) {
  std::vector<fs::path> all{fs::path("/run/handcast") / rig};
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime == '/')
    all.push_back(fs::path(runtime) / "handcast");
  all.push_back(fmt::format("/run/user/{}/handcast", ::getuid()));
  all.push_back(fmt::format("/tmp/handcast-{}", ::getuid()));
  return all;
}

/// True if it is a folder of this user that nobody else can look into.
bool is_private(const fs::path& folder) {
  struct stat status {};
  return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == ::getuid() && (status.st_mode & 077) == 0;
}

/// The first folder that is there or can be made.
Result<fs::path> make_folder(std::string_view rig) {
  for (const auto& folder : folders(rig)) {
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) continue;
    if (is_private(folder)) return folder;
  }
  return fail(Errc::unavailable,
              fmt::format("there is no folder for the address of the desk: {} cannot be made, or "
                          "is not a folder of this user alone",
                          folders(rig).back().string()));
}

std::string name_of(std::string_view rig) {
  const char* scope = std::getenv(kScopeVariable);
  std::string name = scope && *scope ? std::string(scope) + "." : "";
  for (auto& letter : name)
    if (letter == '/') letter = '_';
  return name + std::string(rig) + ".desk";
}

std::optional<LanAddress> lan_in(const nlohmann::json& desk) {
  const auto lan = desk.find("lan");
  if (lan == desk.end() || !lan->is_object()) return std::nullopt;
  const auto port = lan->find("port");
  return LanAddress{text_at(*lan, "address"),
                    port != lan->end() && port->is_number_unsigned() ? port->get<std::uint16_t>()
                                                                     : std::uint16_t{0},
                    text_at(*lan, "fingerprint"), text_at(*lan, "fault")};
}

}  // namespace

std::array<std::string, kRoles> new_tokens() {
  std::array<std::string, kRoles> tokens;
  for (auto& token : tokens) token = new_token();
  return tokens;
}

Result<fs::path> desk_file(std::string_view rig) {
  if (!is_rig_name(rig))
    return fail(Errc::bad_config,
                fmt::format("'{}' is not a valid name of a rig; {}", rig, kRigNameRule));
  const auto name = name_of(rig);
  std::optional<std::pair<fs::file_time_type, fs::path>> newest;
  for (const auto& folder : folders(rig)) {
    std::error_code absent;
    const auto written = fs::last_write_time(folder / name, absent);
    if (absent || !is_private(folder)) continue;
    if (!newest || written > newest->first) newest.emplace(written, folder / name);
  }
  if (newest) return newest->second;
  return make_folder(rig).map([&](const fs::path& folder) { return folder / name; });
}

Result<DeskAddress> read_desk_file(const fs::path& file) {
  const auto text = read_input(file, kMostText);
  if (!text) return fail(Errc::unavailable, text.error().what);
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  DeskAddress address;
  bool is_whole = json.is_object() && json.contains("url") && json["url"].is_string();
  if (is_whole) address.url = json["url"];
  for (std::size_t role = 0; is_whole && role < kRoles; ++role) {
    const auto token = json.find(std::string(kRoleNames[role]));
    is_whole = token != json.end() && token->is_string() && is_token(*token);
    if (is_whole) address.tokens[role] = *token;
  }
  if (is_whole) address.lan = lan_in(json);
  if (!is_whole)
    return fail(Errc::bad_data, fmt::format("{} is damaged; remove it, and `handcast restart desk` "
                                            "writes another",
                                            file.string()));
  return address;
}

Result<void> write_private(const fs::path& file, std::string_view text) {
  // It is there with its permissions before the text is.
  const UniqueFd fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!fd || ::fchmod(fd.get(), 0600) != 0)
    return fail(Errc::unavailable,
                fmt::format("{} cannot be written: {}", file.string(), std::strerror(errno)));
  return write_whole(file, text, Durable::no);
}

Result<void> write_desk_file(const fs::path& file, const DeskAddress& address) {
  nlohmann::json json{{"url", address.url}};
  for (std::size_t role = 0; role < kRoles; ++role)
    json[std::string(kRoleNames[role])] = address.tokens[role];
  if (const auto& lan = address.lan)
    json["lan"] = {{"address", lan->address},
                   {"port", lan->port},
                   {"fingerprint", lan->fingerprint},
                   {"fault", lan->fault}};
  return write_private(file,
                       json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::vector<std::string> own_addresses() {
  std::vector<std::string> all;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return all;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(first, ::freeifaddrs);
  for (const auto* each = first; each; each = each->ifa_next) {
    const bool is_reached =
        (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_reached || !each->ifa_addr || each->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr, text,
                sizeof text);
    all.emplace_back(text);
  }
  return all;
}

}  // namespace handcast::control
