// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/write_whole.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/unique_fd.hpp"
#include "tests/scratch.hpp"
#include "tests/small_files.hpp"

namespace handcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

class WriteWhole : public testing::Test {
 protected:
  /// All files of the folder with their texts.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_))
      files[entry.path().filename()] = text_of(entry.path());
    return files;
  }
  static std::string text_of(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void make(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  /// The name under which the only new file is made while file_ is written; "" if there is none, or
  /// more than one.
  std::string name_while_written(const std::string& text) const {
    const UniqueFd watch(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK));
    EXPECT_GE(::inotify_add_watch(watch.get(), folder_.c_str(), IN_CREATE), 0);
    EXPECT_TRUE(write_whole(file_, text));
    alignas(inotify_event) std::array<char, 4096> events{};
    const auto length = ::read(watch.get(), events.data(), events.size());
    const auto* event = reinterpret_cast<const inotify_event*>(events.data());
    return length == static_cast<ssize_t>(sizeof(*event) + event->len) ? event->name : "";
  }
  static fs::perms permissions_of(const fs::path& file) { return fs::status(file).permissions(); }

  test::Scratch scratch_;
  const fs::path& folder_ = scratch_.path();
  const fs::path file_ = folder_ / "rig.toml";
};

/// The user whom permissions bind: root becomes nobody.
class AsUser {
 public:
  explicit AsUser(const fs::path& folder) {
    constexpr uid_t kNobody = 65534;
    if (is_root_ && (::chown(folder.c_str(), kNobody, kNobody) != 0 || ::seteuid(kNobody) != 0))
      ADD_FAILURE() << "root cannot become another user";
  }
  AsUser(const AsUser&) = delete;
  AsUser& operator=(const AsUser&) = delete;
  /// If this user may write in the folder, a refusal is not that of a folder above it.
  static void expect_that_it_may_write(const fs::path& folder) {
    const auto may = write_whole(folder / "may", "x");
    ASSERT_TRUE(may) << may.error().what;
    fs::remove(folder / "may");
  }
  ~AsUser() {
    if (is_root_ && ::seteuid(0) != 0) std::abort();
  }

 private:
  const bool is_root_ = ::geteuid() == 0;
};

TEST_F(WriteWhole, AReaderKeepsTheOldFileAndNothingIsLeftBeside) {
  ASSERT_TRUE(write_whole(file_, "a longer first text"));
  std::ifstream reader(file_);
  ASSERT_TRUE(write_whole(file_, "second"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "a longer first text");
  EXPECT_THAT(files(), ElementsAre(Pair("rig.toml", "second")));
}

TEST_F(WriteWhole, FilesOfThePersonBesideItStay) {
  const std::map<std::string, std::string> own{{"rig.toml.tmp", "mine"},
                                               {"rig.toml.new.toml", "mine, too"},
                                               {".rig.toml", "hidden"},
                                               {"rig.toml.part", "part"},
                                               {"rig.toml.new", "new"}};
  for (const auto& [name, text] : own) make(folder_ / name, text);
  ASSERT_TRUE(write_whole(file_, "text"));
  auto expected = own;
  expected["rig.toml"] = "text";
  EXPECT_EQ(files(), expected);
}

TEST_F(WriteWhole, AHiddenFileOfTheSameNameIsNotTouched) {
  const auto hidden = fmt::format(".rig.toml.{}-", ::getpid());
  const auto name = name_while_written("first");
  ASSERT_THAT(name, StartsWith(hidden));
  const int number = std::stoi(name.substr(hidden.size()));
  for (const int next : {1, 2, 3})
    make(folder_ / fmt::format("{}{}", hidden, number + next), "of an earlier process");
  auto expected = files();
  EXPECT_EQ(name_while_written("text"), fmt::format("{}{}", hidden, number + 4));
  expected["rig.toml"] = "text";
  EXPECT_EQ(files(), expected);
}

TEST_F(WriteWhole, PermissionsAreKeptAndNewFilesHaveTheUsualOnes) {
  const auto umask_before = ::umask(027);
  ASSERT_TRUE(write_whole(file_, "new"));
  ::umask(umask_before);
  EXPECT_EQ(permissions_of(file_), static_cast<fs::perms>(0640));
  for (const int mode : {0600, 0664, 0755}) {
    fs::permissions(file_, static_cast<fs::perms>(mode));
    ASSERT_TRUE(write_whole(file_, "again"));
    EXPECT_EQ(permissions_of(file_), static_cast<fs::perms>(mode));
  }
}

TEST_F(WriteWhole, RootLeavesAUsersFileToTheUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  make(file_, "of a user");
  ASSERT_EQ(::chown(file_.c_str(), 1234, 5678), 0);
  ASSERT_TRUE(write_whole(file_, "by root"));
  struct stat status {};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 1234u);
  EXPECT_EQ(status.st_gid, 5678u);
}

