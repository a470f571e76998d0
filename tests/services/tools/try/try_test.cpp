// SPDX-License-Identifier: Apache-2.0
// The program handcast-try.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/media/picture.hpp"
#include "tests/scratch.hpp"

namespace handcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

struct Ran {
  int exit_code;
  std::string output;
};

class TryTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const auto file = scratch_.path() / name;
    std::ofstream(file) << text;
    return file.string();
  }
  /// A shader with a head and the body of main().
  std::string shader(const std::string& name, const std::string& head, const std::string& body) {
    return write(name, "/*{" + head + "}*/\nvoid main() {\n" + body + "\n}\n");
  }
  Ran run(const std::vector<std::string>& arguments) const {
    const char* const folder = std::getenv("HANDCAST_BIN");
    std::string command = std::string(folder ? folder : "build/bin") + "/handcast-try";
    for (const auto& argument : arguments) command += " '" + argument + "'";
    FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
    std::string output;
    std::array<char, 4096> part;
    while (const auto count = fread(part.data(), 1, part.size(), pipe))
      output.append(part.data(), count);
    const int status = pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
  }
  /// Runs it and reads what it writes. `more`: further arguments.
  Json reports(std::vector<std::string> arguments, int exit_code) {
    const auto file = (scratch_.path() / "all.json").string();
    arguments.insert(arguments.end(), {"--json", file});
    const auto ran = run(arguments);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.output;
    output_ = ran.output;
    std::ifstream stream(file);
    return Json::parse(stream, nullptr, false);
  }
  /// True where shaders cannot be drawn.
  bool is_blind() {
    const auto ran = run({shader("probe.fs", "", "gl_FragColor = vec4(1);"), "--frames", "1"});
    return ran.output.find("need OpenGL") != std::string::npos;
  }

  test::Scratch scratch_;
  std::string output_;
};

TEST_F(TryTest, AStreamThatBringsNoPictureIsNotDrawn) {
  const auto all = reports({"capture:/dev/null", "film:tcp://127.0.0.1:1"}, 1);
  EXPECT_THAT(output_, HasSubstr("not drawn: '/dev/null' is not a video device"));
  EXPECT_THAT(output_, HasSubstr("not drawn: 'tcp://127.0.0.1:1' cannot be opened: Connection"));
  EXPECT_EQ(all["summary"]["drawn"], 0);
}

TEST_F(TryTest, PicturesAndPatternsNeedNoOpenGL) {
  ASSERT_TRUE(renderer::write_png(scratch_.path() / "red.png",
                                  renderer::Texture(8, 5, 0xff0000ffu).view()));
  const auto all = reports({(scratch_.path() / "red.png").string(), "builtin:checker", "--frames",
                            "3", "--size", "64x40", "--out", (scratch_.path() / "out").string()},
                           0);
  ASSERT_EQ(all["sources"].size(), 2u);
  EXPECT_EQ(all["sources"][0]["motion"], "still");
  EXPECT_EQ(all["sources"][0]["plain"], true);
  EXPECT_EQ(all["sources"][1]["plain"], false);
  EXPECT_EQ(all["summary"]["drawn"], 2);
  const auto picture = renderer::read_picture(scratch_.path() / "out" / "red.png-first.png");
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->width(), 64);
  EXPECT_EQ(picture->at(9, 9), 0xff0000ffu);
  EXPECT_THAT(output_, HasSubstr("2 of 2 loaded, 2 drawn"));
}

TEST_F(TryTest, WhatIsNotThereIsNamedAndTheNextOneGoesOn) {
  const auto all = reports({"nowhere.png", "builtin:nothing", "builtin:white", "--frames", "2"}, 1);
  EXPECT_EQ(all["sources"][0]["loaded"], false);
  EXPECT_THAT(all["sources"][0]["error"].get<std::string>(), HasSubstr("nowhere.png"));
  EXPECT_EQ(all["sources"][2]["drawn"], true);
  EXPECT_THAT(output_, HasSubstr("1 of 3 loaded"));
}

TEST_F(TryTest, APictureThatCannotBeWrittenIsAFault) {
  const auto folder = scratch_.path() / "out";
  fs::create_directories(folder / "builtin_white-first.png");
  const auto ran = run({"builtin:white", "--frames", "1", "--out", folder.string()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.output, HasSubstr("builtin_white-first.png"));
}

TEST_F(TryTest, ArgumentsThatMakeNoSenseAreRefused) {
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({"builtin:white", "--size", "8"}).exit_code, 2);
  EXPECT_EQ(run({"builtin:white", "--frames", "0"}).exit_code, 2);
}

