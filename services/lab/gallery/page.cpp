// SPDX-License-Identifier: Apache-2.0
#include "services/lab/gallery/page.hpp"

#include <fmt/format.h>

#include <string_view>

#include "ipc/base/join.hpp"
#include "ipc/base/text.hpp"

namespace handcast::gallery {
namespace {

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>handcast: looks</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: dark; }
body { background: #07080a; color: #dfe3e8; font: 15px/1.5 system-ui, sans-serif; margin: 2.5rem auto; max-width: 1380px; padding: 0 1.2rem; }
h1 { font-weight: 500; margin: 0; }
header p, small { color: #8d97a3; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1.2rem; }
figure { margin: 0; background: #101318; border-radius: 10px; overflow: hidden; }
figcaption { padding: .8rem 1rem 1rem; }
h2 { font-size: 1.05rem; font-weight: 600; margin: 0; overflow-wrap: anywhere; }
h2 small { float: right; font-weight: 400; }
figcaption p { margin: .3rem 0 .6rem; }
details { font-size: .87rem; color: #aab3bd; }
summary { cursor: pointer; }
table { border-collapse: collapse; margin-top: .4rem; width: 100%; }
td { padding: .1rem .6rem .1rem 0; vertical-align: top; }
code { color: #8fd0ff; }
.stage { background: #080709; }
.strip { margin: 0 auto; background-repeat: no-repeat; }
.swatch { display: inline-block; width: .8em; height: .8em; border-radius: 2px; vertical-align: -1px; }
@media (prefers-reduced-motion: reduce) { .strip { animation: none !important; } }
</style>
<header><h1>Looks</h1>
<p>As an audience sees them on the digital twin's hands. <code>handcast content NAME</code> puts one on the hands of a
running rig; <code>handcast content "NAME setting=value"</code> changes it.</p></header>
<main>
)";

/// Its range or its choices, and its first value.
std::string range_of(const content::Parameter& parameter) {
  using Kind = content::Parameter::Kind;
  const auto& first = parameter.initial;
  if (parameter.kind == Kind::choice) return html_of(join(parameter.choices, ", "));
  if (parameter.kind == Kind::flag) return first.empty() || first[0] == 0 ? "off" : "on";
  if (parameter.kind == Kind::colour && first.size() == 4) {
    const auto colour =
        fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(255 * first[0] + 0.5),
                    static_cast<int>(255 * first[1] + 0.5), static_cast<int>(255 * first[2] + 0.5));
    return fmt::format("<span class=\"swatch\" style=\"background: {0}\"></span> {0}", colour);
  }
  if (first.size() != 1) return "";
  if (parameter.least.empty() || parameter.most.empty()) return fmt::format("{:g}", first[0]);
  return fmt::format("{:g}…{:g}, at first {:g}", parameter.least[0], parameter.most[0], first[0]);
}

std::string settings_of(const Entry& entry) {
  if (entry.parameters.empty()) return "";
  std::string rows;
  for (const auto& parameter : entry.parameters)
    rows += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>",
                        html_of(parameter.name), html_of(parameter.label), range_of(parameter));
  return fmt::format("<details><summary>Settings</summary><table>{}</table></details>", rows);
}

std::string figure_of(const Entry& entry, std::size_t number, int frames, double seconds) {
  return fmt::format(
      "<figure><style>@keyframes s{0} {{ to {{ background-position: -{1}px 0; }} }}</style>"
      "<div class=\"stage\"><div class=\"strip\" role=\"img\" aria-label=\"{2}\" style=\"width: "
      "{3}px; height: {4}px; background-image: url('{5}'); animation: s{0} {6:.2f}s steps({7}) "
      "infinite alternate\"></div></div><figcaption><h2>{2} <small>{8:.1f} ms</small></h2>"
      "<p>{9}</p>{10}</figcaption></figure>\n",
      number, entry.width_px * (frames - 1), html_of(entry.title), entry.width_px, entry.height_px,
      entry.file, seconds, frames - 1, entry.took_ms, html_of(entry.sentence), settings_of(entry));
}

}  // namespace

std::string page_of(const std::vector<Entry>& entries, int frames, double seconds) {
  std::string page(kHead);
  for (std::size_t i = 0; i < entries.size(); ++i)
    page += figure_of(entries[i], i, std::max(frames, 2), seconds);
  return page + "</main></html>\n";
}

}  // namespace handcast::gallery
