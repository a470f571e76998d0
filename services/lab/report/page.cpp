// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/page.hpp"

#include <fmt/format.h>

#include "services/lab/report/tables.hpp"
#include "services/lab/report/time_sheet.hpp"
#include "services/tools/page/document.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {

const char* const kBody = R"html(<section id="headline">
{{headline}}</section>
<section id="film">
<h2>The true hand and the light on it</h2>
<p>The same hand at the same times, seen from the projector: the true hand, and the light that falls on it.</p>
{{film}}</section>
<section id="accuracy">
<h2>Where the light lands</h2>
<p>Simulated, and compared with the truth of the digital twin. All three use the same sensors with the same delays and errors; each has the detector of its rig. The best value of a row is bold.</p>
{{accuracy}}</section>
<section id="speed">
<h2>By speed of the hand</h2>
<p>Interior error by the mean speed of the skin: 95th percentile in mm.</p>
{{speed}}</section>
<section id="live">
<h2>The live rig</h2>
{{live}}</section>
<section id="times">
<h2>Where the time goes</h2>
{{times}}</section>
)html";

/// A setting, from the first run that has it.
static std::string stated(const Inputs& inputs, const char* key) {
  for (const auto& run : inputs.runs) {
    if (!run.metrics.content || !run.metrics.content->contains(key)) continue;
    const auto& value = run.metrics.content->at(key);
    return value.is_string() ? value.get<std::string>() : value.dump();
  }
  return "";
}

static std::string rigs(const Inputs& inputs) {
  std::string names;
  for (const auto& run : inputs.runs) {
    if (!run.metrics.content || !run.metrics.content->contains("rig") ||
        !run.metrics.content->at("rig").is_string())
      continue;
    if (!names.empty()) names += ", ";
    names += run.metrics.content->at("rig").get<std::string>();
  }
  return names;
}

std::string make_page(const Inputs& inputs, const Film& film, const Imprint& imprint) {
  const std::string seconds = stated(inputs, "seconds");
  const std::string facts =
      page::fact("rigs", rigs(inputs)) + page::fact("motion", stated(inputs, "motion")) +
      page::fact("scored", seconds.empty() ? "" : seconds + " s") +
      page::fact("seed", stated(inputs, "seed")) + page::fact("machine", imprint.machine) +
      page::fact("made", imprint.date);
  const std::string body = page::fill(kBody, {{"headline", headline(inputs)},
                                              {"film", film_section(film)},
                                              {"accuracy", accuracy_table(inputs)},
                                              {"speed", speed_table(inputs)},
                                              {"live", live_table(inputs)},
                                              {"times", time_sheet(inputs)}});
  return page::to_html({imprint.title, kStyle, facts, "", body});
}

}  // namespace handcast::report
