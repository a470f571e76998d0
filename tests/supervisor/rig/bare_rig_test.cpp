// SPDX-License-Identifier: Apache-2.0
// Rigs of daemons without real work: how the supervisor and its successor handle them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>
#include <future>
#include <map>
#include <sstream>

#include "ipc/control/control_client.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/adoption.hpp"
#include "supervisor/succession/process_discovery.hpp"
#include "tests/supervisor/scope_scratch.hpp"
#include "tests/system/command.hpp"
#include "tests/system/variable.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;
using system_test::Command, system_test::eventually, system_test::is_alive, system_test::Variable;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kDaemons{"camera", "pose", "landmarks", "projector", "content"};
constexpr auto kObserver = "[observer]\nenabled = true\n",
               kNoObserver = "[observer]\nenabled = false\n";
constexpr auto kNeverReady = "exec sleep 1000";

class BareRig : public testing::Test {
 protected:
  void SetUp() override {
    const auto built = system_test::program_folder();
    for (const auto* program : {"handcast", "handcast_bare_daemon", "handcast_looping_observer"})
      if (!std::filesystem::exists(built / program))
        GTEST_SKIP() << program << " has not been built";
    std::filesystem::create_directory(programs_);
    std::filesystem::copy_file(built / "handcast", programs_ / "handcast");
    for (const auto& daemon : kDaemons)
      std::filesystem::copy_file(built / "handcast_bare_daemon",
                                 programs_ / ("handcast-" + daemon));
    std::filesystem::copy_file(built / "handcast_looping_observer",
                               programs_ / "handcast-observer");
    write_rig(kNoObserver);
    bin_.emplace("HANDCAST_BIN", programs_.string());
  }
  void TearDown() override { system_test::kill_all_of(scratch_.path()); }

  void write_file(const std::string& text) const { std::ofstream(file_) << text; }
  void write_rig(const std::string& more) const {
    write_file("name = \"desk\"\ndesk.page.listen = \"\"\n" + more);
  }
  /// Replaces an existing file, even if it is being executed.
  static void write_program(const std::filesystem::path& program, const std::string& script) {
    std::filesystem::remove(program);
    std::ofstream(program) << "#!/bin/bash\n" << script << "\n";
    chmod(program.c_str(), 0755);
  }
  void make_daemon(const std::string& name, const std::string& script) const {
    write_program(programs_ / ("handcast-" + name), script);
  }

  std::unique_ptr<Command> up() const {
    return std::make_unique<Command>(scratch_.path(), system_test::Arguments{"up", file_.string()});
  }
  std::unique_ptr<Command> ready_rig() const {
    auto rig = up();
    EXPECT_TRUE(eventually([this] {
      const auto now = services();
      return now.is_object() && std::ranges::all_of(now, [](const auto& service) {
               return service["state"] == "ready";
             });
    })) << rig->log();
    return rig;
  }
  void replace_supervisor(const Command& rig) const {
    const auto before = rig.supervisor();
    ASSERT_GT(before, 0);
    ASSERT_EQ(kill(before, SIGKILL), 0);
    ASSERT_TRUE(eventually([&] {
      return rig.supervisor() > 0 && rig.supervisor() != before && services().is_object();
    })) << rig.log();
  }

  /// The applied rig as TOML.
  static std::string applied() { return state_of("desk").value().applied; }
  /// The memory in which the supervisor saves its state.
  static StateMemory memory() { return state_memory_of(find_services("desk").at(0)).value(); }
  static json services() {
    const auto answer =
        control::ask("desk", {.verb = control::Verb::status, .service = {}, .backend = {}});
    return answer ? (*answer)["status"]["services"] : json();
  }
  static pid_t pid_of(const std::string& service) {
    return services()[service]["pid"].get<pid_t>();
  }
  static Result<json> reload() {
    return control::ask("desk", {.verb = control::Verb::reload, .service = {}, .backend = {}});
  }
  static Result<json> restart(const std::string& service) {
    return control::ask("desk",
                        {.verb = control::Verb::restart, .service = service, .backend = {}});
  }

  ScopeScratch scratch_;
  const std::filesystem::path file_ = scratch_.path() / "desk.toml",
                              programs_ = scratch_.path() / "programs";
  std::optional<Variable> bin_;
};

