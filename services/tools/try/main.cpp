// SPDX-License-Identifier: Apache-2.0
// handcast content --try: draws sources of content without a rig.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/try/apart.hpp"
#include "services/tools/try/verdict.hpp"

namespace handcast::trial {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastSide_px = 16, kMostSide_px = 4096;

int complain(const Error& error) {
  fmt::print(stderr, "handcast content --try: {}\n", printable(error.what));
  return exit_code_of(error);
}

Result<void> read_size(const std::string& text, Wanted& wanted) {
  int end = 0;
  const auto fits = [](int side) { return side >= kLeastSide_px && side <= kMostSide_px; };
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &wanted.width_px, &wanted.height_px, &end) == 2 &&
      static_cast<std::size_t>(end) == text.size() && fits(wanted.width_px) &&
      fits(wanted.height_px))
    return {};
  return fail(Errc::bad_config,
              fmt::format("{} is no size like 640x400, with {} to {} px on a side", quote(text),
                          kLeastSide_px, kMostSide_px));
}

/// A name for the pictures of a source that no other one has: that of its file, without a folder.
std::string picture_name(const std::string& source, std::set<std::string>& taken) {
  std::string plain = source.substr(source.find_last_of('/') + 1);
  for (char& c : plain)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
  plain = plain.substr(0, 80);
  std::string name = plain;
  for (int number = 2; !taken.insert(name).second; ++number)
    name = fmt::format("{}-{}", plain, number);
  return name;
}

Result<void> write_json(const fs::path& file, const Wanted& wanted,
                        const std::vector<Report>& reports) {
  const Report all{{"width_px", wanted.width_px},
                   {"height_px", wanted.height_px},
                   {"frames", wanted.frames},
                   {"summary", count(reports)},
                   {"sources", reports}};
  return write_whole(file, all.dump(1, ' ', false, Report::error_handler_t::replace) + "\n");
}

int try_all(Wanted wanted, const std::vector<std::string>& sources, const fs::path& json,
            bool lists) {
  std::error_code refused;
  if (!wanted.folder.empty()) fs::create_directories(wanted.folder, refused);
  if (refused)
    return complain({Errc::bad_config, fmt::format("{}: cannot be created: {}",
                                                   wanted.folder.string(), refused.message())});
  if (!json.empty())
    if (const auto good = check_result_file(json); !good) return complain(good.error());
  std::vector<Report> reports;
  std::set<std::string> names;
  for (const auto& source : sources) {
    wanted.source = source;
    wanted.name = picture_name(source, names);
    reports.push_back(draw_apart(wanted));
    fmt::print("{}\n", printable(verdict(reports.back())));
    if (lists) fmt::print("{}", printable(parameter_list(reports.back())));
    std::fflush(stdout);
  }
  fmt::print("{}\n", summary(reports));
  if (!json.empty())
    if (const auto written = write_json(json, wanted, reports); !written)
      return complain(written.error());
  return count(reports).at("drawn") == reports.size() ? kExitDone : kExitBadResult;
}

}  // namespace
}  // namespace handcast::trial

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  trial::Wanted wanted;
  std::vector<std::string> sources;
  std::string json;
  bool lists = false;
  CommandLine line("handcast content --try",
                   "Draws sources of content without a rig, each in a process of its own, and says "
                   "which of them cannot be loaded or drawn, and how long a picture takes.",
                   "A filter or a transition is given test cards that move. Exit code 1: a source "
                   "was not drawn.");
  line.add("SOURCE...", sources, "Files, or content as in a rig file: \"film:a.mp4 | glow.fs\"");
  line.add(
      "--size WxH", [&](const std::string& text) { return trial::read_size(text, wanted); },
      "Size of the pictures, px (default: 640x400)");
  line.add("--frames N", wanted.frames, "Pictures of each source, 1/30 s apart", {1, 100000});
  line.add("--out DIR", wanted.folder, "Write the first, middle and last picture of each as PNG");
  line.add("--projected", wanted.projects,
           "With --out: also write the projector's image of the hand with each of these pictures");
  line.add("--json FILE", json, "Write all that was found out");
  line.add("--list", lists, "Print the parameters of each source");
  line.add("--timeout S", wanted.patience_s,
           "How long a source may take to open or to draw a picture; after that time no further "
           "picture of it is drawn",
           {0.1, 3600});
  if (const auto code = line.answered(argc, argv)) return *code;
  if (wanted.projects && wanted.folder.empty())
    return trial::complain({Errc::bad_config, "--projected needs --out, a folder for the images"});
  return trial::try_all(wanted, sources, json, lists);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast content --try", argc, argv, run_verb);
}
