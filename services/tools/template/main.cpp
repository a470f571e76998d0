// SPDX-License-Identifier: Apache-2.0
// handcast template: the layout of the pictures that are cast, to paint on.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "config/settings/quoted.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "services/tools/template/template.hpp"

namespace handcast::picture {
namespace {

const char* const kFooter =
    R"(left.png and right.png are coloured and numbered; left_lines.png and right_lines.png are line drawings in the size that you want to
paint in. A picture may have any size up to 8192 px a side, PNG or JPEG, in the proportions 8:5 of the template.)";

int complain(const Error& error) {
  fmt::print(stderr, "handcast template: {}\n", printable(error.what));
  return exit_code_of(error);
}

int write(const std::string& folder, const std::string& rig_file,
          const std::vector<std::string>& settings, int width_px) {
  const auto rig = rig_file.empty() ? config::parse_rig("", "defaults", settings)
                                    : config::load_rig(rig_file, settings);
  if (!rig) return complain(rig.error());
  const auto written = write_templates(rig->hand, folder, width_px);
  if (!written) return complain(written.error());
  for (const auto& file : *written) fmt::print("{}\n", file.string());
  const auto named = [](const std::filesystem::path& file) {
    return config::quoted(std::filesystem::absolute(file).string());
  };
  fmt::print(
      "Paint on those with lines, and name what you painted in the rig file:\n\n[content]\nleft = "
      "{}\nright = {}\n",
      named((*written)[0]), named((*written)[2]));
  return kExitDone;
}

}  // namespace
}  // namespace handcast::picture

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  std::string folder, rig;
  std::vector<std::string> settings;
  int width_px = 4096;
  CommandLine line("handcast template",
                   "Writes pictures that show where each part of a picture lies on the hands.",
                   picture::kFooter);
  line.add("DIR", folder, "The folder of the pictures; it is created");
  line.add("--rig RIG.toml", rig, "A rig file with hands of its own ([hand])");
  line.add("--set path=value", settings, "Changes a setting of the rig");
  line.add("--width N", width_px, "Width of the line drawings, px; a multiple of 8", {256, 8192});
  if (const auto code = line.answered(argc, argv)) return *code;
  if (width_px % picture::kProportionWidth != 0)
    return picture::complain({Errc::bad_config, "--width must be a multiple of 8"});
  return picture::write(folder, rig, settings, width_px);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast template", argc, argv, run_verb);
}
