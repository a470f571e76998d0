// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/check_guest.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/shm/open_ring.hpp"

namespace handcast::service {

/// What a program outside the rig sends, checked. The program may write anything at any rate, stop
/// in the middle or die: at most 2000 messages a second are looked at, and a reader whose words
/// were overwritten is replaced. One thread.
template <class T>
class GuestStream {
 public:
  /// `ring` gives the rings of the rig. Errors: unavailable (there is no rig), those of the ring.
  static Result<GuestStream> open(const ipc::OpenRing& ring, std::string_view stream,
                                  ipc::Wait wait) {
    if (!ring) return fail(Errc::unavailable, "other programs send only to a rig that is up");
    GuestStream guests(ring, std::string(stream), wait);
    if (auto renewed = guests.renew(); !renewed) return tl::make_unexpected(renewed.error());
    return guests;
  }

  /// The newest message that was not seen yet; waits for it until the deadline. Errors: timeout,
  /// bad_data (one was left out; the sentence says why).
  Result<ipc::Sample<T>> latest(Deadline deadline) {
    sleep_until_ns(std::min(deadline.time_ns(), next_ns_));
    const auto begin_ns = now_ns();
    if (begin_ns < next_ns_) return silence();
    auto sample = reader_->latest(deadline);
    const auto time_ns = now_ns();
    const bool is_noise = !sample && sample.error().code != Errc::timeout;
    next_ns_ = time_ns + (is_noise ? kAfterNoise_ns : kShortest_ns);
    if (is_noise || (sample && was_not_woken(*sample, begin_ns, time_ns))) (void)renew();
    if (is_noise) return left_out(sample.error().what);
    if (!sample) return silence();
    if (auto usable = check(**sample, time_ns); !usable) return left_out(usable.error().what);
    return sample;
  }

 private:
  static constexpr std::int64_t kShortest_ns = 500'000;  ///< between two messages
  static constexpr std::int64_t kAfterNoise_ns = 10'000'000;
  static constexpr std::int64_t kLate_ns = 10'000'000;  ///< of a wake-up

  GuestStream(ipc::OpenRing ring, std::string stream, ipc::Wait wait)
      : ring_(std::move(ring)), stream_(std::move(stream)), wait_(wait) {}

  /// Whether a message was found only because a reader looks again now and then: noise has
  /// overwritten its wish to be woken.
  bool was_not_woken(const ipc::Sample<T>& sample, std::int64_t begin_ns, std::int64_t time_ns) {
    const bool has_skipped = std::exchange(skipped_, reader_->skipped()) != reader_->skipped();
    const auto published_ns = sample->header.published_ns;
    return begin_ns < time_ns - kLate_ns &&
           (has_skipped || (published_ns > begin_ns && published_ns < time_ns - kLate_ns));
  }

  /// Reads the ring anew, from the next message on. The reader before stays if that fails.
  Result<void> renew() {
    auto segment = ring_(stream_);
    if (!segment) return tl::make_unexpected(segment.error());
    auto reader = ipc::Reader<T>::attach(std::move(*segment), wait_, ipc::Hold::copy);
    if (!reader) return tl::make_unexpected(reader.error());
    (void)reader->latest(Deadline::now());  // seen already, or left by a program that is gone
    reader_ = std::move(*reader);
    skipped_ = reader_->skipped();
    return {};
  }

  Result<void> check(const T& message, std::int64_t time_ns) {
    heard_ns_ = time_ns;
    if (auto time = msg::check_guest_time(message.header.origin_ns, last_ns_, time_ns); !time)
      return time;
    if (auto fits = msg::check_guest(message); !fits) return fits;
    last_ns_ = message.header.origin_ns;
    return {};
  }

  tl::unexpected<Error> left_out(const std::string& why) const {
    return fail(Errc::bad_data,
                fmt::format("what a program sent to {} was left out: {}", stream_, why));
  }
  tl::unexpected<Error> silence() const {
    if (heard_ns_ == 0)
      return fail(Errc::timeout, fmt::format("no program has sent anything to {} yet", stream_));
    return fail(Errc::timeout, fmt::format("nothing was sent to {} for {:.1f} s", stream_,
                                           ns_to_seconds(now_ns() - heard_ns_)));
  }

  ipc::OpenRing ring_;
  std::string stream_;
  ipc::Wait wait_;
  std::optional<ipc::Reader<T>> reader_;
  std::uint64_t skipped_ = 0;  ///< by this reader
  std::int64_t last_ns_ = 0;   ///< the origin of the last message that was passed on
  std::int64_t heard_ns_ = 0;  ///< when the last message came; 0: none yet
  std::int64_t next_ns_ = 0;   ///< no message is looked at before
};

}  // namespace handcast::service
