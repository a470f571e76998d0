// SPDX-License-Identifier: Apache-2.0
#include "services/tools/devices/trackers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/scratch.hpp"
#include "tests/system/variable.hpp"

namespace handcast::devices {
namespace {

using system_test::Variable;
using testing::HasSubstr;

/// A folder that looks like the root of a computer without an OpenXR runtime.
class Trackers : public testing::Test {
 protected:
  std::string write(const std::string& file, const std::string& text) const {
    const auto path = scratch_.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << '\n';
    return path;
  }
  void plug_in(const std::string& port, const std::string& vendor, const std::string& product,
               const std::string& name) const {
    const auto folder = "sys/bus/usb/devices/" + port + "/";
    write(folder + "idVendor", vendor);
    write(folder + "idProduct", product);
    if (!name.empty()) write(folder + "product", name);
  }
  void install_leapc() const { write("usr/lib/ultraleap-hand-tracking-service/libLeapC.so.5", ""); }
  std::vector<Attached> found() const { return trackers(scratch_.path()); }

  test::Scratch scratch_;
  Variable no_runtime_{"XR_RUNTIME_JSON", "/nowhere/runtime.json"};
};

TEST_F(Trackers, ThereAreNoneOnABareComputer) { EXPECT_TRUE(found().empty()); }

TEST_F(Trackers, UltraleapsDevicesAreKnownByTheirUsbIds) {
  install_leapc();
  plug_in("1-4", "f182", "0003", "");
  plug_in("1-2.1", "2936", "1206", "Leap Motion Controller 2");
  plug_in("2-1", "046d", "c52b", "USB Receiver");
  const auto all = found();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "Leap Motion Controller 2 (2936:1206) at USB 1-2.1");
  EXPECT_EQ(all[1].name, "Leap Motion Controller (f182:0003) at USB 1-4");
  EXPECT_THAT(all[1].about, HasSubstr("camera.backend = \"leap\""));
  for (const auto& one : all) {
    EXPECT_EQ(one.kind, Kind::tracker);
    EXPECT_EQ(one.settings.front(), std::pair(std::string("pose.backend"), std::string("leapc")));
    EXPECT_EQ(one.trouble, "");
  }
}

TEST_F(Trackers, WithoutUltraleapsLibraryWhatToInstallIsSaid) {
  plug_in("1-4", "f182", "0003", "");
  ASSERT_EQ(found().size(), 1u);
  EXPECT_THAT(found()[0].trouble, HasSubstr("install Ultraleap's hand tracking service"));
}

TEST_F(Trackers, WhatIsMissingIsListedWithItsRemedy) {
  const auto backends = [this] {
    std::vector<std::string> names;
    for (const auto& [backend, why] : absent_trackers(scratch_.path())) names.push_back(backend);
    return names;
  };
  EXPECT_THAT(backends(), testing::ElementsAre("leapc", "openxr"));
  const auto absent = absent_trackers(scratch_.path());
  EXPECT_THAT(absent[0].why, HasSubstr("install Ultraleap's hand tracking service"));
  EXPECT_THAT(absent[1].why, HasSubstr("OpenXR runtime"));
  plug_in("1-4", "f182", "0003", "");
  EXPECT_THAT(backends(), testing::ElementsAre("openxr")) << "it is listed with its trouble";
  const auto text = print({}, {}, {"leapc: install it"});
  EXPECT_THAT(text, HasSubstr("trackers\n  none\n  without leapc: install it\n"));
}

TEST_F(Trackers, ALibraryWithoutADeviceIsListedWithItsTrouble) {
  install_leapc();
  ASSERT_EQ(found().size(), 1u);
  EXPECT_EQ(found()[0].trouble, "no device of Ultraleap is attached");
}

TEST_F(Trackers, TheActiveRuntimeIsListedWithoutStartingIt) {
  // Its library cannot be loaded, which nobody tries.
  const auto manifest = write("a.json", R"({"runtime": {"name": "Monado", "library_path": ")" +
                                            write("libxr.so", "not a library") + R"("}})");
  const Variable runtime("XR_RUNTIME_JSON", manifest);
  ASSERT_EQ(found().size(), 1u);
  EXPECT_EQ(found()[0].name, "OpenXR runtime Monado");
  EXPECT_THAT(found()[0].about, HasSubstr(manifest));
  EXPECT_EQ(found()[0].settings.front().second, "openxr");
  const auto text = print(found(), {});
  EXPECT_THAT(text, HasSubstr("trackers\n  OpenXR runtime Monado\n"));
  EXPECT_THAT(text, HasSubstr("      [pose]\n      backend = \"openxr\"\n"));
  EXPECT_EQ(nlohmann::json::parse(to_json(found()))[0]["kind"], "trackers");
}

TEST_F(Trackers, AManifestThatIsNoneIsATrouble) {
  const Variable runtime("XR_RUNTIME_JSON", write("bad.json", "{"));
  ASSERT_EQ(found().size(), 1u);
  EXPECT_THAT(found()[0].trouble, HasSubstr("bad.json"));
}

}  // namespace
}  // namespace handcast::devices
