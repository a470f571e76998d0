// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ipc/base/command_line.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "services/studies/base/study_command.hpp"
#include "services/studies/jnd/analysis.hpp"
#include "services/studies/jnd/heat_map.hpp"
#include "services/studies/jnd/subjects.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeatFile = "looked.png";  ///< beside the page
constexpr double kMotion_s = 12;                 ///< of which the speeds are taken

std::string file_of(const JndOptions& options, std::string_view end) {
  auto file = fs::path(options.folder) / log_name(kSubjectLogs, options.course.subject);
  return file.replace_extension(end).string();
}

Result<std::string> analyse_files(const JndOptions& options) {
  const auto findings = analyse(options.analysed);
  if (!findings) return tl::make_unexpected(findings.error());
  if (auto written = write_json(options.json_file, to_json(*findings)); !written)
    return tl::make_unexpected(written.error());
  std::string text = describe(findings->comparison, "ms");
  for (const auto& sentence : findings->unfinished) text += sentence + "\n";
  if (options.page_folder.empty()) return text;
  const auto heat = heat_map(options.analysed);
  const auto page = write_page(options.page_folder, page_of(*findings, heat ? kHeatFile : ""));
  if (!page) return tl::make_unexpected(page.error());
  if (heat)
    if (auto written = renderer::write_png(page->parent_path() / kHeatFile, heat->view()); !written)
      return tl::make_unexpected(written.error());
  return text + page->string() + "\n";
}

Result<std::string> simulate(const JndOptions& options) {
  const auto stimulus = Stimulus::open(options.stimulus);
  if (!stimulus) return tl::make_unexpected(stimulus.error());
  const auto jnds_ms = predicted_jnds_ms(stimulus->speeds_deg_s(0, kMotion_s));
  const auto json = simulate_subjects(jnds_ms, options.subjects, options.course.seed);
  if (auto written = write_json(options.json_file, json); !written)
    return tl::make_unexpected(written.error());
  std::string text = fmt::format(
      "predicted JND for {}: {:.2f} ms at edges, {:.2f} ms with the fill; {} subjects, seed {}\n\n"
      "{:<12} {:<9} {:>7} {:>22} {:>9} {:>22}\n",
      options.stimulus.motion, jnds_ms[0], jnds_ms[1], options.subjects, options.course.seed,
      "procedure", "condition", "trials", "bias, ms (95 %)", "sd, ms", "trials for ±0.5 ms");
  for (const auto& name : kProcedureNames)
    for (const auto& condition : kConditionNames) {
      const auto& row =
          json["procedures"][std::string(name)]["estimates"][std::string(condition)]["procedure"];
      const auto& needed = row["trials_for_half_ms"];
      text += fmt::format("{:<12} {:<9} {:>7.0f} {:>22} {:>9.2f} {:>21}\n", name, condition,
                          row["trials"].get<double>(),
                          fmt::format("{:+.2f} ({:+.2f}…{:+.2f})", row["bias_ms"].get<double>(),
                                      row["bias_interval_ms"][0].get<double>(),
                                      row["bias_interval_ms"][1].get<double>()),
                          row["sd_ms"].get<double>(),
                          needed.is_null() ? "never" : fmt::format("{:.0f}", needed.get<double>()));
    }
  return text;
}

/// Three pictures side by side: perfect light, and light that is 20 ms late, without and with the
/// fill.
Result<std::string> write_picture(const JndOptions& options) {
  auto stimulus = Stimulus::open(options.stimulus);
  if (!stimulus) return tl::make_unexpected(stimulus.error());
  constexpr double kDelay_ms = 20;
  // The moment at which the hand is fastest shows most.
  double fastest_s = 0, most = 0;
  constexpr int kMoments = 110;
  for (int moment = 0; moment < kMoments; ++moment) {
    const double at_s = 0.5 + 0.1 * moment;
    const auto speeds = stimulus->speeds_deg_s(at_s, at_s + 0.07);
    const double mean = speeds.empty() ? 0 : summary_of(speeds).mean;
    if (mean <= most) continue;
    most = mean;
    fastest_s = at_s + 0.033;
  }
  const int width = options.stimulus.width_px, height = options.stimulus.height_px;
  renderer::Texture row(3 * width, height);
  int column = 0;
  for (const auto& [delay_ms, condition] : {std::pair{0.0, Condition::baseline},
                                            {kDelay_ms, Condition::baseline},
                                            {kDelay_ms, Condition::fill}}) {
    const auto picture = stimulus->draw(fastest_s, delay_ms, condition);
    for (int y = 0; y < height; ++y)
      std::copy_n(picture.row(y), width, row.row(y) + column * width);
    ++column;
  }
  if (auto written = renderer::write_png(options.picture_file, row.view()); !written)
    return tl::make_unexpected(written.error());
  return options.picture_file + "\n";
}

Result<std::string> run(const JndOptions& options) {
  if (!options.json_file.empty())
    if (auto writable = check_result_file(options.json_file); !writable)
      return tl::make_unexpected(writable.error());
  if (!options.analysed.empty()) return analyse_files(options);
  if (options.simulates) return simulate(options);
  if (!options.picture_file.empty()) return write_picture(options);
  return take_course(options).map([](const auto& sentence) { return sentence + "\n"; });
}

}  // namespace

std::string log_file(const JndOptions& options) { return file_of(options, ".csv"); }
std::string light_file(const JndOptions& options) { return file_of(options, ".light.csv"); }
std::string marks_file(const JndOptions& options, Condition condition) {
  return file_of(
      options, fmt::format(".{}.marks.png", kConditionNames[static_cast<std::size_t>(condition)]));
}

int run_jnd(int argc, char** argv) {
  const auto parsed = parse_jnd(argc, argv);
  const auto text = parsed.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast study jnd", text)) return *code;
  return end_of("handcast study jnd", run(parsed->options));
}

}  // namespace handcast::study
