// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/model.hpp"

namespace handcast::dlp {
namespace {

using protocol::Command;

constexpr std::uint8_t kVideoPatternMode = 2;
constexpr std::uint8_t kSourceLocked = 0x08;  ///< of the main status
/// The change to the pattern mode takes about 0.3 s; after this time it is asked for again.
constexpr std::int64_t kChange_ns = 2'000'000'000;

class Dlpc900 final : public Model {
 public:
  Result<bool> has_signal(Link&, const protocol::Status& status, Deadline) override {
    return (status.main & kSourceLocked) != 0;
  }

  Result<void> show_video(Link& link, Deadline deadline) override {
    return send_all(link, {{Command::display_mode, {protocol::kVideoMode}}}, deadline);
  }

  /// The pattern mode can only be entered from the video mode, with a signal.
  Result<std::string> prepare(Link& link, const Sequence& sequence, const Triggers& triggers,
                              std::vector<std::string>&, Deadline deadline) override {
    const auto mode = link.read(Command::display_mode, 1, deadline);
    if (!mode) return tl::make_unexpected(mode.error());
    const bool changed = (mode->front() & 3) == kVideoPatternMode;
    auto done = changed ? send_all(link, encode_for_dlpc900(sequence, triggers), deadline)
                        : change_mode(link, deadline);
    if (!done) return tl::make_unexpected(done.error());
    if (!changed) return std::string("its change to the pattern mode");
    asked_ns_ = 0;
    return std::string();
  }

 private:
  Result<void> change_mode(Link& link, Deadline deadline) {
    if (now_ns() - asked_ns_ < kChange_ns) return {};
    auto done = send_all(link,
                         {{Command::display_mode, {protocol::kVideoMode}},
                          {Command::display_mode, {kVideoPatternMode}}},
                         deadline);
    if (done) asked_ns_ = now_ns();
    return done;
  }

  std::int64_t asked_ns_ = 0;
};

}  // namespace

std::unique_ptr<Model> make_dlpc900() { return std::make_unique<Dlpc900>(); }

}  // namespace handcast::dlp