TEST_F(BareRig, ASuccessorGoesOnWithTheRigAsItWasAppliedAndTheFileCountsWhenItIsReloaded) {
  const auto rig = ready_rig();
  const auto camera = pid_of("camera");
  for (const auto* text : {"name = \"desk\"\n[camera\nrate", "name = \"wall\"\n"}) {
    write_file(text);
    replace_supervisor(*rig);
    EXPECT_EQ(pid_of("camera"), camera);
  }
  EXPECT_THAT(rig->log(),
              HasSubstr("rig 'desk' continues with its applied settings; `handcast reload` reads " +
                        file_.string()));
  write_rig(std::string("[camera]\nrate_hz = 50\n") + kNoObserver);
  replace_supervisor(*rig);
  EXPECT_EQ(pid_of("camera"), camera);
  const auto reloaded = reload();
  ASSERT_TRUE(reloaded) << reloaded.error().what << rig->log();
  EXPECT_NE(pid_of("camera"), camera);
}

TEST_F(BareRig, AServiceThatHadFailedStaysFailedUnderTheNextSupervisorAndTheRestGoesOn) {
  const auto rig = ready_rig();
  const auto landmarks = pid_of("landmarks");
  make_daemon("landmarks", "exit 100");
  EXPECT_FALSE(restart("landmarks"));
  EXPECT_EQ(pid_of("landmarks"), landmarks) << "the old process goes on";
  kill(landmarks, SIGKILL);
  ASSERT_TRUE(eventually([] { return services()["landmarks"]["state"] == "failed"; }));
  const auto camera = pid_of("camera");
  replace_supervisor(*rig);
  EXPECT_EQ(services()["landmarks"]["state"], "failed");
  EXPECT_EQ(pid_of("camera"), camera);
  std::filesystem::remove(programs_ / "handcast-landmarks");
  std::filesystem::copy_file(programs_ / "handcast-pose", programs_ / "handcast-landmarks");
  EXPECT_TRUE(restart("landmarks"));
}

TEST_F(BareRig, IsUpAlthoughOneServiceDoesNotGetReady) {
  make_daemon("landmarks", kNeverReady);
  write_rig(std::string("[supervisor]\nready_s = 2\n") + kNoObserver);
  const auto rig = up();
  EXPECT_TRUE(eventually([&] { return rig->log().find("rig 'desk' is up") != std::string::npos; }))
      << rig->log();
}

TEST_F(BareRig, ARestartOfAServiceThatDoesNotGetReadyIsAnsweredAndBlocksNothing) {
  make_daemon("landmarks", kNeverReady);
  write_rig(std::string("[supervisor]\nready_s = 1\nstop_s = 1\n") + kNoObserver);
  const auto rig = up();
  ASSERT_TRUE(eventually([] { return services().is_object(); })) << rig->log();
  for (int i = 0; i < 2; ++i) {
    const auto answer = restart("landmarks");
    ASSERT_FALSE(answer);
    EXPECT_THAT(answer.error().what, HasSubstr("landmarks is not ready yet, and goes on trying"));
  }
  EXPECT_TRUE(reload());
}

TEST_F(BareRig, AServiceThatIsSwitchedOnAgainUnderTheNextSupervisorIsHeard) {
  write_rig(kObserver);
  const auto rig = ready_rig();
  write_rig(kNoObserver);
  ASSERT_TRUE(reload());
  replace_supervisor(*rig);
  write_rig(kObserver);
  ASSERT_TRUE(reload());
  EXPECT_TRUE(eventually([] { return services()["observer"]["silent_ms"].is_number(); }));
}

TEST_F(BareRig, OnlyDaemonsOfTheRigAreEndedAsStraysNotWhateverElseIsAChildOfTheKeeper) {
  const auto notes = scratch_.path() / "notes", ready = scratch_.path() / "ready";
  std::filesystem::create_directory(scratch_.path() / "entry");
  std::filesystem::copy_file("/bin/sleep", programs_ / "handcast-stray");
  // The stray comes when the rig is ready: a rig that starts ends those that it finds.
  write_program(
      scratch_.path() / "entry" / "handcast",
      fmt::format("setsid sleep 1000 & echo $! > {0}\n"
                  "(until [ -e {1} ]; do sleep 0.05; done\n"
                  " HANDCAST_RIG={2} exec setsid {3}/handcast-stray 1000) & echo $! >> {0}\n"
                  "exec {3}/handcast \"$@\"",
                  notes.string(), ready.string(), control::address_of("desk").value().text,
                  programs_.string()));
  bin_.emplace("HANDCAST_BIN", (scratch_.path() / "entry").string());
  const auto rig = ready_rig();
  pid_t other = 0, stray = 0;
  std::ifstream(notes) >> other >> stray;
  ASSERT_TRUE(other > 0 && stray > 0);
  std::ofstream(ready) << "now";
  ASSERT_TRUE(eventually(
      [&] { return proc_text(fmt::format("/proc/{}/comm", stray)) == "handcast-stray\n"; }));
  replace_supervisor(*rig);
  EXPECT_TRUE(eventually([&] { return !is_alive(stray); }));
  EXPECT_TRUE(is_alive(other));
}

