// SPDX-License-Identifier: Apache-2.0
#include "services/studies/shooter/run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "renderer/hand/hand_posture.hpp"
#include "services/studies/base/rig_hand.hpp"
#include "services/studies/base/study_command.hpp"
#include "services/studies/shooter/picture.hpp"
#include "services/studies/shooter/speaker.hpp"

namespace handcast::study {
namespace {

constexpr int kWidth_px = 1024, kHeight_px = 640;
constexpr float kFullTilt_rad = 0.45f;
constexpr char kNotes[] =
    R"(Start it beside a rig that is up and show your palm: tilt it about the forearm to steer. The ship shoots by itself. Lives are
on the fingers, the score is on the thumb. With --two-hands, both hands have one score, one set of lives and one wave:
who has no aliens left gets half of the other hand's. With --keys, a and d steer in this terminal, for a rig without a person.)";

/// Keys that are typed, without waiting for a line.
class Keys {
 public:
  Keys() {
    is_terminal_ = tcgetattr(STDIN_FILENO, &before_) == 0;
    if (!is_terminal_) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keys() {
    if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  /// -1 to 1: how far the keys so far have steered.
  float steering() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char key = 0;
    while (poll(&input, 1, 0) > 0 && read(STDIN_FILENO, &key, 1) == 1) {
      if (key == 'a') at_ -= 0.15f;
      if (key == 'd') at_ += 0.15f;
      at_ = std::clamp(at_, -1.f, 1.f);
    }
    return at_;
  }

 private:
  termios before_{};
  bool is_terminal_ = false;
  float at_ = 0;
};

struct Options {
  std::string rig, sound;
  msg::Side side = msg::Side::left;
  Face face = Face::palm;
  bool keys = false, two_hands = false;
  double seconds = 0, seed = 1;
};

/// A hand that plays.
struct PlayingHand {
  RigHand hand;
  ShooterPicture picture;
  TiltSteering tilt;
};

Result<std::vector<PlayingHand>> open_hands(const Options& options) {
  std::vector<PlayingHand> hands;
  std::vector<msg::Side> sides{options.side};
  if (options.two_hands) sides = {msg::Side::left, msg::Side::right};
  for (const auto side : sides) {
    auto hand = RigHand::open(options.rig, side, kWidth_px, kHeight_px, "study shooter");
    if (!hand) return tl::make_unexpected(hand.error());
    const auto mesh = hand->mesh();
    if (!mesh) return tl::make_unexpected(mesh.error());
    ShooterPicture picture(*mesh, kWidth_px, kHeight_px);
    hands.push_back({std::move(*hand), std::move(picture), TiltSteering(side)});
  }
  return hands;
}

Result<std::string> play(const Options& options) {
  auto hands = open_hands(options);
  if (!hands) return tl::make_unexpected(hands.error());
  ShooterGame game(static_cast<std::uint64_t>(options.seed), hands->size());
  ShooterSpeaker speaker(options.sound);
  std::optional<Keys> keys;
  if (options.keys) keys.emplace();
  const double begin_s = ns_to_seconds(now_ns());
  double last_s = begin_s;
  int best = 0;
  std::vector<ShooterPlayer> players(hands->size());
  while (!daemon::stop_requested() &&
         (options.seconds <= 0 || last_s - begin_s < options.seconds)) {
    for (auto& each : *hands)
      if (auto waited = each.hand.wait(); !waited) return tl::make_unexpected(waited.error());
    const double now_s = ns_to_seconds(now_ns());
    const float by_keys = keys ? keys->steering() : 0;
    for (std::size_t i = 0; i < players.size(); ++i) {
      const auto& joints = (*hands)[i].hand.joints();
      players[i].is_seen = joints.has_value();
      players[i].steer = keys ? by_keys : joints ? (*hands)[i].tilt.at(now_s, *joints) : 0;
    }
    speaker.play(game.step(now_s - last_s, players));
    last_s = now_s;
    best = std::max(best, game.scene().score);
    for (std::size_t i = 0; i < players.size(); ++i) {
      auto& [hand, picture, tilt] = (*hands)[i];
      auto shown = hand.show(picture.draw(game.scene(i), options.face, now_s - begin_s));
      if (!shown) return tl::make_unexpected(shown.error());
    }
  }
  return fmt::format("Best score: {}\n", best);
}

}  // namespace

float TiltSteering::at(double time_s, const std::array<glm::vec3, msg::kJoints>& joints) {
  const glm::mat3 axes = renderer::palm_axes(joints, side_);
  constexpr double kAway_s = 1;
  if (!rest_ || time_s - seen_s_ > kAway_s) rest_ = axes;
  seen_s_ = time_s;
  // The turn about the arm's axis takes x to y. Who looks at the palm sees it the other way round.
  const float turn = std::atan2(glm::dot(axes[0], (*rest_)[1]), glm::dot(axes[0], (*rest_)[0]));
  return std::clamp(turn / kFullTilt_rad, -1.f, 1.f);
}

int run_shooter(int argc, char** argv) {
  Options options;
  CommandLine line("handcast study shooter", "A game on the palm: aliens come from the fingers.",
                   kNotes);
  add_rig_hand(line, options.rig, options.side);
  line.add(
      "--face palm|back",
      [&](const std::string& face) {
        options.face = face == "palm" ? Face::palm : Face::back;
        return Result<void>();
      },
      "The side of the hand that is played on");
  line.add("--two-hands", options.two_hands, "Plays one game on both hands");
  line.add("--sound DEVICE", options.sound,
           "Plays sounds on a sound device, by its ALSA name, e.g. default");
  line.add("--keys", options.keys, "Steers by the keys a and d instead");
  line.add("--seconds N", options.seconds, "Ends after so many seconds", {1, 86400});
  line.add("--seed S", options.seed, "Seed of all random numbers", {0, 1e15});
  if (const auto code = line.answered(argc, argv)) return *code;
  daemon::install_stop_signals();  // so that the rig shows again what it showed before
  return end_of("handcast study shooter", play(options));
}

}  // namespace handcast::study
