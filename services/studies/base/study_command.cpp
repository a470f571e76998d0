// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/study_command.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::study {

namespace fs = std::filesystem;

void add_rig_hand(CommandLine& line, std::string& rig, msg::Side& side) {
  line.add("--rig NAME", rig, "Which rig, if several are up");
  line.add(
      "--hand left|right",
      [&side](const std::string& name) {
        side = name == "left" ? msg::Side::left : msg::Side::right;
        return Result<void>();
      },
      "The hand");
}

std::string log_name(std::string_view kind, int person) {
  return fmt::format("{}-{:02}.csv", kind, person);
}

Result<std::vector<fs::path>> logs_in(const std::string& name, std::string_view kind) {
  std::error_code failed;
  if (!fs::is_directory(name, failed)) return std::vector<fs::path>{name};
  std::vector<fs::path> logs;
  for (int person = 1; person <= kMostSubjects; ++person)
    if (auto file = fs::path(name) / log_name(kind, person); fs::exists(file, failed))
      logs.push_back(std::move(file));
  if (!logs.empty()) return logs;
  return fail(Errc::bad_config, fmt::format("{}: there are no logs ({}-NN.csv)", name, kind));
}

Result<std::vector<StudyTable>> read_logs(const std::vector<std::string>& names,
                                          std::string_view kind) {
  std::vector<StudyTable> logs;
  for (const auto& name : names) {
    const auto files = logs_in(name, kind);
    if (!files) return tl::make_unexpected(files.error());
    for (const auto& file : *files) {
      auto log = read_study_table(file);
      if (!log) return tl::make_unexpected(log.error());
      logs.push_back(std::move(*log));
    }
  }
  return logs;
}

// Cells of a table need not be UTF-8.
Result<void> write_json(const std::string& file, const nlohmann::json& json) {
  if (file.empty()) return {};
  return write_whole(file,
                     json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Result<fs::path> write_page(const fs::path& folder, std::string_view html) {
  std::error_code ignored;  // write_whole() says what is wrong
  fs::create_directories(folder, ignored);
  auto file = folder / "index.html";
  if (auto written = write_whole(file, html); !written) return tl::make_unexpected(written.error());
  return file;
}

int end_of(std::string_view command, const Result<std::string>& done) {
  if (done) {
    fmt::print("{}", *done);
    return kExitDone;
  }
  fmt::print(stderr, "{}: {}\n", command, printable(done.error().what));
  return exit_code_of(done.error());
}

}  // namespace handcast::study