TEST_F(WriteWhole, LinksAreFollowedAndStay) {
  fs::create_directory(folder_ / "real");
  make(folder_ / "real/rig.toml", "old");
  fs::permissions(folder_ / "real/rig.toml", static_cast<fs::perms>(0600));
  fs::create_symlink("real/rig.toml", folder_ / "second");  // relative
  fs::create_symlink(folder_ / "second", file_);            // to a link
  std::ifstream reader(file_);
  ASSERT_TRUE(write_whole(file_, "text"));
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_TRUE(fs::is_symlink(folder_ / "second"));
  EXPECT_EQ(text_of(folder_ / "real/rig.toml"), "text");
  EXPECT_EQ(permissions_of(folder_ / "real/rig.toml"), static_cast<fs::perms>(0600));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old") << "not in place";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "real"), {}), 1);
}

TEST_F(WriteWhole, ALinkToNowhereMakesTheFile) {
  fs::create_symlink(folder_ / "later", file_);
  ASSERT_TRUE(write_whole(file_, "text"));
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_EQ(text_of(folder_ / "later"), "text");
}

TEST_F(WriteWhole, LinksThatLeadToEachOtherAreRefusedAndStay) {
  fs::create_symlink(folder_ / "second", file_);
  fs::create_symlink(file_, folder_ / "second");
  const auto refused = write_whole(file_, "text");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("rig.toml' cannot be written: Too many levels"));
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_TRUE(fs::is_symlink(folder_ / "second"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
  const auto checked = check_writable(file_);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().what, HasSubstr("rig.toml: cannot be written: Too many levels"));
}

TEST_F(WriteWhole, InAFolderThatMayNotBeWrittenTheOldFileStays) {
  make(file_, "old");
  fs::permissions(file_, fs::perms::all);
  const AsUser user(folder_);
  ASSERT_NO_FATAL_FAILURE(AsUser::expect_that_it_may_write(folder_));
  fs::permissions(folder_, static_cast<fs::perms>(0555));
  const auto refused = write_whole(file_, "new");
  const auto checked = check_writable(file_);
  const auto another = write_whole(folder_ / "another", "new");
  fs::permissions(folder_, static_cast<fs::perms>(0755));
  for (const auto* result : {&refused, &another}) {
    ASSERT_FALSE(*result);
    EXPECT_EQ(result->error().code, Errc::unavailable);
    EXPECT_THAT(result->error().what, HasSubstr("cannot be written: Permission denied"));
  }
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::bad_config);
  EXPECT_THAT(files(), ElementsAre(Pair("rig.toml", "old")));
}

TEST_F(WriteWhole, AFileThatMayNotBeWrittenIsNotReplacedEither) {
  make(file_, "old");
  fs::permissions(file_, static_cast<fs::perms>(0444));
  const AsUser user(folder_);
  ASSERT_NO_FATAL_FAILURE(AsUser::expect_that_it_may_write(folder_));
  const auto refused = write_whole(file_, "new");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("Permission denied"));
  EXPECT_FALSE(check_writable(file_));
  EXPECT_THAT(files(), ElementsAre(Pair("rig.toml", "old")));
}

