// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"
#include "services/bridge/clock_map.hpp"

namespace handcast::bridge {

/// Raised when a type of wire.idl changes.
inline constexpr std::uint32_t kWireVersion = 1;

/// Another computer's bridge, by the number that DDS gave it here.
using Peer = std::uint64_t;

/// What a message says about itself. Anybody in the domain may have written it.
struct Claim {
  Peer peer = 0;     ///< whose writer it came from: DDS knows it, the message does not say it
  std::string name;  ///< of the rig and its computer: "stage@left", printable
  std::uint32_t version = kWireVersion;
  bool is_its_own = true;  ///< it says that it is of that peer
  /// By the clock of the other computer: of the message's header.
  /// @{
  std::int64_t origin_ns = 0, published_ns = 0;
  /// @}
};

/// Why a message is not used, in the order in which it is asked.
enum class Refusal { version, identity, unwanted, second, content, clock, future, old, overtaken };
inline constexpr std::size_t kRefusals = 9;

/// The times of a message by our clock.
struct OurTimes {
  std::int64_t origin_ns = 0, published_ns = 0;
};

/// Which messages of one stream are used. One peer holds the stream: the first whose message can be
/// used, until it is gone or sends nothing usable for kHold_ns. One thread.
class Gate {
 public:
  static constexpr std::int64_t kHold_ns = 1'000'000'000;

  /// `stream`: "pose.hands". `from`: the name of the only peer that is wanted; "": any.
  /// `oldest_ns`: the oldest that a message may be.
  Gate(std::string stream, std::string from, std::int64_t oldest_ns)
      : stream_(std::move(stream)), from_(std::move(from)), oldest_ns_(oldest_ns) {}

  /// The times of a message that is used. `content`: whether its numbers are those of hands.
  /// `clock`: that of the peer; null: not known. Errors: bad_data, with a sentence.
  Result<OurTimes> admit(const Claim& claim, const Result<void>& content, const ClockMap* clock,
                         std::int64_t now_ns);
  /// A peer is gone. Returns whether it held the stream.
  bool leave(Peer peer);

  /// What there is to say of who sends, once: "pose.hands comes from stage@left".
  std::optional<std::string> news(std::int64_t now_ns);

  /// Who holds the stream; empty: nobody.
  std::optional<Peer> holder() const { return holder_; }
  const std::string& holder_name() const { return name_; }
  std::uint64_t admitted() const { return admitted_; }
  std::uint64_t refused() const;
  std::uint64_t refused(Refusal why) const { return refused_[static_cast<std::size_t>(why)]; }

 private:
  tl::unexpected<Error> refuse(Refusal why, std::string sentence);

  std::string stream_, from_;
  std::int64_t oldest_ns_;
  std::optional<Peer> holder_;
  std::string name_;                 ///< of the one who holds it, or held it last
  std::int64_t last_origin_ns_ = 0;  ///< theirs
  std::int64_t used_ns_ = 0;         ///< when a message was used last; 0: never
  std::uint64_t admitted_ = 0;
  std::array<std::uint64_t, kRefusals> refused_{};
  enum class Told { nothing, comes, silent } told_ = Told::nothing;
  std::int64_t silent_ns_ = 0;  ///< since when, if told
  std::string told_name_;
};

}  // namespace handcast::bridge
