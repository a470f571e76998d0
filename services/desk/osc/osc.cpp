// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/osc.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/desk/osc/description.hpp"
#include "services/desk/osc/figures.hpp"
#include "services/desk/osc/inbox.hpp"
#include "services/desk/osc/outbox.hpp"
#include "services/desk/osc/query_server.hpp"
#include "services/desk/osc/tuio.hpp"
#include "services/desk/osc/udp.hpp"

namespace handcast::desk {
namespace osc {
namespace {

constexpr std::int64_t kPause_ns = 4'000'000;  ///< between two reads of what came in
/// Between two changes: each makes every process of the rig read its settings again.
constexpr std::int64_t kChangePause_ns = 16'000'000;
/// Reads of DatagramReader::kBatch at one time: 32,000 messages a second, more than any controller
/// sends. The rest of a flood is lost in the socket, which costs the rig no time.
constexpr std::size_t kMostReads = 4;
constexpr std::int64_t kLongestWait_ns = 1'000'000'000;
constexpr std::size_t kMostReceivers = 16;

/// The sockets that [desk.osc] asks for.
struct Sockets {
  UniqueFd listen, query;
  std::vector<UniqueFd> send, tuio;
};

/// Takes what comes in, in a thread of its own.
class Receiver {
 public:
  Receiver(const config::Rig& rig, const Addresses& addresses, Panel& panel, CueDeck* cues,
           UniqueFd listen, UniqueFd query)
      : panel_(panel),
        cues_(cues),
        socket_(std::move(listen)),
        inbox_(addresses, complaints_),
        host_{rig.name, port_of(socket_)},
        server_(std::move(query),
                [this](std::string_view asked) {
                  return describe_address(asked, host_, panel_.controls(), *panel_.values(),
                                          panel_.presets());
                }),
        stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        thread_([this] { run(); }) {}
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  ~Receiver() {
    is_stopping_.store(true);
    ::eventfd_write(stop_.get(), 1);
    thread_.join();
  }

  bool takes_refresh() { return is_refresh_.exchange(false); }

 private:
  void run() {
    while (!is_stopping_.load()) {
      const bool may_read = wait();
      const auto now = Instant::now();
      inbox_.take_due(now);
      if (may_read) {
        read(now);
        is_query_waiting_ = server_.turn(now.mono_ns);
        next_read_ns_ = now.mono_ns + kPause_ns;
      }
      if (inbox_.has_work() && now.mono_ns >= next_change_ns_) {
        inbox_.apply(panel_, cues_, now);
        next_change_ns_ = now.mono_ns + kChangePause_ns;
      }
      if (inbox_.takes_refresh()) is_refresh_.store(true);
    }
  }

  /// Waits for the network, the next bundle, or the end of the pause after a read. Returns false if
  /// it did not look at the network because of the pause.
  bool wait() {
    const auto now = now_ns();
    const bool pauses = now < next_read_ns_;
    auto until_ns = pauses ? next_read_ns_ : now + (is_query_waiting_ ? 0 : kLongestWait_ns);
    if (const auto due_ns = inbox_.next_due_ns()) until_ns = std::min(until_ns, *due_ns);
    if (inbox_.has_work()) until_ns = std::min(until_ns, next_change_ns_);
    waits_.assign(1, {stop_.get(), POLLIN, 0});
    if (!pauses) {
      waits_.push_back({socket_.get(), POLLIN, 0});
      server_.add_to(waits_);
    }
    const auto wait_ns = std::max<std::int64_t>(until_ns - now, 0);
    const timespec timeout{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
    ::ppoll(waits_.data(), waits_.size(), &timeout, nullptr);
    return !pauses;
  }

  void read(Instant now) {
    for (std::size_t i = 0; i < kMostReads; ++i) {
      const auto& datagrams = reader_.read(socket_);
      for (const auto& datagram : datagrams) {
        if (datagram.is_whole) {
          inbox_.take(datagram.bytes, datagram.from, now);
        } else {
          complaints_.add(now.mono_ns, fmt::format("{}: a packet of more than {} bytes was dropped",
                                                   datagram.from, DatagramReader::kMostDatagram));
        }
      }
      if (datagrams.size() < DatagramReader::kBatch) return;
    }
  }

  Panel& panel_;
  CueDeck* cues_;
  UniqueFd socket_;
  DatagramReader reader_;
  Complaints complaints_{"osc"};
  Inbox inbox_;
  Host host_;
  QueryServer server_;
  std::int64_t next_read_ns_ = 0, next_change_ns_ = 0;
  bool is_query_waiting_ = false;
  std::vector<pollfd> waits_;
  std::atomic<bool> is_stopping_ = false, is_refresh_ = false;
  UniqueFd stop_;
  std::thread thread_;  ///< the last member: it uses all others
};

class OscSurface final : public Surface {
 public:
  OscSurface(const config::Rig& rig, const calib::CameraModel& camera, Panel& panel, CueDeck* cues,
             Sockets sockets)
      : panel_(panel),
        addresses_(panel.controls()),
        outbox_(rig.desk.osc.rate_hz),
        tuio_(camera),
        sockets_(std::move(sockets)) {
    for (const auto& socket : sockets_.send) {
      send_.push_back(socket.get());
      tellers_.emplace_back(addresses_, peer_of(socket));
    }
    if (!send_.empty()) figures_ = std::make_unique<FigureFeed>(rig.name);
    for (const auto& socket : sockets_.tuio) send_tuio_.push_back(socket.get());
    if (sockets_.listen)
      receiver_ = std::make_unique<Receiver>(rig, addresses_, panel, cues,
                                             std::move(sockets_.listen), std::move(sockets_.query));
  }

