// SPDX-License-Identifier: Apache-2.0
// handcast gallery: looks on moving hands, as a page.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/content/looks_folder.hpp"
#include "services/lab/gallery/gallery.hpp"

namespace handcast::gallery {
namespace {

const char* const kNotes =
    "SOURCE is written as content.left in a rig file; without one, all looks of handcast.\n"
    "A filter is shown over tiger, a transition from xray to lava. DIR/index.html shows all;\n"
    "DIR/NAME.png has the pictures of each, side by side.";

int complain(const Error& error) {
  fmt::print(stderr, "handcast gallery: {}\n", printable(error.what));
  return exit_code_of(error);
}

int write(const Wanted& wanted) {
  const auto looks = wanted.sources.empty() ? content::look_names() : wanted.sources;
  if (looks.empty())
    return complain({Errc::bad_config, "there are no looks in this installation; name a SOURCE"});
  if (!wanted.sheet.empty())
    if (const auto good = check_result_file(wanted.sheet); !good) return complain(good.error());
  auto stage = Gallery::open(wanted);
  if (!stage) return complain(stage.error());
  int code = kExitDone;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const auto shown = stage->show(looks[i]);
    fmt::print("{:>3}/{}  {}{}\n", i + 1, looks.size(), looks[i],
               shown ? fmt::format("  {:.1f} ms a picture", *shown) : "");
    std::fflush(stdout);
    if (!shown) code = complain(shown.error());
  }
  if (!wanted.sheet.empty())
    if (const auto written = stage->write_sheet(wanted.sheet); !written)
      return complain(written.error());
  const auto page = stage->write_page();
  if (!page) return complain(page.error());
  fmt::print("{}\n", page->string());
  return code;
}

}  // namespace
}  // namespace handcast::gallery

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  gallery::Wanted wanted;
  CommandLine line("handcast gallery", "Shows looks on the moving hands of the digital twin.",
                   gallery::kNotes);
  line.add("[SOURCE...]", wanted.sources, "What to show");
  line.add("-o, --out DIR", wanted.folder, "The folder of the page; it is created");
  line.add("--sheet FILE.png", wanted.sheet, "Writes one picture of each, with its name, too");
  line.add("--motion MOTION", wanted.motion, "How the hands move: as twin.motion");
  line.add("--frames N", wanted.frames, "Pictures of each", {1, 200});
  line.add("--seconds S", wanted.seconds, "That they last", {0.1, 60});
  line.add("--width N", wanted.width_px, "Width of a picture, px", {64, 1024});
  if (const auto code = line.answered(argc, argv)) return *code;
  return gallery::write(wanted);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast gallery", argc, argv, run_verb);
}
