// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/options.hpp"

#include "ipc/base/verb_options.hpp"

namespace handcast::init {

Result<Options> parse(int argc, char** argv) {
  CLI::App app(
      "Looks at what is attached, asks what the rig is made of, and writes a commented rig file. "
      "Each option below answers a question; without a terminal nothing is asked, and the best "
      "guess is taken.",
      "handcast init");
  Options options;
  auto& flags = options.flags;
  app.add_option("RIG.toml", options.file, "The file to write")->capture_default_str();
  app.add_option("--camera", flags.camera,
                 "A camera, as `handcast devices` lists it, or twin: the digital twin");
  app.add_option("--output", flags.output,
                 "A display, as `handcast devices` lists it, or file: pictures in a folder, or "
                 "twin");
  app.add_option("--tracker", flags.tracker,
                 "none, or one that `handcast devices` lists: leapc, openxr; or twin (with the "
                 "camera twin). For two cameras in place of a tracker copy config/rigs/stereo.toml "
                 "or leap_stereo.toml");
  app.add_option("--distance", flags.distance,
                 "Without a tracker: metres from the camera to the hand");
  app.add_option("--calibration", flags.calibration,
                 "The calibration file of camera and projector, or none");
  app.add_option("--name", flags.name, "Of the rig; otherwise that of the file");
  app.add_flag("--yes,-y", options.yes, "Asks nothing and takes the best guess");
  app.add_flag("--force", options.force, "Replaces a file that exists");
  auto text = parse_options(app, argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  options.text = std::move(*text);
  return options;
}

}  // namespace handcast::init
