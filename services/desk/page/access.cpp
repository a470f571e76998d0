// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/access.hpp"

#include <fmt/format.h>

#include <charconv>

namespace handcast::desk {
namespace {

/// Takes as long for every token of the same length.
bool is_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

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

Result<void> Access::announce(const std::string& address, std::uint16_t port) {
  const std::lock_guard lock(mutex_);
  host_ = fmt::format("{}:{}", address, port);
  local_host_ = fmt::format("localhost:{}", port);
  address_.url = "http://" + host_;
  auto written = control::write_desk_file(file_, address_);
  struct stat status {};
  if (written && ::stat(file_.c_str(), &status) == 0) written_ = status.st_mtim;
  return written;
}

std::optional<std::string> Access::fault_of(const HttpRequest& request) const {
  const std::lock_guard lock(mutex_);
  const auto host = request.header("host"), origin = request.header("origin"),
             site = request.header("sec-fetch-site");
  if (host != host_ && host != local_host_)
    return fmt::format("This page is served at {} only.", host_);
  if (!origin.empty() && origin != "http://" + host)
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
    if (is_same(token, address_.tokens[i])) role = static_cast<control::Role>(i);
  return role;
}

std::optional<control::Role> Access::role_of(const HttpRequest& request) {
  const auto authorization = request.header("authorization"), cookies = request.header("cookie");
  if (authorization.starts_with(kBearer))
    return role_of_token(std::string_view(authorization).substr(kBearer.size()));
  const auto token = cookie_in(cookies, "handcast-" + rig_);
  return token.empty() ? std::nullopt : role_of_token(token);
}

std::string Access::cookie_of(std::string_view token) const {
  constexpr int kMonth_s = 30 * 86'400;
  return fmt::format("handcast-{}={}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}", rig_, token,
                     token.empty() ? 0 : kMonth_s);
}

std::uint64_t Access::generation() {
  const std::lock_guard lock(mutex_);
  read_again();
  return generation_;
}

}  // namespace handcast::desk
