// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pieces.hpp"

#include <gmock/gmock.h>

#include "services/tools/calibrate/harvest.hpp"
#include "services/tools/calibrate/lens_step.hpp"
#include "services/tools/calibrate/pictures.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CalibrationReport, TheVerdictComesFirstAndSaysWhatIsMissing) {
  const std::vector<Reported> steps{{Step::lens, "2026-01-01: 15 images", true},
                                    {Step::screen, "", false},
                                    {Step::light, "", true}};
  const auto page = report_html("show", {"my <rig>.toml"}, steps, "<section>S</section>");
  EXPECT_THAT(page, HasSubstr("Not measured yet: <code>screen</code>. Go on with <code>handcast "
                              "calibrate my &lt;rig&gt;.toml</code>"));
  EXPECT_THAT(page, HasSubstr("<dt>Projector (screen)</dt><dd>not measured yet</dd>"));
  EXPECT_THAT(page, HasSubstr("<dt>Light on the hand (light)</dt><dd>measured, see below</dd>"));
  EXPECT_LT(page.find("Not measured yet"), page.find("<dt>Lens of the camera"));
  EXPECT_LT(page.find("<dt>Lens of the camera"), page.find("<section>S"));
  const auto whole = report_html("show", {"rig.toml"}, std::span(steps).first(1), "");
  EXPECT_THAT(whole, HasSubstr("All steps are measured"));
  EXPECT_THAT(whole, HasSubstr("handcast calibrate rig.toml --check"));
}

TEST(CalibrationReport, ItsCommandsNameTheBoardAndTheFolderOfTheSession) {
  const std::vector<Reported> steps{{Step::lens, "", false}};
  const NamedFiles command{"rig.toml", "charuco:11x8:25", "a <folder>"};
  EXPECT_THAT(report_html("show", command, steps, ""),
              HasSubstr("<code>handcast calibrate rig.toml --board charuco:11x8:25 --folder a "
                        "&lt;folder&gt;</code>"));
  const auto whole = report_html("show", command, {}, "");
  EXPECT_THAT(whole, HasSubstr("<code>handcast calibrate rig.toml --check --board "
                               "charuco:11x8:25</code>"));
  EXPECT_THAT(whole, HasSubstr("<code>handcast doctor rig.toml</code>"));
}

TEST(CalibrationReport, NamesOfSettingsStayAsTheyAreAndAnEndIsNoTwoEnds) {
  const auto html = piece_html(
      Step::screen,
      {"5 places", true, {"projector.gamma was 2.2", "was the board still?", "look. At it"}});
  EXPECT_THAT(html, HasSubstr("<li>projector.gamma was 2.2.</li>"));
  EXPECT_THAT(html, HasSubstr("<li>Was the board still?</li>"));
  EXPECT_THAT(html, HasSubstr("<li>Look. At it.</li>"));
}

TEST(CalibrationReport, APieceHasWholeSentencesAndSaysWhatIsGood) {
  Outcome outcome{"15 images, 0.1 px +- 0.2 %", true, {"image 3 was left out"}};
  outcome.meaning = "held out: good is at most 0.6 px";
  const auto html = piece_html(Step::lens2, outcome);
  EXPECT_THAT(html, HasSubstr("Lens of the second camera <span class='quiet'>lens2</span>"));
  EXPECT_THAT(html, HasSubstr("0.1 px ± 0.2 %."));
  EXPECT_THAT(html, HasSubstr("<li>Image 3 was left out.</li>"));
  EXPECT_THAT(html, HasSubstr("<p class='quiet'>Held out: good is at most 0.6 px.</p>"));
}

TEST(CalibrationReport, BarsAreNumberedAndMarkedIfTheyTookNoPart) {
  const auto svg = bars_svg(std::vector<Bar>{{0.1}, {0.85, true}}, "px", "Errors & more");
  EXPECT_THAT(svg, HasSubstr("<rect class='out'"));
  EXPECT_THAT(svg, HasSubstr(">0.85 px</text>"));
  EXPECT_THAT(svg, HasSubstr(">2</text>"));
  EXPECT_THAT(svg, HasSubstr("Errors &amp; more"));
  EXPECT_THAT(bars_svg({}, "px", "none"), Not(HasSubstr("nan")));
}

TEST(CalibrationReport, DotsAreThinnedOutAndTheSizeIsSaid) {
  const std::vector<glm::dvec2> dots(50000, glm::dvec2(1, 2));
  const auto svg = dots_svg(720, 540, dots, "Hands.");
  EXPECT_LT(svg.size(), 200000u);
  EXPECT_THAT(svg, HasSubstr("720 x 540 px"));
}

TEST(CalibrationAdvice, NearTheEndItSaysWhatIsMissing) {
  EXPECT_THAT(lens_advice(0, 15, "x"), HasSubstr("Hold the board still"));
  EXPECT_EQ(lens_advice(9, 15, "Hold it there."), "Hold it there.");
  EXPECT_EQ(lens_advice(15, 15, "Hold it there."), "Almost done: Hold it there.");
  EXPECT_THAT(lens_advice(9, 15, ""), HasSubstr("6 more images"));
  EXPECT_THAT(lens_advice(14, 15, ""), HasSubstr("one more image"));
}

TEST(CalibrationAdvice, AHandThatWasNearlyEverywhereIsToldWhenItEnds) {
  Harvest harvest;
  harvest.goes_on(0.3, true);
  EXPECT_EQ(harvest.advice("Move it."), "Move it.");
  harvest.goes_on(0.6, true);
  EXPECT_EQ(harvest.advice("Move it."), "Enough was seen; it ends in 20 s. Better still: Move it.");
}

}  // namespace
}  // namespace handcast::calibrate
