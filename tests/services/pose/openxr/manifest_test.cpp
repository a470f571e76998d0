// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch.hpp"
#include "tests/system/variable.hpp"

namespace handcast::pose::openxr {
namespace {

using system_test::Variable;
using testing::HasSubstr;

class Manifests : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const auto file = scratch_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }
  test::Scratch scratch_;
};

TEST_F(Manifests, TheLibraryIsRelativeToTheManifest) {
  const auto library = write("lib/libruntime.so", "");
  const auto file = write("share/it.json",
                          R"({"runtime": {"name": "It", "library_path": "../lib/libruntime.so"}})");
  const auto found = find_runtime(file);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->name, "It");
  EXPECT_EQ(found->library, library);
  const auto bare = find_runtime(write("b.json", R"({"runtime": {"library_path": "libx.so"}})"));
  ASSERT_TRUE(bare) << bare.error().what;
  EXPECT_EQ(bare->library, "libx.so") << "the linker looks for it";
  EXPECT_EQ(bare->name, "libx.so");
}

TEST_F(Manifests, TheActiveOneIsFoundWhereTheLoaderLooks) {
  const auto library = write("libruntime.so", "");
  const auto text = [&](const std::string& name) {
    return R"({"runtime": {"name": ")" + name + R"(", "library_path": ")" + library + R"("}})";
  };
  write("system/openxr/1/active_runtime.json", text("the system's"));
  const Variable none("XR_RUNTIME_JSON", "");
  const Variable home("XDG_CONFIG_HOME", scratch_.path() / "user");
  const Variable dirs("XDG_CONFIG_DIRS", "/nowhere:" + (scratch_.path() / "system").string());
  EXPECT_EQ(find_runtime("").value().name, "the system's");
  write("user/openxr/1/active_runtime.json", text("the user's"));
  EXPECT_EQ(find_runtime("").value().name, "the user's");
  const Variable chosen("XR_RUNTIME_JSON", write("chosen.json", text("the chosen one")));
  EXPECT_EQ(find_runtime("").value().name, "the chosen one");
}

TEST_F(Manifests, AnActiveOneThatWasRemovedIsALinkToNothing) {
  const Variable none("XR_RUNTIME_JSON", "");
  const Variable home("XDG_CONFIG_HOME", scratch_.path() / "user");
  const auto link = write("user/openxr/1/there", "");
  std::filesystem::create_symlink("/nowhere/monado.json",
                                  scratch_.path() / "user/openxr/1/active_runtime.json");
  const auto found = find_runtime("");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::unavailable);
  EXPECT_THAT(found.error().what, HasSubstr("user/openxr/1/active_runtime.json' is a link to no"));
}

TEST_F(Manifests, WithoutAnyTheRemedyIsNamedInOneShortSentence) {
  const Variable none("XR_RUNTIME_JSON", "");
  const Variable home("XDG_CONFIG_HOME", scratch_.path() / "user");
  const Variable dirs("XDG_CONFIG_DIRS", "/nowhere");
  const auto found = find_runtime("");
  if (found) GTEST_SKIP() << "this computer has one: " << found->file;
  EXPECT_THAT(found.error().what, testing::AllOf(HasSubstr("no OpenXR runtime is active"),
                                                 HasSubstr("pose.openxr.runtime"),
                                                 testing::Not(HasSubstr("/nowhere"))));
}

TEST_F(Manifests, AVariableThatNamesNoneIsNamed) {
  const Variable none("XR_RUNTIME_JSON", "/nowhere/runtime.json");
  const auto found = find_runtime("");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::unavailable);
  EXPECT_THAT(found.error().what, HasSubstr("/nowhere/runtime.json"));
  EXPECT_THAT(found.error().what, HasSubstr("install"));
}

TEST_F(Manifests, WhatIsNoManifestIsRefusedWithItsName) {
  for (const auto* text : {"", "{", "[]", "1", "null", "{}", R"({"runtime": 1})",
                           R"({"runtime": {}})", R"({"runtime": {"library_path": 1}})"}) {
    const auto found = find_runtime(write("bad.json", text));
    ASSERT_FALSE(found) << text;
    EXPECT_EQ(found.error().code, Errc::bad_config) << text;
    EXPECT_THAT(found.error().what, HasSubstr("bad.json"));
  }
}

TEST_F(Manifests, OneOfAnyDepthIsRefusedWithItsName) {
  constexpr std::size_t kDepth = 480'000;  // just below the largest size of a manifest
  const auto deep = std::string(kDepth, '[') + std::string(kDepth, ']');
  for (const auto& text :
       {R"({"runtime":)" + deep + "}", deep, R"({"runtime":{"library_path":)" + deep + "}}"}) {
    const auto found = find_runtime(write("deep.json", text));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, Errc::bad_config);
    EXPECT_THAT(found.error().what, HasSubstr("deep.json' is no manifest"));
  }
}

TEST_F(Manifests, ALibraryThatIsGoneMayComeBack) {
  const auto found = find_runtime(
      write("a.json", R"({"runtime": {"name": "Gone", "library_path": "./libgone.so"}})"));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::unavailable);
  EXPECT_THAT(found.error().what, HasSubstr("libgone.so"));
}

TEST_F(Manifests, OneThatCannotBeReadIsNamedWithTheReason) {
  const auto file = write("a.json", R"({"runtime": {"library_path": "libx.so"}})");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  if (std::ifstream(file)) GTEST_SKIP() << "this user may read everything";
  const auto found = find_runtime(file);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::bad_config);
  EXPECT_THAT(found.error().what, HasSubstr("a.json' cannot be read: Permission denied"));
}

TEST_F(Manifests, ALibraryThatCannotBeLoadedIsNamedWithItsManifest) {
  const auto library = write("libtext.so", "this is no library");
  for (const auto& named : {library, std::string("libnot_installed_anywhere.so")}) {
    const auto loaded = check_library({.file = "it.json", .name = "It", .library = named});
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, Errc::unavailable);
    EXPECT_THAT(loaded.error().what,
                testing::AllOf(HasSubstr(named), HasSubstr("'It'"), HasSubstr("(it.json)")));
  }
  EXPECT_TRUE(check_library({.file = "it.json", .name = "It", .library = "libc.so.6"}));
}

}  // namespace
}  // namespace handcast::pose::openxr
