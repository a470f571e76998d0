// SPDX-License-Identifier: Apache-2.0
// handcast preview: what a running rig sees and does, as a picture.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "renderer/window/window.hpp"
#include "services/tools/preview/keys.hpp"
#include "services/tools/preview/options.hpp"
#include "services/tools/preview/rig_feed.hpp"
#include "services/tools/preview/rig_follower.hpp"

namespace handcast::preview {
namespace {

/// Watches a rig for options.after_s and writes a picture. Errors: those of RigFeed, bad_config or
/// unavailable (the file cannot be written).
Result<void> shoot(const Options& options) {
  if (auto possible = check_result_file(options.shot); !possible) return possible;
  auto feed = RigFeed::open(options.rig, options.projector);
  if (!feed) return tl::make_unexpected(std::move(feed.error()));
  const auto end_ns = now_ns() + seconds_to_ns(options.after_s);
  for (auto next_ns = now_ns(); next_ns < end_ns; next_ns += RigFeed::kPeriod_ns) {
    sleep_until_ns(next_ns);
    if (auto well = feed->look(); !well) return well;
  }
  const auto picture = draw(feed->scene(), feed->gauges(), options.look);
  return renderer::write_png(options.shot, picture.view());
}

#ifdef HANDCAST_WITH_WINDOW
constexpr std::int64_t kNote_ns = 3'000'000'000;  ///< how long a note is shown
/// Pause after a drawing, as a multiple of its duration: drawing takes a third of a core at most,
/// and less if the machine is busy.
constexpr std::int64_t kRest = 2;

/// Does not run destructors: there is nothing to close, and the display is gone.
void give_up() {
  fmt::print(stderr, "handcast preview: the display server is gone\n");
  std::_Exit(kExitRetry);
}

Result<std::unique_ptr<renderer::Window>> open_window(const std::string& rig, const Look& look) {
  renderer::WindowSettings settings;
  settings.title = "handcast " + rig;
  settings.width_px = look.width_px;
  settings.height_px = look.height_px;
  settings.vsync = false;  // the pace is that of the reads
  settings.when_display_is_lost = give_up;
  auto window = renderer::Window::open(std::move(settings));
  if (!window) window.error().what += "; use --shot FILE.png for a picture without a window";
  return window;
}

/// The first name that no file has: preview-1.png and so on.
std::filesystem::path free_name() {
  for (int number = 1;; ++number)
    if (auto file = fmt::format("preview-{}.png", number); !std::filesystem::exists(file))
      return file;
}

std::string save(const renderer::Texture& picture) {
  const auto file = free_name();
  const auto saved = renderer::write_png(file, picture.view());
  return saved ? "saved " + file.string() : saved.error().what;
}

/// The window with what it shows.
class Show {
 public:
  Show(RigFeed feed, renderer::Window& window, const Look& look)
      : rig_(std::move(feed)), window_(window), look_(look) {}

  /// Reads once; draws and obeys if it is time. Returns false if the user ends.
  bool turn() {
    rig_.look();
    const auto begin_ns = now_ns();
    if (begin_ns < next_draw_ns_) return true;
    const bool goes_on = redraw();
    next_draw_ns_ = now_ns() + kRest * (now_ns() - begin_ns);
    return goes_on;
  }

 private:
  bool redraw() {
    if (!look_.frozen) {
      scene_ = rig_.scene();
      gauges_ = rig_.gauges();
    }
    if (now_ns() > note_until_ns_) look_.note.clear();
    look_.width_px = window_.width_px();
    look_.height_px = window_.height_px();
    const auto picture = draw(scene_, gauges_, look_);
    (void)window_.show(picture.view(), {0, 0, picture.width(), picture.height()});
    for (const auto& key : window_.take_keys()) {
      const auto wish = obey(key, look_);
      if (wish == Wish::quit) return false;
      if (wish != Wish::shot) continue;
      look_.note = save(picture);
      note_until_ns_ = now_ns() + kNote_ns;
    }
    return !window_.is_closed();
  }

  RigFollower rig_;
  renderer::Window& window_;
  Look look_;
  Scene scene_;
  Gauges gauges_;
  std::int64_t note_until_ns_ = 0, next_draw_ns_ = 0;
};

/// Shows a rig in a window until the user ends it, also if the rig goes down and comes up again.
/// Call it on the main thread. Errors: those of RigFeed::open(), unavailable (no display, or no
/// OpenGL).
Result<void> show_live(const Options& options) {
  auto feed = RigFeed::open(options.rig, options.projector);
  if (!feed) return tl::make_unexpected(std::move(feed.error()));
  auto window = open_window(feed->rig(), options.look);
  if (!window) return tl::make_unexpected(std::move(window.error()));
  Show show(std::move(*feed), **window, options.look);
  for (auto next_ns = now_ns();; next_ns = std::max(next_ns + RigFeed::kPeriod_ns, now_ns())) {
    sleep_until_ns(next_ns);
    if (!show.turn()) return {};
  }
}
#endif

}  // namespace
}  // namespace handcast::preview

static int complain(int exit_code, const std::string& sentence) {
  fmt::print(stderr, "handcast preview: {}\n", handcast::printable(sentence));
  return exit_code;
}

static handcast::Result<void> show(const handcast::preview::Options& options) {
  using namespace handcast;
  if (!options.shot.empty()) return preview::shoot(options);
#ifdef HANDCAST_WITH_WINDOW
  return preview::show_live(options);
#else
  return fail(Errc::bad_config,
              "this build has no window (libglfw3-dev was not found); use --shot FILE.png");
#endif
}

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  const auto parsed = preview::parse(argc, argv);
  const auto text = parsed.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast preview", text)) return *code;
  if (::nice(10) == -1) fmt::print(stderr, "handcast preview: the priority cannot be lowered\n");
  const auto done = show(parsed->options);
  if (!done) return complain(exit_code_of(done.error()), done.error().what);
  if (!parsed->options.shot.empty()) fmt::print("wrote {}\n", parsed->options.shot.string());
  return kExitDone;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast preview", argc, argv, run_verb);
}
