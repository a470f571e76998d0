// SPDX-License-Identifier: Apache-2.0
// handcast record: writes the rings of a running rig to a folder.
#include <fmt/format.h>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "services/tools/record/npy_folder.hpp"
#include "services/tools/record/recorder.hpp"

static int complain(int exit_code, const std::string& sentence) {
  fmt::print(stderr, "handcast record: {}\n", handcast::printable(sentence));
  return exit_code;
}

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  const auto parsed = record::parse(argc, argv);
  const auto text = parsed.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast record", text)) return *code;
  const auto& options = parsed->options;
  const auto done =
      options.convert ? record::write_npy_folder(options.folder) : record::record(options);
  return done ? kExitDone : complain(exit_code_of(done.error()), done.error().what);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast record", argc, argv, run_verb);
}
