// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "services/tools/page/html.hpp"
#include "tests/scratch.hpp"
#include "tests/services/lab/report/demonstration.hpp"

namespace handcast::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Report : public testing::Test {
 protected:
  const std::filesystem::path& folder() const { return scratch_.path(); }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder() / name, std::ios::binary).rdbuf();
    return text.str();
  }
  std::string page() {
    const auto written = write_report(folder(), imprint_);
    EXPECT_TRUE(written) << written.error().what;
    return read("report.html");
  }
  nlohmann::json metrics() const { return nlohmann::json::parse(read("metrics.json")); }

  test::Scratch scratch_;
  Imprint imprint_{"a title", "a machine", "a date"};
};

TEST_F(Report, GathersTheFiguresOfAllRunsInOneFile) {
  test::write_demonstration(folder(), 6);
  page();
  const auto json = metrics();
  EXPECT_EQ(json.at("baseline").at("interior_mm").at("mean"), 7.6);
  EXPECT_EQ(json.at("paper").at("rig"), "paper");
  EXPECT_EQ(json.at("handcast").at("rig"), "twin");
  EXPECT_EQ(json.at("live").at("rates").at("camera").at("held_hz"), 498.21);
  EXPECT_EQ(json.at("live").at("observer").at("interior_mm").at("mean"), 1.3);
}

TEST_F(Report, ShowsTheFiguresFilmTimesAndRates) {
  test::write_demonstration(folder(), 6);
  const std::string html = page();
  EXPECT_THAT(html, AllOf(HasSubstr("16.72"), HasSubstr("4.03"), HasSubstr("2.66")))
      << "p95 in mm of the three";
  EXPECT_THAT(
      html, AllOf(HasSubstr("data:image/jpeg;base64,/9j/"), HasSubstr("498.2"), HasSubstr("95 %")))
      << "stills, rate, share";
  EXPECT_THAT(html, AllOf(HasSubstr("0.6-1.0"), Not(HasSubstr("&gt;1.0"))))
      << "bins with frames, none without";
  EXPECT_THAT(html,
              AllOf(HasSubstr("builtin:open_close"), HasSubstr("a machine"), HasSubstr("a date")));
  EXPECT_THAT(html, Not(HasSubstr("class=\"missing\"")));
}

TEST_F(Report, SaysIfTheComputerWasTooSlowForTheLiveRig) {
  auto live = test::live_of();
  test::write_json(folder() / "live.json", live);
  EXPECT_THAT(page(), Not(HasSubstr("too slow")));
  live["rates"]["projector"]["held_hz"] = 321.0;
  test::write_json(folder() / "live.json", live);
  EXPECT_THAT(page(), HasSubstr("too slow for the requested rates and held 34 % of one of them"));
  live["services"]["projector"]["is_held_to_its_rate"] = false;
  test::write_json(folder() / "live.json", live);
  EXPECT_THAT(page(), Not(HasSubstr("too slow"))) << "sub-frames";
}

TEST_F(Report, SaysWhichDetectorEachRunHadAndWhy) {
  test::write_demonstration(folder(), 1);
  const auto detector = [](bool used, const char* backend, const nlohmann::json& why) {
    return nlohmann::json{{"used", used}, {"backend", backend}, {"age_ms", 16.2}, {"why", why}};
  };
  const auto write = [&](const char* name, const nlohmann::json& of_run) {
    auto metrics = test::metrics_of(name, 1);
    metrics["detector"] = of_run;
    test::write_json(folder() / (std::string(name) + ".json"), metrics);
  };
  write("baseline", detector(false, "twin", nullptr));
  write("paper", detector(true, "twin", "'a.onnx' is missing"));
  write("twin", detector(true, "handcast", nullptr));
  EXPECT_THAT(page(), AllOf(HasSubstr("Landmarks</th><td>not used</td><td>twin, 16.2 ms old</td>"
                                      "<td>handcast, 16.2 ms old</td>"),
                            HasSubstr("paper: &#39;a.onnx&#39; is missing.")));
}

TEST_F(Report, MakesAVideoOfThePicturesItHas) {
  test::write_frames(folder() / "frames" / "twin", 6, 0);
  const std::string html = page();
  EXPECT_THAT(read("preview.mp4").substr(0, 12), HasSubstr("ftyp"));
  EXPECT_THAT(html, AllOf(HasSubstr("no pictures of baseline"), HasSubstr("no pictures of paper"),
                          Not(HasSubstr("no pictures of handcast"))));
}

