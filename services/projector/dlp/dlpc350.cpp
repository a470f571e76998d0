// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "ipc/base/join.hpp"
#include "services/projector/dlp/model.hpp"

namespace handcast::dlp {
namespace {

using protocol::Command;

constexpr std::uint8_t kPatternMode = 1;
constexpr std::uint8_t kParallelRgb = 0;  ///< the HDMI input of the LightCrafter 4500
constexpr std::uint8_t kRgb444 = 0;
constexpr std::uint8_t kSignalBits = 3, kLocked = 2;
constexpr std::int64_t kValidation_ns = 5'000'000;  ///< between two questions

class Dlpc350 final : public Model {
 public:
  Result<bool> has_signal(Link& link, const protocol::Status&, Deadline deadline) override {
    const auto signal = link.read(Command::video_signal, 1, deadline);
    if (!signal) return tl::make_unexpected(signal.error());
    return (signal->front() & kSignalBits) == kLocked;
  }

  Result<void> show_video(Link& link, Deadline deadline) override {
    return send_all(link,
                    {{Command::source, {kParallelRgb}},
                     {Command::pixel_format, {kRgb444}},
                     {Command::display_mode, {protocol::kVideoMode}}},
                    deadline);
  }

  Result<std::string> prepare(Link& link, const Sequence& sequence, const Triggers& triggers,
                              std::vector<std::string>& events, Deadline deadline) override {
    auto done = send_all(link,
                         {{Command::source, {kParallelRgb}},
                          {Command::pixel_format, {kRgb444}},
                          {Command::display_mode, {kPatternMode}}},
                         deadline);
    if (done) done = send_all(link, encode_for_dlpc350(sequence, triggers), deadline);
    if (done) done = validate(link, events, deadline);
    if (!done) return tl::make_unexpected(done.error());
    return std::string();
  }

 private:
  /// The controller checks the sequence and says so when it is done.
  static Result<void> validate(Link& link, std::vector<std::string>& events, Deadline deadline) {
    if (auto begun = link.write(Command::validate, {{0}}, deadline); !begun) return begun;
    for (;;) {
      const auto bits = link.read(Command::validate, 1, deadline);
      if (!bits) return tl::make_unexpected(bits.error());
      if (!protocol::is_validating(bits->front())) return judge(bits->front(), events);
      sleep_until_ns(now_ns() + kValidation_ns);
    }
  }

  static Result<void> judge(std::uint8_t bits, std::vector<std::string>& events) {
    const auto validation = protocol::explain_validation(bits);
    for (const auto warning : validation.warnings)
      events.push_back(fmt::format("it warns of the sequence: {}", warning));
    if (validation.errors.empty()) return {};
    return fail(Errc::bad_config,
                fmt::format("the DLPC350 cannot show this sequence: {}; change projector.rate_hz, "
                            "projector.packing or dlp.trigger_in",
                            join(validation.errors, ", ")));
  }
};

}  // namespace

std::unique_ptr<Model> make_dlpc350() { return std::make_unique<Dlpc350>(); }

}  // namespace handcast::dlp
