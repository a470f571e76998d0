// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/wait.hpp"
#include "ipc/client/rig_presence.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/ring/reader.hpp"

/// Reading the streams of a rig from a program that is not part of it:
///
///     auto frames = client::open_stream<msg::Projection>("twin", "projection.frames");
///     if (!frames) ...                                       // frames.error().what is a sentence
///     while (auto frame = frames->next(Deadline::in(1s))) ...  // (*frame)->target_ns
///
/// The message types and the streams that carry them are in ipc/msg. Such a reader cannot disturb
/// the rig: its mapping is read-only and it takes no place in the ring (ipc::Reader::watch()).
namespace handcast::client {

/// The messages of one stream of a rig, as ipc::Reader gives them, and the notice that the rig is
/// down. Goes on while services and the supervisor of the rig are replaced. One thread.
template <class T>
class Stream {
 public:
  /// Reads a ring; see open_stream().
  Stream(ipc::Reader<T> reader, RigPresence presence, std::string rig)
      : reader_(std::move(reader)), presence_(std::move(presence)), rig_(std::move(rig)) {}

  /// The message after the last one seen, in order; waits for it until the deadline. Messages that
  /// were overwritten are skipped and counted. Errors: timeout (none came), disconnected (the rig
  /// is down, which is noticed about 3 s after its last message, or was started anew: open the
  /// stream again), bad_data (the message or the ring is unusable), unavailable (no memory).
  Result<ipc::Sample<T>> next(Deadline deadline) {
    return wait(deadline, [this](Deadline until) { return reader_.next(until); });
  }
  /// The newest message not seen yet; waits for one until the deadline. Errors as for next().
  Result<ipc::Sample<T>> latest(Deadline deadline) {
    return wait(deadline, [this](Deadline until) { return reader_.latest(until); });
  }
  /// The message whose header.origin_ns is nearest to `origin_ns` among those in the ring. Does not
  /// wait. Errors: timeout (the ring is empty), bad_data, unavailable.
  Result<ipc::Sample<T>> at(std::int64_t origin_ns) { return reader_.at(origin_ns); }

  /// Name of the rig.
  const std::string& rig() const { return rig_; }
  /// The reader below, for its counters and event_fd().
  const ipc::Reader<T>& reader() const { return reader_; }

 private:
  /// Waits in slices, so that a long wait ends when the rig does.
  static constexpr std::int64_t kSlice_ns = 250'000'000;

  template <class Read>
  Result<ipc::Sample<T>> wait(Deadline deadline, const Read& read) {
    for (;;) {
      auto sample = read(Deadline::at_ns(std::min(deadline.time_ns(), now_ns() + kSlice_ns)));
      if (sample || sample.error().code != Errc::timeout) {
        presence_.heard();
        return sample;
      }
      if (auto present = presence_.silent(); !present)
        return tl::make_unexpected(std::move(present.error()));
      if (deadline.passed()) return sample;
    }
  }

  ipc::Reader<T> reader_;
  RigPresence presence_;
  std::string rig_;
};

/// Opens a stream of a rig of this user: `rig` is its name (empty: the only one that is up), T the
/// type of its messages, e.g. msg::Projection for "projection.frames". The first message is the
/// newest one, or the oldest one for next() on a stream with history. Errors: unavailable (no such
/// rig is up, or it does not answer within 2 s), bad_config (it has no such stream; the sentence
/// names those that it has), bad_data (the stream carries another type, or the rig is of another
/// version).
template <class T>
Result<Stream<T>> open_stream(const std::string& rig, std::string_view stream,
                              ipc::Wait wait = ipc::Wait::futex) {
  auto ring = rig_ring(rig, stream);
  if (!ring) return tl::make_unexpected(std::move(ring.error()));
  RigPresence presence(ring->rig, std::string(stream), ring->segment.created_ns());
  auto reader = ipc::Reader<T>::watch(std::move(ring->segment), wait);
  if (!reader) return tl::make_unexpected(std::move(reader.error()));
  return Stream<T>(std::move(*reader), std::move(presence), std::move(ring->rig));
}

}  // namespace handcast::client
