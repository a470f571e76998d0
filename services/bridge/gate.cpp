// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/gate.hpp"

#include <fmt/format.h>

#include <numeric>

#include "ipc/base/clock.hpp"
#include "ipc/msg/check_guest.hpp"

namespace handcast::bridge {

tl::unexpected<Error> Gate::refuse(Refusal why, std::string sentence) {
  ++refused_[static_cast<std::size_t>(why)];
  return fail(Errc::bad_data, fmt::format("{}: {}", stream_, sentence));
}

Result<OurTimes> Gate::admit(const Claim& claim, const Result<void>& content, const ClockMap* clock,
                             std::int64_t now_ns) {
  const auto& who = claim.name;
  if (claim.version != kWireVersion)
    return refuse(Refusal::version,
                  fmt::format("{} speaks version {} of the bridge, this computer version {}", who,
                              claim.version, kWireVersion));
  if (!claim.is_its_own)
    return refuse(Refusal::identity, fmt::format("{} sends in the name of another", who));
  if (!from_.empty() && who != from_)
    return refuse(Refusal::unwanted, fmt::format("{} also sends; bridge.from is {}", who, from_));
  const bool is_held = holder_ && now_ns - used_ns_ < kHold_ns;
  if (is_held && *holder_ != claim.peer)
    return refuse(Refusal::second, fmt::format("{} also sends; {} was first and is used until it "
                                               "stops",
                                               who, name_));
  if (!content) return refuse(Refusal::content, fmt::format("{}: {}", who, content.error().what));

  const auto published_ns = clock ? clock->to_ours(claim.published_ns) : std::nullopt;
  const auto origin_ns = clock ? clock->to_ours(claim.origin_ns) : std::nullopt;
  if (!published_ns || !origin_ns)
    return refuse(Refusal::clock, fmt::format("{}: its clock is not known yet", who));
  const auto error_ns = clock->at(now_ns)->error_ns;
  if (*published_ns - error_ns > now_ns || *origin_ns > *published_ns + msg::kGuestAhead_ns)
    return refuse(Refusal::future,
                  fmt::format("{}: a message is {:.3g} ms of the future", who,
                              ns_to_ms(std::max(*published_ns, *origin_ns) - now_ns)));
  if (now_ns - *origin_ns + error_ns > oldest_ns_)
    return refuse(
        Refusal::old,
        fmt::format("{}: a message is {:.3g} ms old, and its clock is known to {:.3g} ms; "
                    "bridge.oldest_ms is {:g}",
                    who, ns_to_ms(now_ns - *origin_ns), ns_to_ms(error_ns), ns_to_ms(oldest_ns_)));
  if (is_held && claim.origin_ns <= last_origin_ns_)
    return refuse(Refusal::overtaken, fmt::format("{}: a message came after a newer one", who));
  holder_ = claim.peer;
  name_ = who;
  last_origin_ns_ = claim.origin_ns;
  used_ns_ = now_ns;
  ++admitted_;
  return OurTimes{*origin_ns, *published_ns};
}

bool Gate::leave(Peer peer) {
  if (holder_ != peer) return false;
  holder_.reset();
  return true;
}

std::optional<std::string> Gate::news(std::int64_t now_ns) {
  if (used_ns_ == 0) return std::nullopt;
  const bool is_silent = !holder_ || now_ns - used_ns_ >= kHold_ns;
  if (is_silent && told_ == Told::comes) {
    told_ = Told::silent;
    silent_ns_ = used_ns_;
    return fmt::format("{}: {} {}; nothing else on this computer is affected", stream_, name_,
                       holder_ ? fmt::format("has sent nothing usable for {:.2g} s",
                                             ns_to_seconds(now_ns - used_ns_))
                               : "is gone");
  }
  if (!is_silent && (told_ != Told::comes || told_name_ != name_)) {
    const bool is_back = told_ == Told::silent && told_name_ == name_;
    told_ = Told::comes;
    told_name_ = name_;
    return is_back ? fmt::format("{}: {} is back after {:.2f} s", stream_, name_,
                                 ns_to_seconds(used_ns_ - silent_ns_))
                   : fmt::format("{} comes from {}", stream_, name_);
  }
  return std::nullopt;
}

std::uint64_t Gate::refused() const {
  return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0});
}

}  // namespace handcast::bridge
