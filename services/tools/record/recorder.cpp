// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <thread>
#include <utility>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "config/settings/frozen_file.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/log.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/msg/test_picture.hpp"
#include "services/recording/about.hpp"
#include "services/tools/record/npy_folder.hpp"

namespace handcast::record {
namespace {

using namespace std::chrono_literals;

/// How long a thread waits for a message before it looks whether the recording is over.
constexpr auto kWait = 100ms;
/// The rings without images hold the messages of 200 ms at least.
constexpr std::int64_t kPause_ns = 10'000'000;
constexpr std::int64_t kLook_ns = 1'000'000'000, kTurn_ns = 50'000'000;

}  // namespace

Recorder::Recorder(std::vector<std::unique_ptr<Feed>> feeds, recording::RecordingWriter writer)
    : feeds_(std::move(feeds)), writer_(std::move(writer)), totals_(writer_.totals()) {}

void Recorder::stop(Error reason) {
  const std::lock_guard lock(mutex_);
  if (well_) well_ = tl::make_unexpected(std::move(reason));
  stopping_ = true;
}

/// `pause_ns`: 0: the only feed waits for its messages.
void Recorder::read(const std::vector<Feed*>& feeds, std::int64_t pause_ns) {
  while (!stopping_) {
    for (auto* feed : feeds)
      if (auto done = feed->read(queue_, pause_ns > 0 ? Deadline::now() : Deadline::in(kWait));
          !done)
        return stop(std::move(done.error()));
    if (pause_ns > 0) sleep_until_ns(now_ns() + pause_ns);
  }
}

void Recorder::write() {
  (void)!::nice(10);  // on Linux, of this thread
  std::int64_t next_ns = 0;
  for (auto next = queue_.pop(); next; next = queue_.pop()) {
    const auto& message = *next;
    auto written = std::visit(
        [&](const auto& sample) {
          return writer_.append(message.stream, *sample, sample.sequence(), message.lost);
        },
        message.sample);
    feeds_[message.stream]->written(bytes_of(message.sample));
    if (!written) return stop(std::move(written.error()));
    if (now_ns() < next_ns) continue;
    next_ns = now_ns() + kTurn_ns;
    const std::lock_guard lock(mutex_);
    totals_ = writer_.totals();
  }
}

Recorder::Totals Recorder::totals() {
  const std::lock_guard lock(mutex_);
  return totals_;
}

Result<Recorder::End> Recorder::run(const std::function<bool()>& is_over,
                                    const std::function<void(const Totals&)>& look) {
  std::vector<Feed*> patient;
  std::vector<std::jthread> readers;
  std::jthread writer([this] { write(); });
  struct Stop {  // also by an exception: the threads are joined next
    Recorder& of;
    ~Stop() {
      of.stopping_ = true;
      of.queue_.close();
    }
  } stop{*this};
  for (const auto& feed : feeds_)
    if (!feed->is_hasty())
      patient.push_back(feed.get());
    else
      readers.emplace_back([this, one = std::vector{feed.get()}] { read(one, 0); });
  if (!patient.empty()) readers.emplace_back([this, patient] { read(patient, kPause_ns); });

  const auto begin_ns = now_ns();
  for (auto next_ns = begin_ns + kLook_ns; !stopping_ && !is_over();) {
    sleep_until_ns(now_ns() + kTurn_ns);
    if (now_ns() < next_ns) continue;
    next_ns += kLook_ns;
    look(totals());
  }
  stopping_ = true;
  readers.clear();  // joins them
  const double seconds = ns_to_seconds(now_ns() - begin_ns);
  queue_.close();
  writer.join();
  auto reason = finish();
  look(writer_.totals());
  if (!reason) return tl::make_unexpected(std::move(reason.error()));
  return End{std::move(*reason), seconds};
}

Result<std::string> Recorder::finish() {
  const bool rig_is_down = !well_ && well_.error().code == Errc::disconnected;
  std::vector<std::uint64_t> lost;
  for (const auto& feed : feeds_) lost.push_back(feed->lost());
  // Messages are left only if the writer has given up.
  for (auto left = queue_.pop(); left; left = queue_.pop()) lost[left->stream] += 1 + left->lost;
  const std::string reason = well_ ? "it was stopped" : well_.error().what;
  auto finished = writer_.finish(reason, lost);
  if (!well_ && !rig_is_down) return tl::make_unexpected(well_.error());
  if (!finished) return tl::make_unexpected(std::move(finished.error()));
  return reason;
}

namespace {

/// Memory for messages that are not written yet, of one ring: half a second of images.
constexpr std::size_t kMostBytes = std::size_t{128} << 20;

/// The settings of the rig as it runs. Errors: those of ask_for_rig(), parse_rig().
Result<config::Rig> settings_of(const std::string& rig) {
  const auto text = control::ask_for_rig(rig);
  if (!text) return tl::make_unexpected(text.error());
  return config::parse_rig(*text, "applied rig");
}

/// The calibration file, as the services have read it: with the same text it has the same id.
Result<std::string> calibration_of(const config::Rig& rig) {
  if (rig.calibration.empty()) return calib::print_calibration(calib::reference_rig());
  auto file = config::read_file_or_frozen(rig.calibration);
  if (!file) return tl::make_unexpected(file.error());
  return std::move(file->text);
}

/// Takes the pictures and hand models of a rig into its recording, so that another computer can
/// play it. Those that cannot be taken stay where they are, with a warning.
std::map<std::string, std::string> take_files(config::Rig& rig) {
  std::map<std::string, std::string> files;
  for (auto& [setting, name] :
       {std::pair<std::string&, const char*>{rig.content.left, "content_left"},
        {rig.content.right, "content_right"},
        {rig.hand.left, "hand_left"},
        {rig.hand.right, "hand_right"}}) {
    const bool is_content = std::string_view(name).starts_with("content");
    if (setting.empty() || (is_content && !config::is_path("content.left", setting))) continue;
    const auto ending = std::filesystem::path(setting).extension().string();
    auto contents = read_input(setting, kMostMesh);
    if (!contents || ending == ".gltf") {
      log::warning("record: the recording does not contain '{}': {}", setting,
                   contents ? "a .gltf file has its buffers elsewhere; convert it to .glb"
                            : contents.error().what);
      continue;
    }
    setting = name + ending;
    files[setting] = std::move(*contents);
  }
  return files;
}

/// What a recording says of its rig. Without its settings, the images are recorded all the same.
recording::RecordingWriter::About about_of(const std::string& name) {
  auto rig = settings_of(name);
  if (!rig) {
    log::warning("record: the recording has no settings and no calibration: {}", rig.error().what);
    return {name, "# " + rig.error().what + "\n", "", {}};
  }
  auto files = take_files(*rig);
  auto calibration = calibration_of(*rig);
  if (!calibration) {
    log::warning("record: the recording has no calibration: {}", calibration.error().what);
    return {name, config::print_rig(*rig), "", std::move(files)};
  }
  rig->calibration = std::string(recording::kCalibrationFile);
  return {name, config::print_rig(*rig), std::move(*calibration), std::move(files)};
}

Result<std::vector<std::unique_ptr<Feed>>> open_feeds(const std::string& rig,
                                                      const std::vector<std::string>& streams) {
  const auto begin_ns = now_ns();
  std::vector<std::unique_ptr<Feed>> feeds;
  for (const auto& name : streams) {
    auto feed = open_feed(rig, name, {feeds.size(), kMostBytes, begin_ns});
    if (!feed) return tl::make_unexpected(std::move(feed.error()));
    feeds.push_back(std::move(*feed));
  }
  return feeds;
}

/// What is said once a second, on one line.
class Progress {
 public:
  void look(const Recorder::Totals& totals) const {
    if (!is_terminal_) return;
    std::uint64_t bytes = 0, lost = 0, messages = 0;
    for (const auto& total : totals)
      bytes += total.bytes, lost += total.lost, messages += total.messages;
    const double seconds = ns_to_seconds(now_ns() - begin_ns_);
    log::put(fmt::format("\r{:.0f} s: {} messages, {:.1f} MB, {:.0f} MB/min, {} lost   ", seconds,
                         messages, 1e-6 * static_cast<double>(bytes),
                         60e-6 * static_cast<double>(bytes) / std::max(seconds, 0.1), lost));
  }
  void end() const {
    if (is_terminal_) log::put("\n");
  }
  double seconds() const { return ns_to_seconds(now_ns() - begin_ns_); }

