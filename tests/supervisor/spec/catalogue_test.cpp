// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/catalogue.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "config/settings/files.hpp"
#include "config/settings/settings.hpp"
#include "supervisor/spec/service_spec.hpp"
#include "tests/scratch.hpp"
#include "tests/supervisor/spec/built_catalogue.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::UnorderedElementsAreArray;

/// Whether a rig file has this setting or section.
bool is_in_a_rig(const std::string& path) {
  config::Rig rig;
  const auto listing = config::list_settings(rig);
  if (config::find_setting(listing, path)) return true;
  return std::ranges::any_of(listing, [&](const auto& section) {
    return section.path == path || section.path.starts_with(path + ".");
  });
}

Catalogue one_camera() {
  return {{"camera",
           {.name = "camera",
            .summary = "Sees.",
            .backends = {{.name = "twin", .sentence = "Draws."},
                         {.name = "aravis", .sentence = "Opens.", .exclusive = true}}}}};
}

class Files : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(scratch_.path() / name) << text;
  }
  Catalogue read() {
    testing::internal::CaptureStderr();
    auto catalogue = read_catalogue(scratch_.path());
    log_ = testing::internal::GetCapturedStderr();
    return catalogue;
  }
  test::Scratch scratch_;
  std::string log_;
};

TEST_F(Files, AreReadAsTheyWereWritten) {
  write("camera.json", daemon::print_description(one_camera().at("camera")));
  write("notes.txt", "not a description");
  const auto catalogue = read();
  ASSERT_TRUE(catalogue.contains("camera"));
  EXPECT_TRUE(catalogue.at("camera").backends.at(1).exclusive);
  EXPECT_THAT(log_, IsEmpty());
}

TEST_F(Files, ThatAreBrokenAreNamedAndLeftOut) {
  write("camera.json", R"({"name": "camera")");
  write("pose.json", daemon::print_description(one_camera().at("camera")));
  EXPECT_THAT(read(), IsEmpty());
  EXPECT_THAT(log_, HasSubstr("camera.json"));
  EXPECT_THAT(log_, HasSubstr("pose.json: describes the service 'camera'"));
  EXPECT_THAT(log_, HasSubstr("restarts all of them"));
}

TEST(CheckBackend, ListsThoseThatThereAre) {
  EXPECT_TRUE(check_backend(one_camera(), "camera", "aravis"));
  EXPECT_THAT(check_backend(one_camera(), "camera", "webcam").error().what,
              HasSubstr("camera has no back end 'webcam'; it has: twin, aravis"));
}

TEST(CheckBackend, LetsAFileOfThisNamePassForBothCameras) {
  const test::Scratch scratch;
  auto catalogue = one_camera();
  catalogue["camera2"] = catalogue["camera"];
  const auto folder = scratch.path() / "handcast/camera";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "noise.so") << "";
  ::setenv("LD_LIBRARY_PATH", ("relative:" + scratch.path().string()).c_str(), 1);
  for (const auto* service : {"camera", "camera2"}) {
    EXPECT_TRUE(check_backend(catalogue, service, "noise")) << service;
    EXPECT_FALSE(check_backend(catalogue, service, "../camera/noise")) << service;
  }
  EXPECT_TRUE(is_exclusive(catalogue, "camera", "noise"));
  ::unsetenv("LD_LIBRARY_PATH");
  EXPECT_FALSE(check_backend(catalogue, "camera2", "noise"));
}

TEST(CheckBackend, LetsAServiceWithoutADescriptionPass) {
  EXPECT_TRUE(check_backend(one_camera(), "pose", "leap"));
}

TEST(BuiltCatalogue, NamesOnlySettingsThatARigHas) {
  for (const auto& [name, service] : test::built_catalogue()) {
    for (const auto& path : service.settings) EXPECT_TRUE(is_in_a_rig(path)) << name << " " << path;
    for (const auto& backend : service.backends)
      for (const auto& path : backend.settings)
        EXPECT_TRUE(is_in_a_rig(path)) << name << " " << backend.name << " " << path;
  }
}

TEST(BuiltCatalogue, PublishesTheRingsThatTheSupervisorMakes) {
  const auto catalogue = test::built_catalogue();
  config::Rig rig;
  rig.observer.enabled = true;
  rig.camera2.backend = "twin";
  for (const auto& spec : services_of(rig, catalogue)) {
    ASSERT_TRUE(catalogue.contains(spec.name)) << spec.name;
    const auto& published = catalogue.at(spec.name).publishes;
    EXPECT_EQ(published.empty() ? "" : published.front(), spec.stream) << spec.name;
    // One camera may have the images of both eyes; content is of two hands, and says what it shows.
    const std::size_t most = spec.name == "camera" ? 2 : spec.name == "content" ? 3 : 1;
    EXPECT_LE(published.size(), most) << spec.name;
  }
}

TEST(BuiltCatalogue, ASubscriberStartsAfterThosePublishersThatItNeeds) {
  const std::map<std::string, std::vector<std::string>> expected{
      {"camera", {}},
      {"pose", {}},
      {"landmarks", {"camera"}},
      {"camera2", {}},
      {"landmarks2", {"camera2"}},
      {"projector", {"camera", "pose", "landmarks"}},
      {"projector2", {"camera", "pose", "landmarks"}},
      {"content", {}},
      {"desk", {}},
      {"dlp", {}},
      {"observer", {"projector"}},
      {"exporter", {}},
      {"watch", {}},
      {"bridge", {}}};
  config::Rig rig;
  rig.dlp.backend = "lightcrafter";
  rig.camera2.backend = "twin";
  rig.projector2.backend = "twin";
  rig.observer.enabled = true;
  rig.supervisor.metrics_port = 9100;
  rig.watch.enabled = true;
  rig.bridge.ros = true;
  const auto catalogue = test::built_catalogue();
  std::vector<std::string> earlier;
  for (const auto& spec : services_of(rig, catalogue)) {
    ASSERT_TRUE(expected.contains(spec.name)) << spec.name;
    EXPECT_THAT(spec.needs, UnorderedElementsAreArray(expected.at(spec.name))) << spec.name;
    EXPECT_THAT(earlier, IsSupersetOf(spec.needs)) << spec.name;
    for (const auto& need : spec.needs)
      EXPECT_THAT(catalogue.at(spec.name).subscribes,
                  testing::Contains(catalogue.at(need).publishes.front()))
          << spec.name << " waits for " << need << ", whose ring it does not read";
    earlier.push_back(spec.name);
  }
  EXPECT_EQ(earlier.size(), expected.size());
}

