// SPDX-License-Identifier: Apache-2.0
// handcast preview: what a running rig sees and does, as a picture.

#include <fmt/format.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "services/tools/preview/live.hpp"
#include "services/tools/preview/options.hpp"
#include "services/tools/preview/rig_feed.hpp"

namespace handcast::preview {
namespace {

/// Watches a rig for options.after_s and writes a picture. Errors: those of RigFeed, bad_config or
/// unavailable (the file cannot be written).
Result<void> shoot(const Options& options) {
  if (auto possible = check_writable(options.shot); !possible) return possible;
  auto feed = RigFeed::open(options.rig);
  if (!feed) return tl::make_unexpected(std::move(feed.error()));
  const auto end_ns = now_ns() + seconds_to_ns(options.after_s);
  for (auto next_ns = now_ns(); next_ns < end_ns; next_ns += RigFeed::kPeriod_ns) {
    sleep_until_ns(next_ns);
    if (auto well = feed->look(); !well) return well;
  }
  const auto picture = draw(feed->scene(), feed->gauges(), options.look);
  return renderer::write_png(options.shot, picture.view());
}

}  // namespace
}  // namespace handcast::preview

static int complain(int exit_code, const std::string& sentence) {
  fmt::print(stderr, "handcast preview: {}\n", printable(sentence));
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