TEST_F(BareRig, AnUpAfterTheKeepersDeathGoesOnWithTheAppliedRigAndOtherArgumentsChangeNothing) {
  auto rig = ready_rig();
  const auto before = applied();
  const auto camera = pid_of("camera"), supervisor = rig->supervisor();
  rig->signal(SIGKILL);
  rig->wait();
  write_rig(std::string("[camera]\nrate_hz = 50\n") + kNoObserver);

  Command other(scratch_.path(), {"up", file_.string(), "--set", "camera.exposure_ms=1"});
  EXPECT_EQ(other.wait(), 111);
  EXPECT_TRUE(is_alive(supervisor));

  rig = up();
  ASSERT_TRUE(eventually([&] { return rig->supervisor() > 0 && !is_alive(supervisor); }));
  ASSERT_TRUE(eventually([] { return services().is_object(); }));
  EXPECT_EQ(pid_of("camera"), camera);
  EXPECT_TRUE(applied() == before);
}

TEST_F(BareRig, AReloadWhoseServiceCannotStartDoesNotStopARigThatIsNotUpYet) {
  make_daemon("landmarks", kNeverReady);
  std::filesystem::remove(programs_ / "handcast-observer");
  write_rig(std::string("[supervisor]\nready_s = 8\n") + kNoObserver);
  const auto rig = up();
  ASSERT_TRUE(
      eventually([] { return services().is_object() && services()["landmarks"]["pid"] != 0; }));
  write_rig(std::string("[supervisor]\nready_s = 8\n") + kObserver);
  const auto reloaded = reload();
  ASSERT_FALSE(reloaded);
  EXPECT_THAT(reloaded.error().what, HasSubstr("observer is failed"));
  EXPECT_EQ(services()["camera"]["state"], "ready");
}

/// Prevents the supervisor from creating rings, whose descriptors are 100 or more, during the
/// lifetime of the object.
class NoNewRings {
 public:
  explicit NoNewRings(pid_t pid) : pid_(pid) {
    const rlimit few{.rlim_cur = 100, .rlim_max = kMost};
    prlimit(pid_, RLIMIT_NOFILE, &few, nullptr);
  }
  ~NoNewRings() {
    const rlimit enough{.rlim_cur = kMost, .rlim_max = kMost};
    prlimit(pid_, RLIMIT_NOFILE, &enough, nullptr);
  }

 private:
  static constexpr rlim_t kMost = 1024;
  pid_t pid_;
};

TEST_F(BareRig, AReloadThatCannotBeAppliedChangesNothing) {
  const auto rig = ready_rig();
  const auto before = applied();
  const auto camera = pid_of("camera");
  write_rig(std::string("[camera]\nrate_hz = 50\n") + kObserver);
  {
    const NoNewRings none(rig->supervisor());
    const auto refused = reload();
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().what, HasSubstr("ring marks.observer"));
    EXPECT_THAT(refused.error().what, HasSubstr("a limit of at least 200 (ulimit -n)"));
  }
  EXPECT_TRUE(applied() == before);
  EXPECT_FALSE(services().contains("observer"));
  EXPECT_EQ(pid_of("camera"), camera);
  const auto again = reload();
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_FALSE(applied() == before);
  EXPECT_EQ(services()["observer"]["state"], "ready");
}

