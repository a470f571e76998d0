// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/options.hpp"

#include "ipc/base/command_line.hpp"

namespace handcast::init {

Result<Options> parse(int argc, char** argv) {
  CommandLine line(
      "handcast init",
      "Looks at what is attached, asks what the rig is made of, and writes a commented rig file. "
      "Each option below answers a question; without a terminal nothing is asked, and the best "
      "guess is taken.");
  Options options;
  auto& flags = options.flags;
  line.add("[RIG.toml]", options.file, "The file to write");
  line.add("--camera NAME", flags.camera,
           "A camera, as `handcast devices` lists it, or twin: the digital twin. One that is not "
           "attached yet: aravis:SERIAL or v4l2:NAME");
  line.add("--output NAME", flags.output,
           "A display, as `handcast devices` lists it, or file: pictures in a folder, or twin. One "
           "that is not attached yet: window:NAME or kms:NAME");
  line.add("--tracker NAME", flags.tracker,
           "none, or one that `handcast devices` lists: leapc, openxr; or twin (with the camera "
           "twin). For two cameras in place of a tracker copy config/rigs/stereo.toml or "
           "leap_stereo.toml");
  line.add("--distance N", flags.distance, "Without a tracker: metres from the camera to the hand");
  line.add("--calibration FILE", flags.calibration,
           "The calibration file of camera and projector, or none");
  line.add("--name NAME", flags.name, "Of the rig; otherwise that of the file");
  line.add("-y, --yes", options.yes, "Asks nothing and takes the best guess");
  line.add("--force", options.force, "Replaces a file that exists");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  options.text = std::move(*text);
  return options;
}

}  // namespace handcast::init