  void turn(const Scene& scene) override {
    const bool is_refresh = receiver_ && receiver_->takes_refresh();
    if (!send_.empty()) send_all(packets(scene), send_);
    for (std::size_t i = 0; i < send_.size(); ++i) {
      if (is_refresh) tellers_[i].refresh();
      send_all(tellers_[i].packets(*panel_.values(), scene.now_ns), {&send_[i], 1});
    }
    if (send_tuio_.empty()) return;
    if (auto bundle = tuio_.bundle(scene); !bundle.empty())
      send_all({std::move(bundle)}, send_tuio_);
  }

 private:
  /// What all receivers are told.
  std::vector<std::string> packets(const Scene& scene) {
    auto packets = outbox_.packets(scene);
    if (auto figures = figures_->take(); !figures.empty()) packets.push_back(std::move(figures));
    return packets;
  }

  Panel& panel_;
  Addresses addresses_;
  Outbox outbox_;
  std::vector<ValueTeller> tellers_;  ///< by receiver
  std::unique_ptr<FigureFeed> figures_;
  Tuio tuio_;
  Sockets sockets_;
  std::vector<int> send_, send_tuio_;
  std::unique_ptr<Receiver> receiver_;
};

Result<std::vector<UniqueFd>> connect_all(const std::vector<std::string>& addresses,
                                          const char* setting) {
  if (addresses.size() > kMostReceivers)
    return fail(Errc::bad_config, fmt::format("{}: {} addresses are too many; the most is {}",
                                              setting, addresses.size(), kMostReceivers));
  std::vector<UniqueFd> sockets;
  for (const auto& address : addresses) {
    auto socket = connect_socket(address, setting);
    if (!socket) return tl::make_unexpected(socket.error());
    sockets.push_back(std::move(*socket));
  }
  return sockets;
}

Result<Sockets> open_sockets(const config::DeskOsc& osc) {
  Sockets sockets;
  const auto take = [](auto opened, auto& into) -> Result<void> {
    if (!opened) return tl::make_unexpected(opened.error());
    into = std::move(*opened);
    return {};
  };
  Result<void> done = take(connect_all(osc.send, "desk.osc.send"), sockets.send);
  if (done) done = take(connect_all(osc.tuio, "desk.osc.tuio"), sockets.tuio);
  if (done && !osc.listen.empty())
    done = take(bind_socket(osc.listen, Transport::udp, "desk.osc.listen"), sockets.listen);
  if (done && osc.query_port > 0 && osc.listen.empty())
    done = fail(Errc::bad_config, "desk.osc.query_port: desk.osc.listen must be set, too");
  if (done && osc.query_port > 0)
    done = take(bind_socket(osc.listen, Transport::tcp, "desk.osc.query_port", osc.query_port),
                sockets.query);
  if (!done) return tl::make_unexpected(done.error());
  return sockets;
}

}  // namespace
}  // namespace osc

Result<std::unique_ptr<Surface>> open_osc(const config::Rig& rig, const calib::CameraModel& camera,
                                          Panel& panel, CueDeck* cues) {
  const auto& settings = rig.desk.osc;
  if (settings.listen.empty() && settings.send.empty() && settings.tuio.empty() &&
      settings.query_port == 0)
    return nullptr;
  auto sockets = osc::open_sockets(settings);
  if (!sockets) return tl::make_unexpected(sockets.error());
  return std::make_unique<osc::OscSurface>(rig, camera, panel, cues, std::move(*sockets));
}

}  // namespace handcast::desk