/// A rig whose daemons are described, so that the supervisor knows that none needs a device.
class DescribedRig : public BareRig {
 protected:
  void SetUp() override {
    const auto built = system_test::program_folder();
    BareRig::SetUp();
    if (IsSkipped()) return;
    const auto services = std::filesystem::path("share") / "handcast" / "services";
    std::filesystem::create_directories(scratch_.path() / services.parent_path());
    std::filesystem::copy(built / ".." / services, scratch_.path() / services);
  }
  /// A request that is answered later, or never.
  static std::future<Result<json>> restart_later(const std::string& service) {
    return std::async(std::launch::async, [service] { return restart(service); });
  }
  /// The pids of the daemons with this name.
  std::vector<pid_t> daemons(const std::string& name) const {
    std::vector<pid_t> pids;
    const auto program = (programs_ / ("handcast-" + name)).string();
    for (const auto& process : find_services("desk")) {
      std::ifstream file("/proc/" + std::to_string(process.pid) + "/cmdline");
      const std::string words(std::istreambuf_iterator<char>(file), {});
      if (words.find(program) != std::string::npos) pids.push_back(process.pid);
    }
    return pids;
  }
  /// The next process of this daemon starts and does nothing.
  void make_idle(const std::string& name) const {
    std::filesystem::copy_file("/bin/sleep", programs_ / "handcast-idle");
    make_daemon(name, "exec -a \"$0\" " + (programs_ / "handcast-idle").string() + " 1000");
  }
  bool has_two(const std::string& name) const {
    return eventually([&] { return daemons(name).size() == 2; });
  }
};
TEST_F(DescribedRig, ARestartReplacesAServiceAndSaysHowLongItsStreamPaused) {
  const auto rig = ready_rig();
  for (const auto& name : kDaemons) {
    const auto before = pid_of(name);
    const auto answer = restart(name);
    ASSERT_TRUE(answer) << answer.error().what;
    EXPECT_TRUE((*answer)["pause_ms"].is_number());
    EXPECT_NE(pid_of(name), before);
    EXPECT_TRUE(eventually([&] { return daemons(name).size() == 1; }));
    EXPECT_EQ(services()[name]["restarts"], 0);
  }
  EXPECT_TRUE(eventually([] {
    const auto now = services();
    return std::ranges::all_of(now, [](const auto& each) { return each["silent_ms"] < 1000; });
  })) << "the new processes have taken the rings of the heartbeats, too";
}

TEST_F(DescribedRig, ASupervisorThatDiesWhileAReplacementPreparesLeavesTheOldService) {
  const auto rig = ready_rig();
  const auto before = pid_of("pose");
  make_idle("pose");
  const auto answer = restart_later("pose");
  ASSERT_TRUE(has_two("pose"));
  replace_supervisor(*rig);
  EXPECT_TRUE(eventually([&] { return daemons("pose") == std::vector{before}; }));
  EXPECT_EQ(pid_of("pose"), before);
  EXPECT_EQ(services()["pose"]["restarts"], 0);
}

TEST_F(DescribedRig, DownWhileAReplacementPreparesStopsEverything) {
  const auto rig = ready_rig();
  make_idle("pose");
  auto answer = restart_later("pose");
  ASSERT_TRUE(has_two("pose"));
  EXPECT_THAT(restart("pose").error().what, HasSubstr("is being restarted already"));
  EXPECT_THAT(reload().error().what, HasSubstr("pose is being restarted"));
  rig->signal(SIGTERM);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  EXPECT_FALSE(answer.get());
  for (const auto& name : kDaemons) EXPECT_TRUE(daemons(name).empty()) << name;
}

TEST_F(DescribedRig, AReloadIsAppliedAsAWholeOrNotAtAll) {
  const auto rig = ready_rig();
  const auto applied_before = applied();
  std::map<std::string, pid_t> before;
  for (const auto& name : kDaemons) before[name] = pid_of(name);
  make_daemon("landmarks", "echo '1.0 landmarks error no model' >&2; exit 100");
  write_rig(std::string("[camera]\nrate_hz = 50\n") + kNoObserver);
  const auto failed = reload();
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().what, HasSubstr("landmarks cannot work with the new settings: no "
                                             "model; nothing was changed"));
  EXPECT_TRUE(applied() == applied_before);
  for (const auto& [name, pid] : before) EXPECT_EQ(pid_of(name), pid);
  EXPECT_TRUE(eventually([&] { return daemons("camera").size() == 1; }))
      << "the camera's replacement has ended";

  std::filesystem::remove(programs_ / "handcast-landmarks");
  std::filesystem::copy_file(programs_ / "handcast-pose", programs_ / "handcast-landmarks");
  const auto done = reload();
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_THAT((*done)["restarted"], ElementsAre("camera", "landmarks"));
  EXPECT_TRUE((*done)["pauses_ms"]["camera"].is_number());
  EXPECT_NE(pid_of("camera"), before["camera"]);
  EXPECT_EQ(pid_of("pose"), before["pose"]);
  EXPECT_FALSE(applied() == applied_before);
}

