// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/http.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <memory>

namespace handcast::projegraphy {
namespace {

struct Reply {
  std::string body;
  std::size_t most_bytes;
  bool is_too_large = false;
};

std::size_t take(const char* data, std::size_t, std::size_t count, void* to) {
  auto& reply = *static_cast<Reply*>(to);
  if (reply.body.size() + count > reply.most_bytes) {
    reply.is_too_large = true;
    return 0;  // ends the transfer
  }
  reply.body.append(data, count);
  return count;
}

Error error_of_status(const std::string& host, long status) {
  const bool is_busy = status == 408 || status == 429 || status >= 500;
  const bool is_refused = status == 401 || status == 403 || status == 404;
  const char* advice = status == 401 || status == 403 ? ": check the key"
                       : status == 404                ? ": check the address"
                                                      : "";
  return {is_busy      ? Errc::unavailable
          : is_refused ? Errc::bad_config
                       : Errc::bad_data,
          fmt::format("{} answers with the status {}{}", host, status, advice)};
}

Error error_of(const std::string& host, CURLcode code) {
  switch (code) {
    case CURLE_OPERATION_TIMEDOUT:
      return {Errc::timeout, fmt::format("{} does not answer in time", host)};
    case CURLE_URL_MALFORMAT:
    case CURLE_UNSUPPORTED_PROTOCOL:
      return {Errc::bad_config, "the address of the server is not one: write http://HOST:PORT"};
    default:
      return {Errc::unavailable, fmt::format("{}: {}", host, curl_easy_strerror(code))};
  }
}

void set_up(CURL* curl, const Request& request, Reply& reply) {
  curl_easy_setopt(curl, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(request.patience.count()));
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(request.patience.count()));
  curl_easy_setopt(curl, CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(request.most_bytes));
  if (!request.body.empty()) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE,
                     static_cast<curl_off_t>(request.body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body.data());
  }
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &reply);
}

/// curl_easy_perform() that ends within 50 ms of a stop.
CURLcode perform(CURL* curl, const std::stop_token& stop) {
  const std::unique_ptr<CURLM, decltype(&curl_multi_cleanup)> multi(curl_multi_init(),
                                                                    curl_multi_cleanup);
  if (!multi || curl_multi_add_handle(multi.get(), curl) != CURLM_OK) return CURLE_OUT_OF_MEMORY;
  constexpr int kLook_ms = 50;
  int running = 1;
  auto code = CURLE_ABORTED_BY_CALLBACK;
  while (!stop.stop_requested() && curl_multi_perform(multi.get(), &running) == CURLM_OK &&
         running > 0)
    curl_multi_poll(multi.get(), nullptr, 0, kLook_ms, nullptr);
  int left = 0;
  while (const CURLMsg* message = curl_multi_info_read(multi.get(), &left))
    if (message->msg == CURLMSG_DONE) code = message->data.result;
  curl_multi_remove_handle(multi.get(), curl);
  return code;
}

}  // namespace

std::string host_of(const std::string& url) {
  const auto begin = url.find("://");
  if (begin == url.npos) return "";
  auto host = url.substr(begin + 3);
  host = host.substr(0, host.find_first_of("/?#"));
  return host.substr(host.rfind('@') + 1);
}

Result<std::string> fetch(const Request& request, const std::stop_token& stop) {
  static const auto started = curl_global_init(CURL_GLOBAL_DEFAULT);
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(
      started == CURLE_OK ? curl_easy_init() : nullptr, curl_easy_cleanup);
  if (!curl) return fail(Errc::unavailable, "the library curl does not start");
  const std::string host = host_of(request.url);
  curl_slist* lines = curl_slist_append(nullptr, ("Content-Type: " + request.type).c_str());
  lines = curl_slist_append(lines, "Expect:");
  if (!request.key.empty())
    lines = curl_slist_append(lines, ("Authorization: Bearer " + request.key).c_str());
  const std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> headers(lines,
                                                                            curl_slist_free_all);
  Reply reply{{}, request.most_bytes};
  set_up(curl.get(), request, reply);
  curl_easy_setopt(curl.get(), CURLOPT_HTTPHEADER, headers.get());
  const CURLcode code = perform(curl.get(), stop);
  if (reply.is_too_large || code == CURLE_FILESIZE_EXCEEDED)
    return fail(Errc::bad_data,
                fmt::format("{} sends more than {} bytes", host, request.most_bytes));
  if (code != CURLE_OK) return tl::make_unexpected(error_of(host, code));
  long status = 0;
  curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  if (status != 200) return tl::make_unexpected(error_of_status(host, status));
  return std::move(reply.body);
}

}  // namespace handcast::projegraphy