TEST_F(WriteWhole, OnAFullDiskTheOldFileStaysAndNothingElse) {
  make(file_, "old");
  Result<void> written;
  {
    const test::SmallFiles full(1000);
    written = write_whole(file_, std::string(5000, 'x'));
  }
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::unavailable);
  EXPECT_THAT(written.error().what, HasSubstr("rig.toml' cannot be written: File too large"));
  EXPECT_THAT(files(), ElementsAre(Pair("rig.toml", "old")));
}

TEST_F(WriteWhole, AMissingFolderIsNamed) {
  const auto written = write_whole(folder_ / "none/rig.toml", "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::unavailable);
  EXPECT_THAT(written.error().what, HasSubstr("none/rig.toml' cannot be written: No such file"));
}

TEST_F(WriteWhole, ALongNameIsPossible) {
  const auto file = folder_ / std::string(255, 'n');
  ASSERT_TRUE(write_whole(file, "text"));
  EXPECT_EQ(text_of(file), "text");
  EXPECT_FALSE(write_whole(folder_ / std::string(256, 'n'), "text"));
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(WriteWhole, APipeOrFolderIsNotWrittenAndNotWaitedFor) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const auto& [file, kind] : {std::pair{folder_ / "pipe", "a pipe"}, {folder_, "a folder"}}) {
    EXPECT_THAT(write_whole(file, "text").error().what,
                HasSubstr(std::string("cannot be written: it is ") + kind));
    EXPECT_EQ(check_writable(file).error().code, Errc::bad_config);
  }
}

TEST_F(WriteWhole, AResultDoesNotReplaceARigFile) {
  const auto rig = folder_ / "show.toml";
  EXPECT_TRUE(check_result_file(rig)) << "there is none yet";
  make(rig, "name = \"show\"");
  EXPECT_THAT(check_result_file(rig).error().what, HasSubstr("show.toml: is a TOML file"));
  EXPECT_TRUE(check_writable(rig));
  make(folder_ / "show.json", "{}");
  EXPECT_TRUE(check_result_file(folder_ / "show.json"));
}

TEST_F(WriteWhole, ADeviceIsWrittenInPlace) {
  EXPECT_THAT(write_whole("/dev/full", "text").error().what, HasSubstr("No space left on device"));
  EXPECT_TRUE(write_whole("/dev/null", "text"));
  EXPECT_TRUE(check_writable("/dev/null"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(WriteWhole, AnOpenFileOfThisProcessIsWrittenInPlace) {
  make(file_, "old");
  std::FILE* open = std::fopen(file_.c_str(), "r+");
  ASSERT_TRUE(open);
  EXPECT_TRUE(write_whole(fmt::format("/proc/self/fd/{}", ::fileno(open)), "text"));
  std::array<char, 8> read{};
  EXPECT_EQ(std::fread(read.data(), 1, read.size(), open), 4u) << "the open file is another one";
  std::fclose(open);
  EXPECT_EQ(text_of(file_), "text");
}

TEST_F(WriteWhole, AFileThatIsTheStandardOutputKeepsWhatIsInItAndWhatFollows) {
  for (const int flags : {O_WRONLY | O_APPEND, O_WRONLY}) {  // as >> and as (...) > of a shell
    make(file_, "");
    std::fflush(stdout);
    const UniqueFd before(::dup(STDOUT_FILENO));
    const UniqueFd log(::open(file_.c_str(), flags | O_CLOEXEC));
    ASSERT_GE(::dup2(log.get(), STDOUT_FILENO), 0);
    std::fputs("a log, ", stdout);
    const auto by_number = write_whole("/proc/self/fd/1", "a text, ");
    const auto by_name = write_whole(file_, "another, ");
    std::fputs("the end", stdout);
    std::fflush(stdout);
    ASSERT_GE(::dup2(before.get(), STDOUT_FILENO), 0);
    EXPECT_TRUE(by_number);
    EXPECT_TRUE(by_name);
    EXPECT_THAT(files(), ElementsAre(Pair("rig.toml", "a log, a text, another, the end")));
  }
}

}  // namespace
}  // namespace handcast