TEST_F(DescribedRig, AServiceThatDiesWhileItsReplacementPreparesIsStartedAgainMeanwhile) {
  const auto rig = ready_rig();
  const auto before = pid_of("pose");
  const auto ready = scratch_.path() / "ready";
  make_daemon("pose", "if [ -n \"$HANDCAST_STANDBY_FD\" ]; then while [ ! -e " + ready.string() +
                          " ]; do sleep 0.02; done; fi; exec -a \"$0\" " +
                          (programs_ / "handcast-camera").string() + " \"$@\"");
  // The camera's program under another name, which is its role (tests/system/bare_daemon.cpp).
  auto answer = restart_later("pose");
  ASSERT_TRUE(has_two("pose"));
  kill(before, SIGKILL);
  ASSERT_TRUE(eventually(
      [&] { return pid_of("pose") != before && services()["pose"]["state"] == "ready"; }));
  const auto between = pid_of("pose");
  std::ofstream(ready) << "now";
  const auto done = answer.get();
  EXPECT_TRUE(done) << done.error().what;
  EXPECT_NE(pid_of("pose"), between);
  EXPECT_EQ(services()["pose"]["restarts"], 1);
}

TEST_F(BareRig, AnUpThatCannotTakeOverLeavesTheAppliedRigAsItWas) {
  auto rig = ready_rig();
  const auto before = applied();
  const auto supervisor = rig->supervisor();
  rig->signal(SIGKILL);
  rig->wait();
  kill(supervisor, SIGKILL);
  ASSERT_TRUE(eventually([&] { return !is_alive(supervisor); }));
  auto state = memory().load("desk").value();
  for (auto& ring : state.rings) ring.inode = 1;
  ASSERT_TRUE(memory().save(state));
  write_rig(std::string("[camera]\nrate_hz = 50\n") + kNoObserver);
  rig = std::make_unique<Command>(
      scratch_.path(),
      system_test::Arguments{"up", file_.string(), "--set", "camera.exposure_ms=1"});
  EXPECT_EQ(rig->wait(), 111);
  EXPECT_THAT(rig->log(), HasSubstr("cannot be taken over"));
  EXPECT_TRUE(applied() == before);
}

TEST_F(BareRig, WhoAsksTwiceToStopNeedNotWaitAndNobodyIsStartedAgain) {
  write_program(programs_ / "handcast-observer",
                "trap '' TERM INT; echo >&$HANDCAST_READY_FD; while :; do sleep 0.05; done");
  write_rig(std::string("[supervisor]\nsilent_s = 300\nstop_s = 60\n") + kObserver);
  const auto rig = ready_rig();
  rig->signal(SIGTERM);
  EXPECT_TRUE(eventually([] { return services()["observer"]["state"] == "stopping"; }));
  EXPECT_EQ(services()["camera"]["state"], "ready") << "its turn comes later";
  rig->signal(SIGTERM);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  EXPECT_THAT(rig->log(), Not(HasSubstr("started again")));
}

// A process that SIGKILL does not end at once: an orphan that is not reaped, because the keeper is
// stopped.
TEST_F(BareRig, ASilentServiceIsSaidToBeKilledOnce) {
  write_rig(std::string("[supervisor]\nsilent_s = 1\n") + kNoObserver);
  const auto rig = ready_rig();
  replace_supervisor(*rig);
  const auto pose = pid_of("pose");
  rig->signal(SIGSTOP);
  kill(pose, SIGSTOP);
  EXPECT_TRUE(
      eventually([&] { return pid_of("pose") != pose && services()["pose"]["state"] == "ready"; }));
  rig->signal(SIGCONT);
  const auto log = rig->log();
  const auto first = log.find("pose has given no sign of life");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(log.find("pose has given no sign of life", first + 1), std::string::npos) << log;
}

}  // namespace
}  // namespace handcast::supervisor
