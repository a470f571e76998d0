// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/router.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/desk/page/facts.hpp"
#include "services/desk/page/json_text.hpp"
#include "services/desk/page/web_files.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;
using control::Role;
using nlohmann::json;

constexpr double kChanges_hz = 200, kMostChanges = 400;
constexpr auto kStreamPatience = 1000ms;
constexpr std::string_view kLookPath = "/api/look/";

struct WebFile {
  std::string_view path;
  const std::string_view* text;
  const char* type;
};
constexpr std::array kFiles{
    WebFile{"/", &kIndexHtml, "text/html; charset=utf-8"},
    WebFile{"/page.css", &kPageCss, "text/css; charset=utf-8"},
    WebFile{"/page.js", &kPageJs, "text/javascript; charset=utf-8"},
    WebFile{"/dom.js", &kDomJs, "text/javascript; charset=utf-8"},
    WebFile{"/controls.js", &kControlsJs, "text/javascript; charset=utf-8"},
    WebFile{"/rig.js", &kRigJs, "text/javascript; charset=utf-8"},
    WebFile{"/picture.js", &kPictureJs, "text/javascript; charset=utf-8"},
    WebFile{"/chart.js", &kChartJs, "text/javascript; charset=utf-8"},
    WebFile{"/tools.js", &kToolsJs, "text/javascript; charset=utf-8"},
};

HttpAnswer answer_of(int status, const json& body) {
  HttpAnswer answer;
  answer.status = status;
  answer.body = json_text(body);
  return answer;
}

HttpAnswer refusal(int status, const std::string& sentence) {
  return answer_of(status, {{"error", sentence}});
}

int status_of(Errc code) {
  return code == Errc::bad_data ? 400 : code == Errc::bad_config ? 422 : 503;
}

/// The events, for as long as the page is open and its token is valid.
class EventStream final : public ByteStream {
 public:
  EventStream(Board& board, Access& access, std::atomic<int>& pages)
      : board_(board), access_(access), pages_(pages), guest_(board) {}
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;
  ~EventStream() override { --pages_; }

  bool read(std::string& bytes) override {
    if (access_.generation() != generation_ || !board_.wait(seen_, bytes, kStreamPatience))
      return false;
    if (bytes.empty()) bytes = ":\n\n";  // tells whether the page is still there
    return true;
  }

 private:
  Board& board_;
  Access& access_;
  std::atomic<int>& pages_;
  Board::Guest guest_;
  Board::Seen seen_;
  std::uint64_t generation_ = access_.generation();
};

/// The pictures, one after the other; a slow client gets fewer.
class PictureStream final : public ByteStream {
 public:
  PictureStream(PictureFeed& pictures, Access& access, std::atomic<int>& lookers)
      : pictures_(pictures), access_(access), lookers_(lookers) {}
  PictureStream(const PictureStream&) = delete;
  PictureStream& operator=(const PictureStream&) = delete;
  ~PictureStream() override { --lookers_; }

  bool read(std::string& bytes) override {
    if (access_.generation() != generation_) return false;
    PictureFeed::Packet packet;
    if (!pictures_.wait(seen_, packet, kStreamPatience)) return false;
    if (packet)
      bytes = *packet;
    else
      bytes.assign(12, '\0');  // a packet of nothing tells whether the page is still there
    return true;
  }

 private:
  PictureFeed& pictures_;
  Access& access_;
  std::atomic<int>& lookers_;
  std::uint64_t seen_ = 0;
  std::uint64_t generation_ = access_.generation();
};

bool is_json(const HttpRequest& request) {
  return request.header("content-type").starts_with("application/json");
}

}  // namespace

Router::Router(Worked worked, Access& access, Board& board, PictureFeed& pictures)
    : worked_(std::move(worked)), access_(access), board_(board), pictures_(pictures) {}

HttpAnswer Router::answer(const HttpRequest& request) {
  auto answer = route(request);
  if (answer.status >= 400) complain(request, answer.body);
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, const char*>>{
           {"Content-Security-Policy",
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
            "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
           {"X-Content-Type-Options", "nosniff"},
           {"Referrer-Policy", "no-referrer"},
           {"Cross-Origin-Resource-Policy", "same-origin"},
           {"Cross-Origin-Opener-Policy", "same-origin"}})
    answer.headers.emplace_back(name, value);
  const auto is_cache = [](const auto& header) { return header.first == "Cache-Control"; };
  if (std::ranges::none_of(answer.headers, is_cache))
    answer.headers.emplace_back("Cache-Control", "no-store");
  return answer;
}

HttpAnswer Router::route(const HttpRequest& request) {
  if (const auto fault = access_.fault_of(request)) return refusal(403, *fault);
  const bool is_post = request.method == "POST";
  if (!is_post && request.method != "GET")
    return refusal(405, "Only GET and POST are understood here.");
  if (is_post && !is_json(request)) return refusal(415, "A change is sent as application/json.");
  if (is_post && request.path == "/api/session") return open_session(request);
  if (is_post && request.path == "/api/pair" && request.is_encrypted) return pair(request);
  if (!is_post)
    for (const auto& file : kFiles)
      if (file.path == request.path)
        return {.status = 200,
                .type = file.type,
                .body = std::string(*file.text),
                .headers = {},
                .stream = nullptr};
  const auto role = access_.role_of(request);
  if (!role)
    return refusal(401, request.is_encrypted
                            ? "Enter the code that `handcast desk --lan` prints."
                            : "Open the address that `handcast desk` prints: this browser has no "
                              "valid token.");
  return is_post ? post(request, *role) : get(request, *role);
}