TEST_F(Report, NeedsNothingFromOutside) {
  test::write_demonstration(folder(), 3);
  const std::string html = page();
  for (const char* reference :
       {"http://", "https://", "src=\"//", "@import", "<script", "<link", "url("})
    EXPECT_THAT(html, Not(HasSubstr(reference)));
}

TEST_F(Report, SaysWhatIsMissingAndShowsTheRest) {
  test::write_json(folder() / "twin.json", test::metrics_of("twin", 1.21));
  std::ofstream(folder() / "paper.json") << "{ \"interior";
  const std::string html = page();
  EXPECT_THAT(html, AllOf(HasSubstr("baseline.json is missing"),
                          HasSubstr("paper.json is not a JSON object"),
                          HasSubstr("live.json is missing"), HasSubstr("2.66")));
  EXPECT_FALSE(metrics().contains("baseline"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "preview.mp4"));
}

TEST_F(Report, FiguresOfTheWrongKindAreNamedAndNotShown) {
  test::write_json(folder() / "live.json", test::live_of());
  const auto fault_of = [&](const char* name, const nlohmann::json& json) {
    test::write_json(folder() / name, json);
    const auto written = write_report(folder(), imprint_);
    std::filesystem::remove(folder() / name);
    if (!written || written->faults.size() != 1) return std::string("(none)");
    EXPECT_THAT(read("report.html"), HasSubstr(page::escape(written->faults.front())));
    return written->faults.front();
  };
  EXPECT_EQ(fault_of("twin.json", {{"coverage", nullptr}, {"interior_mm", {{"p95", 1}}}}),
            "(none)");
  EXPECT_EQ(fault_of("twin.json", {{"interior_mm", "none"}}),
            "twin.json: /interior_mm must be an object");
  EXPECT_EQ(fault_of("twin.json", {{"interior_mm", {{"p95", "1"}}}}),
            "twin.json: /interior_mm/p95 must be a number");
  EXPECT_EQ(fault_of("twin.json", {{"coverage", "1"}}), "twin.json: /coverage must be a number");
  EXPECT_EQ(fault_of("twin.json", {{"bins", {1, 2}}}), "twin.json: /bins must be an object");
  EXPECT_EQ(fault_of("twin.json", {{"motion", 5}}), "twin.json: /motion must be a text");
  EXPECT_EQ(fault_of("paper.json", {{"stage_us", {{"skin", {{"p50", true}}}}}}),
            "paper.json: /stage_us/skin/p50 must be a number");
  EXPECT_EQ(fault_of("observer.json", {{"frame_us", 3}}),
            "observer.json: /frame_us must be an object");
}

TEST_F(Report, JsonThatIsNestedTooDeeplyIsNotRead) {
  test::write_json(folder() / "live.json", test::live_of());
  std::ofstream(folder() / "twin.json")
      << "{\"a\":" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}";
  const auto written = write_report(folder(), imprint_);
  ASSERT_TRUE(written) << written.error().what;
  EXPECT_THAT(written->faults, testing::ElementsAre("twin.json is not a JSON object"));
}

TEST_F(Report, EscapesWhatItDidNotWriteItself) {
  auto metrics = test::metrics_of("<b>rig</b>", 1);
  metrics["motion"] = "\"><script>alert(1)</script>{{style}}";
  test::write_json(folder() / "twin.json", metrics);
  imprint_.title = "R&D <report>";
  const std::string html = page();
  EXPECT_THAT(html, AllOf(HasSubstr("<title>R&amp;D &lt;report&gt;</title>"),
                          HasSubstr("&lt;b&gt;rig"), Not(HasSubstr("<script"))));
  EXPECT_THAT(html, HasSubstr("&lt;/script&gt;{{style}}")) << "values are not filled again";
}

TEST_F(Report, AnEmptyFolderIsAnErrorThatSaysWhatBelongsThere) {
  const auto written = write_report(folder(), imprint_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::bad_config);
  EXPECT_THAT(written.error().what,
              AllOf(HasSubstr(folder().string()), HasSubstr("twin.json"), HasSubstr("live.json")));
  EXPECT_EQ(write_report(folder() / "nowhere", imprint_).error().code, Errc::bad_config);
}

TEST(Base64, IsPaddedToGroupsOfFour) {
  const auto encoded = [](const std::string& text) {
    return page::base64(
        std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
}

TEST(Fill, LeavesOutPlacesWithoutAValue) {
  EXPECT_EQ(page::fill("a{{x}}b{{y}}c{{", {{"x", "1"}}), "a1bc{{");
}

}  // namespace
}  // namespace handcast::report