TEST(BuiltCatalogue, ASecondCameraHasServicesOfItsOwn) {
  const auto catalogue = test::built_catalogue();
  const auto has = [&](const config::Rig& rig, std::string_view name) {
    return std::ranges::any_of(services_of(rig, catalogue),
                               [&](const auto& spec) { return spec.name == name; });
  };
  config::Rig rig;
  EXPECT_FALSE(has(rig, "camera2"));
  EXPECT_FALSE(has(rig, "landmarks2"));
  rig.pose.backend = "stereo";
  EXPECT_FALSE(has(rig, "camera2")) << "one camera may deliver the images of both";
  EXPECT_TRUE(has(rig, "landmarks2"));
  std::swap(rig.pose.backend, rig.pose.second);
  EXPECT_TRUE(has(rig, "landmarks2")) << "the second source takes them, too";
  rig.camera2.backend = "twin";
  EXPECT_TRUE(has(rig, "camera2"));
  const auto& camera2 = catalogue.at("camera2");
  EXPECT_THAT(camera2.publishes, testing::ElementsAre("camera2.frames"));
  EXPECT_THAT(camera2.settings, testing::Contains("camera2.rate_hz"));
  EXPECT_THAT(catalogue.at("landmarks2").subscribes,
              testing::ElementsAre("camera2.frames", "pose.hands", "guest.landmarks2"));
}

TEST(BuiltCatalogue, EachOfTwoProjectorsWatchesTheOthersLight) {
  const auto catalogue = test::built_catalogue();
  const auto &first = catalogue.at("projector"), &second = catalogue.at("projector2");
  EXPECT_THAT(second.publishes, testing::ElementsAre("projection2.frames"));
  EXPECT_THAT(second.subscribes, testing::Contains("projection.frames"));
  EXPECT_THAT(first.subscribes, testing::Contains("projection2.frames"));
  EXPECT_THAT(second.settings, testing::Contains("projector2"));
  EXPECT_THAT(second.settings, testing::Not(testing::Contains("projector")));
}

TEST(BuiltCatalogue, AProgramOfSomebodyIsAServiceIfItsBackEndListens) {
  const auto guests = [](const config::Rig& rig) {
    std::vector<std::vector<std::string>> commands;
    for (const auto& spec : services_of(rig, test::built_catalogue()))
      if (spec.instance_of == "guest") commands.push_back(command_of(spec, "/opt/bin"));
    return commands;
  };
  config::Rig rig;
  rig.pose.external.command = {"./mine"};
  EXPECT_THAT(guests(rig), testing::IsEmpty()) << "pose.backend is \"twin\"";
  rig.pose.second = "external";
  EXPECT_THAT(guests(rig),
              ElementsAre(ElementsAre("/opt/bin/handcast-guest", "--as", "pose_guest")));
  rig.pose.external.command.clear();
  EXPECT_THAT(guests(rig), testing::IsEmpty()) << "somebody starts it by hand";
}

TEST(BuiltCatalogue, AnInstanceIsStartedAsTheProgramOfTheFirst) {
  config::Rig rig;
  rig.camera2.backend = "twin";
  std::map<std::string, std::vector<std::string>> commands;
  for (const auto& spec : services_of(rig, test::built_catalogue()))
    commands[spec.name] = command_of(spec, "/opt/bin");
  EXPECT_THAT(commands["camera"], ElementsAre("/opt/bin/handcast-camera"));
  EXPECT_THAT(commands["camera2"], ElementsAre("/opt/bin/handcast-camera", "--as", "camera2"));
  EXPECT_THAT(commands["landmarks2"],
              ElementsAre("/opt/bin/handcast-landmarks", "--as", "landmarks2"));
}

TEST(BuiltCatalogue, ARigWithoutAProjectorToCommandHasNoServiceForIt) {
  const auto catalogue = test::built_catalogue();
  config::Rig rig;
  EXPECT_TRUE(std::ranges::none_of(services_of(rig, catalogue),
                                   [](const auto& spec) { return spec.name == "dlp"; }));
}

TEST(BuiltCatalogue, BecomesATablePerService) {
  const auto page = print_backends(one_camera());
  EXPECT_THAT(page, HasSubstr("## camera\n\nSees.\n"));
  EXPECT_THAT(page, HasSubstr("| `aravis` | Opens. |  | one process at a time |"));
}

TEST(BuiltCatalogue, IsInTheReferenceInTheTree) {
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto page =
      config::read_text(std::filesystem::path(source ? source : ".") / "config/REFERENCE.md");
  ASSERT_TRUE(page) << page.error().what;
  EXPECT_TRUE(*page == config::print_reference() + print_backends(test::built_catalogue()))
      << "config/REFERENCE.md is out of date. Update it:\n"
         "  build/bin/handcast config --reference > config/REFERENCE.md";
}

}  // namespace
}  // namespace handcast::supervisor
