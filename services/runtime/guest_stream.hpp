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
/// in the middle or die: at most 2000 messages a second are looked at, and a reader that noise has
/// led astray is replaced within a second. One thread.
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
  Result<T> latest(Deadline deadline) {
    sleep_until_ns(std::min(deadline.time_ns(), next_ns_));
    if (now_ns() < next_ns_) return silence();
    const auto sample = reader_->latest(deadline);
    const auto time_ns = now_ns();
    const bool is_ruined = !sample && sample.error().code != Errc::timeout;
    next_ns_ = is_ruined ? time_ns + kAfterNoise_ns : time_ns + kShortest_ns;
    if (sample) {
      heard_ns_ = time_ns;
      return checked(**sample, time_ns);
    }
    if (is_ruined || time_ns - renewed_ns_ > kRenewAfter_ns) (void)renew();
    return is_ruined ? left_out(sample.error().what) : silence();
  }

 private:
  static constexpr std::int64_t kShortest_ns = 500'000;  ///< between two messages
  static constexpr std::int64_t kAfterNoise_ns = 10'000'000;
  static constexpr std::int64_t kRenewAfter_ns = 1'000'000'000;

  GuestStream(ipc::OpenRing ring, std::string stream, ipc::Wait wait)
      : ring_(std::move(ring)), stream_(std::move(stream)), wait_(wait) {}

  /// Reads the ring anew, from the next message on. The reader before stays if that fails.
  Result<void> renew() {
    renewed_ns_ = now_ns();
    auto segment = ring_(stream_);
    if (!segment) return tl::make_unexpected(segment.error());
    auto reader = ipc::Reader<T>::attach(std::move(*segment), wait_, ipc::Hold::copy);
    if (!reader) return tl::make_unexpected(reader.error());
    (void)reader->latest(Deadline::now());  // seen already, or left by a program that is gone
    reader_ = std::move(*reader);
    return {};
  }

  Result<T> checked(const T& message, std::int64_t time_ns) {
    renewed_ns_ = time_ns;
    if (auto time = msg::check_guest_time(message.header.origin_ns, last_ns_, time_ns); !time)
      return left_out(time.error().what);
    if (auto fits = msg::check_guest(message); !fits) return left_out(fits.error().what);
    last_ns_ = message.header.origin_ns;
    return message;
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
  std::int64_t last_ns_ = 0;     ///< the origin of the last message that was passed on
  std::int64_t heard_ns_ = 0;    ///< when the last message came; 0: none yet
  std::int64_t renewed_ns_ = 0;  ///< when the reader was made, or was last seen to work
  std::int64_t next_ns_ = 0;     ///< no message is looked at before
};

}  // namespace handcast::service
