// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "config/settings/choice.hpp"
#include "services/tools/page/document.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::calibrate {
namespace {

constexpr const char* kStyle =
    "svg{max-width:100%;height:auto;background:var(--panel);border:1px solid var(--line)}"
    "svg.image{border-color:var(--quiet)}"
    "svg text{fill:currentColor}svg circle,svg rect{fill:var(--ours)}"
    "svg rect.out,svg .second{fill:var(--cascade)}svg .third{fill:var(--baseline)}"
    ".pictures{display:flex;flex-wrap:wrap;gap:1.2rem 2rem;align-items:flex-start}"
    "figure{margin:0;flex:0 1 auto;max-width:min(100%,448px)}figure.broad{max-width:100%}"
    "figcaption{font-size:.85rem;color:var(--quiet);margin-top:.3rem}"
    ".verdict{font-size:1.1rem;border-left:4px solid var(--ours);padding-left:.8rem}"
    ".verdict.open{border-color:var(--cascade)}"
    "code{background:var(--panel);border:1px solid var(--line);border-radius:3px;padding:0 .25em;"
    "overflow-wrap:anywhere}"
    "header dl{display:block;margin-top:1rem}header dl div{margin-top:.5rem}h2 "
    ".quiet{font-weight:400}"
    "ul{padding-left:1.2rem}";

const char* title_of(Step step) {
  switch (step) {
    case Step::lens:
      return "Lens of the camera";
    case Step::lens2:
      return "Lens of the second camera";
    case Step::pair:
      return "Place of the second camera";
    case Step::screen:
      return "Projector";
    case Step::tracker:
      return "Place of the tracker";
    case Step::light:
      return "Light on the hand";
  }
  return "";
}

std::string with_plus_minus(std::string text) {
  constexpr std::string_view kTyped = "+-", kPrinted = "±";
  for (auto at = text.find(kTyped); at != std::string::npos; at = text.find(kTyped, at))
    text.replace(at, kTyped.size(), kPrinted);
  return text;
}

/// True if a sentence begins with the name of a setting, such as projector.gamma.
bool begins_with_setting(std::string_view text) {
  const auto word = text.substr(0, text.find_first_of(" :,"));
  const auto dot = word.find('.');
  return dot != std::string_view::npos && dot + 1 < word.size();
}

/// A part of a sentence as a whole one.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (!begins_with_setting(text))
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (std::string_view(".?!").find(text.back()) == std::string_view::npos) text += '.';
  return page::escape(with_plus_minus(std::move(text)));
}

std::string verdict_html(const NamedFiles& command, std::span<const Reported> steps) {
  std::string missing;
  for (const auto& reported : steps)
    if (!reported.is_done)
      missing += fmt::format("{}<code>{}</code>", missing.empty() ? "" : ", ",
                             config::word_of(reported.step));
  const auto option = [](const char* name, const std::string& value) {
    return value.empty() ? value : fmt::format(" {} {}", name, page::escape(value));
  };
  const auto file = page::escape(command.rig_file), board = option("--board", command.board);
  if (!missing.empty())
    return fmt::format(
        "<p class='verdict open'>Not measured yet: {}. Go on with <code>handcast calibrate "
        "{}{}{}</code>.</p>",
        missing, file, board, option("--folder", command.folder));
  return fmt::format(
      "<p class='verdict'>All steps are measured. <code>handcast doctor {0}</code> says whether "
      "the rig is ready; <code>handcast calibrate {0} --check{1}</code> says at any time whether "
      "something has moved.</p>",
      file, board);
}

}  // namespace

std::string piece_html(Step step, const Outcome& outcome) {
  auto html = fmt::format("<section><h2>{} <span class='quiet'>{}</span></h2><p>{}</p>",
                          title_of(step), config::word_of(step), sentence(outcome.made));
  if (!outcome.findings.empty()) {
    html += "<ul>";
    for (const auto& finding : outcome.findings)
      html += fmt::format("<li>{}</li>", sentence(finding));
    html += "</ul>";
  }
  if (!outcome.meaning.empty())
    html += fmt::format("<p class='quiet'>{}</p>", sentence(outcome.meaning));
  if (!outcome.pictures.empty())
    html += fmt::format("<div class='pictures'>{}</div>", outcome.pictures);
  return html + "</section>\n";
}

std::string report_html(const std::string& rig, const NamedFiles& command,
                        std::span<const Reported> steps, const std::string& pieces) {
  std::string facts;
  for (const auto& [step, made, is_done] : steps)
    facts += page::fact(fmt::format("{} ({})", title_of(step), config::word_of(step)),
                        !made.empty() ? with_plus_minus(made)
                        : is_done     ? "measured, see below"
                                      : "not measured yet");
  return page::to_html({.title = "Calibration of " + rig,
                        .style = kStyle,
                        .facts = {},
                        .header = verdict_html(command, steps) + "<dl>" + facts + "</dl>\n",
                        .body = pieces});
}

}  // namespace handcast::calibrate