 private:
  bool is_terminal_ = inherited::is_terminal(STDERR_FILENO);
  std::int64_t begin_ns_ = now_ns();
};

void print_totals(const Recorder::Totals& totals, double seconds) {
  fmt::print("{:<20} {:>10} {:>8} {:>10} {:>10}\n", "ring", "messages", "lost", "MB", "MB/min");
  for (const auto& total : totals) {
    const double megabytes = 1e-6 * static_cast<double>(total.bytes);
    fmt::print("{:<20} {:>10} {:>8} {:>10.1f} {:>10.1f}\n", total.stream, total.messages,
               total.lost, megabytes, 60 * megabytes / seconds);
  }
}

}  // namespace

Result<void> record(const Options& options) {
  const auto rig = control::choose_rig(options.rig);
  if (!rig) return tl::make_unexpected(rig.error());
  auto there = client::stream_names(*rig);
  if (!there) return tl::make_unexpected(there.error());
  // Projections have what was shown.
  std::erase_if(*there, [](const std::string& stream) {
    return stream == msg::kTestPictures || stream.starts_with("content.") ||
           msg::is_for_guests(stream) || stream == msg::kLiveSettings;
  });
  const auto streams = choose(options.rings, *there);
  if (!streams) return tl::make_unexpected(streams.error());
  auto writer = recording::RecordingWriter::create(options.folder, about_of(*rig), *streams);
  if (!writer) return tl::make_unexpected(writer.error());
  auto feeds = open_feeds(*rig, *streams);
  if (!feeds) return tl::make_unexpected(feeds.error());

  for (const auto& obstacle : inherited::obstacles()) log::warning("record: {}", obstacle);
  daemon::install_stop_signals();
  if (!inherited::is_ignored(SIGHUP))
    std::signal(SIGHUP, [](int) { std::raise(SIGTERM); });  // the terminal was closed
  Recorder recorder(std::move(*feeds), std::move(*writer));
  const Progress progress;
  Recorder::Totals totals;
  const auto is_over = [&] {
    return daemon::stop_requested() ||
           (options.seconds > 0 && progress.seconds() >= options.seconds);
  };
  const auto ended = recorder.run(is_over, [&](const auto& now) { progress.look(totals = now); });
  progress.end();
  print_totals(totals, ended ? ended->seconds : progress.seconds());
  if (!ended) return tl::make_unexpected(ended.error());
  fmt::print("{}: {:.1f} s recorded, until {}\n", options.folder.string(), ended->seconds,
             ended->reason);
  return options.npy ? write_npy_folder(options.folder) : Result<void>();
}

}  // namespace handcast::record