TEST_F(TryTest, SourcesFiltersAndTransitionsAreDrawn) {
  if (is_blind()) GTEST_SKIP() << "no OpenGL here";
  const std::string image = R"({"NAME": "inputImage", "TYPE": "image"})";
  const auto time =
      shader("time.fs", "", "gl_FragColor = vec4(fract(TIME), isf_FragNormCoord, 1);");
  const auto set = shader("set.fs", R"("INPUTS": [{"NAME": "level", "TYPE": "float"}])",
                          "gl_FragColor = vec4(isf_FragNormCoord * level, 0, 1);");
  const auto filter = shader("filter.fs", R"("INPUTS": [)" + image + "]",
                             "gl_FragColor = IMG_THIS_PIXEL(inputImage);");
  const auto change =
      shader("change.fs",
             R"("INPUTS": [{"NAME": "startImage", "TYPE": "image"},
                                {"NAME": "endImage", "TYPE": "image"}, {"NAME": "progress", "TYPE": "float"}])",
             "gl_FragColor = mix(IMG_THIS_PIXEL(startImage), IMG_THIS_PIXEL(endImage), progress);");
  const auto all = reports({time, set, filter, change, set + " level=1 | " + filter, "--frames",
                            "4", "--size", "64x40", "--list"},
                           0);
  std::map<std::string, std::string> motions;
  for (const auto& source : all["sources"]) motions[source["source"]] = source["motion"];
  EXPECT_EQ(motions[time], "moves");
  EXPECT_EQ(motions[set], "reacts");
  EXPECT_EQ(motions[filter], "moves") << "the test card does";
  EXPECT_EQ(motions[change], "moves");
  EXPECT_EQ(all["sources"][1]["reacts_to"], Json({"level"}));
  EXPECT_EQ(all["sources"][1]["parameters"][0]["most"], Json({1.0}));
  EXPECT_EQ(all["sources"][4]["plain"], false) << "what is below the filter is drawn";
  EXPECT_EQ(all["sources"][4]["parameters"][0]["name"], "1.level");
  EXPECT_THAT(output_, HasSubstr("level            number  0 to 1; at first 0"));
}

TEST_F(TryTest, AShaderThatDoesNotCompileIsShownWithItsLine) {
  if (is_blind()) GTEST_SKIP() << "no OpenGL here";
  reports({shader("bad.fs", "", "gl_FragColor = oops;")}, 1);
  EXPECT_THAT(output_, HasSubstr("bad.fs: not loaded: bad.fs:3: "));
}

TEST_F(TryTest, AShaderThatHangsIsEndedAndTheNextOneGoesOn) {
  if (is_blind()) GTEST_SKIP() << "no OpenGL here";
  // Drivers end a loop after some ten thousand rounds: for each of many pixels, that is long
  // enough.
  const auto endless = shader("endless.fs", "",
                              "float x = isf_FragNormCoord.x;\nwhile (true) { x += fract(sin(x) * "
                              "43758.5) + 0.1; if (x < 0.0) break; }\ngl_FragColor = vec4(x);");
  const auto all = reports(
      {endless, "builtin:white", "--frames", "2", "--timeout", "5", "--size", "1024x1024"}, 1);
  EXPECT_EQ(all["sources"][0]["end"], "hang");
  EXPECT_EQ(all["sources"][1]["drawn"], true);
  EXPECT_THAT(output_, HasSubstr("it hangs: no step has ended within 5 s"));
}

TEST_F(TryTest, AllFilesOfTheCollectionAreDrawn) {
  const char* const data = std::getenv("HANDCAST_DATA");
  const fs::path folder = fs::path(data ? data : "../shared/data") / "isf";
  if (!fs::exists(folder)) GTEST_SKIP() << "HANDCAST_DATA has no folder 'isf'";
  if (is_blind()) GTEST_SKIP() << "no OpenGL here";
  std::vector<std::string> arguments{"--frames", "3", "--size", "160x100"};
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().extension() == ".fs") arguments.push_back(file.path().string());
  const auto all = reports(arguments, 0);
  EXPECT_EQ(all["summary"]["drawn"], all["summary"]["tried"]) << output_;
  EXPECT_EQ(all["summary"]["hangs"], 0);
  EXPECT_EQ(all["summary"]["crashes"], 0);
  EXPECT_LE(all["summary"]["plain"], 2) << output_;
}

}  // namespace
}  // namespace handcast
