// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/access.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace handcast::desk {
namespace {

/// The value of a cookie; "" if there is none.
std::string_view cookie_in(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const auto end = cookies.find(';');
    auto one = cookies.substr(0, end);
    cookies.remove_prefix(end == std::string_view::npos ? cookies.size() : end + 1);
    one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
    if (one.starts_with(name) && one.substr(name.size()).starts_with('='))
      return one.substr(name.size() + 1);
  }
  return {};
}

constexpr std::string_view kBearer = "Bearer ";

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// True if a request names this computer: the address that it came to, or its name. Others were
/// made to point here.
bool is_own_name(const std::string& host, const HttpRequest& request) {
  if (host == request.local) return true;
  const auto port = request.local.substr(request.local.rfind(':'));
  if (!request.is_encrypted) return host == "localhost" + port;
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return false;
  // Browsers write it in lower case, however this computer is named.
  const auto is_same = [&](std::string_view end) {
    return std::ranges::equal(host, name.data() + std::string(end) + port, {}, to_lower, to_lower);
  };
  return is_same("") || is_same(".local");
}

}  // namespace

Result<std::unique_ptr<Access>> Access::open(const std::string& rig) {
  const auto file = control::desk_file(rig);
  if (!file) return tl::make_unexpected(file.error());
  std::unique_ptr<Access> access(new Access(rig, *file));
  if (auto before = control::read_desk_file(*file))
    access->address_ = std::move(*before);
  else
    access->address_.tokens = control::new_tokens();
  return access;
}

std::uint16_t Access::last_port() const {
  const std::lock_guard lock(mutex_);
  const auto colon = address_.url.rfind(':');
  std::uint16_t port = 0;
  if (colon != std::string::npos)
    std::from_chars(address_.url.data() + colon + 1, address_.url.data() + address_.url.size(),
                    port);
  return port;
}

Result<void> Access::announce(const std::string& address, std::uint16_t port,
                              std::optional<control::LanAddress> lan) {
  const std::lock_guard lock(mutex_);
  read_again();  // somebody may have renewed the tokens since
  address_.url = fmt::format("http://{}:{}", address, port);
  address_.lan = std::move(lan);
  auto written = control::write_desk_file(file_, address_);
  struct stat status {};
  if (written && ::stat(file_.c_str(), &status) == 0) written_ = status.st_mtim;
  return written;
}

std::filesystem::path Access::beside(const char* extension) const {
  auto file = file_;
  return file.replace_extension(extension);
}

std::optional<std::string> Access::fault_of(const HttpRequest& request) const {
  const auto host = request.header("host"), origin = request.header("origin"),
             site = request.header("sec-fetch-site");
  if (!is_own_name(host, request))
    return fmt::format("This page is served at {} only.", request.local);
  if (!origin.empty() && origin != (request.is_encrypted ? "https://" : "http://") + host)
    return "Pages of other sites may not use this one.";
  if (!site.empty() && site != "same-origin" && site != "none" && request.path != "/")
    return "Pages of other sites may not use this one.";
  // A browser says where a change comes from; a program says who it is.
  if (request.method == "POST" && origin.empty() && request.header("authorization").empty())
    return "A change needs the header Origin or Authorization.";
  return std::nullopt;
}

/// The file is small, but it is asked for with each request: it is read only if it has changed.
void Access::read_again() {
  struct stat status {};
  if (::stat(file_.c_str(), &status) != 0) return;
  if (status.st_mtim.tv_sec == written_.tv_sec && status.st_mtim.tv_nsec == written_.tv_nsec)
    return;
  written_ = status.st_mtim;
  const auto address = control::read_desk_file(file_);
  if (!address || address->tokens == address_.tokens) return;
  address_.tokens = address->tokens;
  ++generation_;
}

std::optional<control::Role> Access::role_of_token(std::string_view token) {
  const std::lock_guard lock(mutex_);
  read_again();
  std::optional<control::Role> role;
  for (std::size_t i = 0; i < control::kRoles; ++i)
    if (is_same_secret(token, address_.tokens[i])) role = static_cast<control::Role>(i);
  return role;
}

std::optional<control::Role> Access::role_of(const HttpRequest& request) {
  const auto authorization = request.header("authorization"), cookies = request.header("cookie");
  if (authorization.starts_with(kBearer))
    return role_of_token(std::string_view(authorization).substr(kBearer.size()));
  const auto token = cookie_in(cookies, cookie_name(request));
  return token.empty() ? std::nullopt : role_of_token(token);
}

Result<std::string> Access::pair(std::string_view code) {
  const auto role = pairings_.trade(code);
  if (!role) return tl::make_unexpected(role.error());
  const std::lock_guard lock(mutex_);
  read_again();
  return address_.tokens[static_cast<std::size_t>(*role)];
}

/// With the prefix, browsers take it from this very computer only, and send it encrypted only.
std::string Access::cookie_name(const HttpRequest& request) const {
  return (request.is_encrypted ? "__Host-handcast-" : "handcast-") + rig_;
}

std::string Access::cookie_of(std::string_view token, const HttpRequest& request) const {
  constexpr int kMonth_s = 30 * 86'400;
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}{}", cookie_name(request),
                     token, kMonth_s, request.is_encrypted ? "; Secure" : "");
}

std::uint64_t Access::generation() {
  const std::lock_guard lock(mutex_);
  read_again();
  return generation_;
}

}  // namespace handcast::desk
