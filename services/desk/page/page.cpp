// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/page.hpp"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/desk/page/access.hpp"
#include "services/desk/page/actions.hpp"
#include "services/desk/page/board.hpp"
#include "services/desk/page/certificate.hpp"
#include "services/desk/page/facts.hpp"
#include "services/desk/page/http_server.hpp"
#include "services/desk/page/picture_feed.hpp"
#include "services/desk/page/programs.hpp"
#include "services/desk/page/rig_watch.hpp"
#include "services/desk/page/router.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kListen = "desk.page.listen", kLan = "desk.page.lan";
constexpr std::int64_t kPortPatience_ns = 2'000'000'000;

struct Listen {
  std::string address;
  std::uint16_t port = 0;
};

/// Errors: bad_config. `setting`: its name.
Result<Listen> parse_listen(const std::string& text, std::string_view setting) {
  const auto colon = text.rfind(':');
  Listen listen;
  listen.address = text.substr(0, colon);
  if (listen.address == "localhost") listen.address = "127.0.0.1";
  const auto* const begin = colon == std::string::npos ? nullptr : text.data() + colon + 1;
  const auto* const end = text.data() + text.size();
  const auto parsed = begin ? std::from_chars(begin, end, listen.port) : std::from_chars_result{};
  if (!begin || parsed.ec != std::errc() || parsed.ptr != end)
    return fail(Errc::bad_config,
                fmt::format("{}: '{}' is not an address and a port, as in {}", setting, text,
                            setting == kLan ? "0.0.0.0:8481" : "127.0.0.1:8480"));
  if (setting != kLan && !listen.address.starts_with("127."))
    return fail(Errc::bad_config,
                fmt::format("{}: what is not encrypted is served on this computer alone, so "
                            "'{}' must begin with 127.; for other computers there is {}",
                            setting, text, kLan));
  return listen;
}

/// Takes the port that the page had before, for which the process before may still have it for a
/// moment; else the one of the settings; else any.
Result<std::unique_ptr<HttpServer>> serve(const Listen& listen, std::uint16_t before,
                                          const HttpServer::Handler& handler) {
  for (const auto until_ns = now_ns() + kPortPatience_ns; before != 0 && now_ns() < until_ns;) {
    if (auto server = HttpServer::open(listen.address, before, handler)) return server;
    std::this_thread::sleep_for(50ms);
  }
  if (auto server = HttpServer::open(listen.address, listen.port, handler)) return server;
  return HttpServer::open(listen.address, 0, handler);
}

/// The same with encryption, at the port of the settings alone: a firewall may have opened it.
Result<std::unique_ptr<HttpServer>> serve_encrypted(const Listen& listen, const TlsKeys& keys,
                                                    const HttpServer::Handler& handler) {
  for (const auto until_ns = now_ns() + kPortPatience_ns;;) {
    auto server = HttpServer::open(listen.address, listen.port, handler, {}, keys);
    if (server || server.error().code == Errc::bad_config || now_ns() > until_ns) return server;
    std::this_thread::sleep_for(50ms);
  }
}

/// What the certificate says that this computer is called.
std::vector<std::string> own_names() {
  auto names = control::own_addresses();
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == 0) return names;
  names.emplace_back(name.data());
  names.push_back(std::string(name.data()) + ".local");
  return names;
}

std::filesystem::path recordings_of(const config::Rig& rig, const std::filesystem::path& rig_file) {
  if (!rig.desk.page.recordings.empty()) return rig.desk.page.recordings;
  return rig_file.empty() ? rig_file : rig_file.parent_path() / "recordings";
}

/// Everything of the page. The members are destroyed in the reverse order: first the connections,
/// which use all others.
class Page final : public Surface {
 public:
  Page(const config::Rig& rig, const PageWorks& works, std::unique_ptr<Access> access,
       const calib::Calibration& calibration)
      : access_(std::move(access)),
        board_(works.panel.controls()),
        programs_(rig.name, works.rig_file, recordings_of(rig, works.rig_file)),
        worked_{rig.name, works.panel, works.cues, works.midi, programs_},
        watch_(worked_, board_),
        pictures_(rig.name, calibration.camera),
        router_(worked_, *access_, board_, pictures_) {
    board_.tell(Topic::calibration, calibration_facts(rig, works.rig_file, calibration));
    board_.tell(Topic::cue_list, cue_facts(rig.desk.cues, works.panel.controls()));
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  ~Page() override {
    board_.close();
    pictures_.close();
  }

  /// Errors: those of open_page().
  Result<void> open(const Listen& listen, const std::optional<Listen>& lan) {
    auto server = serve(listen, access_->last_port(), handler());
    if (!server) return tl::make_unexpected(server.error());
    server_ = std::move(*server);
    if (auto told = access_->announce(listen.address, server_->port(), std::nullopt); !told)
      return told;
    if (lan)
      if (auto told = access_->announce(listen.address, server_->port(), open_to_others(*lan));
          !told)
        return told;
    if (listen.port != 0 && server_->port() != listen.port)
      log::info("the page is at {}:{}, because port {} is taken", listen.address, server_->port(),
                listen.port);
    return {};
  }

  void turn(const Scene& scene) override {
    if (board_.guests() == 0) return;
    watch_.take(scene);
    pictures_.take(scene);
  }

 private:
  HttpServer::Handler handler() {
    return [this](const HttpRequest& request) { return router_.answer(request); };
  }

  /// Serves the page to other computers. What prevents it does not stop the desk.
  control::LanAddress open_to_others(const Listen& lan) {
    const auto failed = [&](const Error& error) {
      log::error("the page is served on this computer alone: {}", error.what);
      return control::LanAddress{lan.address, lan.port, "", error.what};
    };
    auto certificate = open_certificate(access_->beside(".pem"), own_names());
    if (!certificate) return failed(certificate.error());
    auto server = serve_encrypted(lan, {certificate->certificate, certificate->key}, handler());
    if (!server) return failed(server.error());
    lan_server_ = std::move(*server);
    return {lan.address, lan_server_->port(), certificate->fingerprint, ""};
  }

  std::unique_ptr<Access> access_;
  Board board_;
  Programs programs_;
  Worked worked_;
  RigWatch watch_;
  PictureFeed pictures_;
  Router router_;
  std::unique_ptr<HttpServer> server_, lan_server_;
};

}  // namespace

Result<std::unique_ptr<Surface>> open_page(const config::Rig& rig, const PageWorks& works) {
  if (rig.desk.page.listen.empty()) return nullptr;
  const auto listen = parse_listen(rig.desk.page.listen, kListen);
  if (!listen) return tl::make_unexpected(listen.error());
  std::optional<Listen> lan;
  if (!rig.desk.page.lan.empty()) {
    const auto parsed = parse_listen(rig.desk.page.lan, kLan);
    if (!parsed) return tl::make_unexpected(parsed.error());
    lan = *parsed;
  }
  const auto calibration = calib::load_calibration(rig.calibration);
  if (!calibration) return tl::make_unexpected(calibration.error());
  auto access = Access::open(rig.name);
  if (!access) return tl::make_unexpected(access.error());
  auto page = std::make_unique<Page>(rig, works, std::move(*access), *calibration);
  if (const auto opened = page->open(*listen, lan); !opened)
    return tl::make_unexpected(opened.error());
  return page;
}

}  // namespace handcast::desk