HttpAnswer Router::open_session(const HttpRequest& request) {
  const auto body = json::parse(request.body, nullptr, false);
  if (!body.is_object() || !body.contains("token") || !body["token"].is_string())
    return refusal(400, "The request has no text \"token\".");
  const std::string token = body["token"];
  const auto role = access_.role_of_token(token);
  if (!role) return refusal(401, "This token is not valid (any more); `handcast desk` prints one.");
  auto answer = answer_of(200, {{"role", control::kRoleNames[static_cast<std::size_t>(*role)]}});
  answer.headers.emplace_back("Set-Cookie", access_.cookie_of(token, request));
  return answer;
}

HttpAnswer Router::pair(const HttpRequest& request) {
  const auto body = json::parse(request.body, nullptr, false);
  if (!body.is_object() || !body.contains("code") || !body["code"].is_string())
    return refusal(400, "The request has no text \"code\".");
  const auto token = access_.pair(body["code"].get<std::string>());
  if (!token) return refusal(token.error().code == Errc::bad_data ? 401 : 403, token.error().what);
  log::info("page: {} has entered the code", request.peer);
  auto answer = answer_of(200, json::object());
  answer.headers.emplace_back("Set-Cookie", access_.cookie_of(*token, request));
  return answer;
}

HttpAnswer Router::get(const HttpRequest& request, Role role) {
  if (request.path == "/api/start") return start(role);
  HttpAnswer answer;
  if (request.path == "/api/events") {
    if (++pages_ > kMostPages)
      return --pages_,
             refusal(503, fmt::format("{} pages are open, which is the most.", kMostPages));
    answer.type = "text/event-stream";
    answer.stream = std::make_unique<EventStream>(board_, access_, pages_);
    return answer;
  }
  if (request.path == "/api/picture") {
    if (++lookers_ > kMostPictures)
      return --lookers_, refusal(503, fmt::format("{} pages show the picture, which is the most.",
                                                  kMostPictures));
    answer.type = "application/octet-stream";
    answer.stream = std::make_unique<PictureStream>(pictures_, access_, lookers_);
    return answer;
  }
  if (request.path.starts_with(kLookPath)) {
    auto picture = picture_of_look(std::string_view(request.path).substr(kLookPath.size()));
    if (!picture) return refusal(404, "There is no picture of this look.");
    answer.type = "image/png";
    answer.body = std::move(*picture);
    answer.headers.emplace_back("Cache-Control", "private, max-age=3600");
    return answer;
  }
  if (find_action(request.path)) return refusal(405, "A change is sent with POST.");
  return refusal(404, "There is nothing at this address.");
}

HttpAnswer Router::post(const HttpRequest& request, Role role) {
  const auto* action = find_action(request.path);
  if (!action) return refusal(404, "There is nothing at this address.");
  if (role < action->least)
    return refusal(403, fmt::format("Only the {} may do that.",
                                    control::kRoleNames[static_cast<std::size_t>(action->least)]));
  if (is_too_often()) return refusal(429, "There are too many changes at once.");
  const auto source =
      fmt::format("page {} {}", control::kRoleNames[static_cast<std::size_t>(role)], request.peer);
  const auto done = act(worked_, *action, request.body, source);
  if (!done) return refusal(status_of(done.error().code), done.error().what);
  board_.tell(worked_.panel.values());
  board_.tell(Topic::presets, json_text(worked_.panel.presets()));
  return answer_of(200, json::object());
}

HttpAnswer Router::start(Role role) const {
  auto controls = json::array();
  for (const auto& control : worked_.panel.controls()) controls.push_back(json_of(control));
  return answer_of(200, {{"rig", worked_.rig},
                         {"role", control::kRoleNames[static_cast<std::size_t>(role)]},
                         {"controls", std::move(controls)},
                         {"looks", looks()},
                         {"backends", backends()}});
}

/// Changes of all pages together: a slider sends some 30 a second.
bool Router::is_too_often() {
  const std::lock_guard lock(mutex_);
  const auto now = now_ns();
  changes_left_ =
      refilled_ns_ == 0
          ? kMostChanges
          : std::min(kMostChanges, changes_left_ + kChanges_hz * ns_to_seconds(now - refilled_ns_));
  refilled_ns_ = now;
  if (changes_left_ < 1) return true;
  changes_left_ -= 1;
  return false;
}

/// Logs what was refused, once a second at most.
void Router::complain(const HttpRequest& request, const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  ++refused_;
  if (now_ns() - complained_ns_ < 1'000'000'000) return;
  complained_ns_ = now_ns();
  log::warning("page: {} {} of {} was refused ({} in all since the last line): {}",
               printable(request.method.substr(0, 16)), printable(request.path.substr(0, 64)),
               request.peer, std::exchange(refused_, 0), printable(sentence));
}

}  // namespace handcast::desk
