// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/recorder.hpp"

#include <unistd.h>

#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"

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

}  // namespace handcast::record
