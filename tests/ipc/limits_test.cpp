// SPDX-License-Identifier: Apache-2.0
// Resources that the kernel may refuse. Each test runs in a child process with a resource limit.
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "tests/ipc/ring_testing.hpp"

namespace handcast::ipc {
namespace {

using namespace handcast::ipc::samples;

/// Ends the child with exit code 1 and a message unless `holds`.
void insist(bool holds, const char* what, const std::string& said) {
  if (holds) return;
  std::fprintf(stderr, "this does not hold: %s; the error is: %s\n", what, said.c_str());
  ::_exit(1);
}

template <class T>
void expect_refusal(const Result<T>& result, const char* what, std::string_view hint = "") {
  insist(!result, what, "none");
  insist(result.error().code == Errc::unavailable &&
             result.error().what.find(hint) != std::string::npos,
         what, result.error().what);
}

/// Runs `body` in a child process with a limit. The test fails if insist() fails there, or if it
/// crashes.
void with_limit(int resource, rlim_t limit, const std::function<void()>& body) {
  const auto pid = ::fork();
  if (pid == 0) {
    const rlimit both{limit, limit};
    if (::setrlimit(static_cast<__rlimit_resource>(resource), &both) != 0) ::_exit(2);
    body();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

rlim_t descriptors_in_use() { return static_cast<rlim_t>(duplicate(STDERR_FILENO).get()); }

rlim_t address_space_in_use() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * kPageBytes;
}

TEST(Limits, WithoutDescriptorsNothingIsMadeAndNobodyIsTakenForDead) {
  const auto segment = make_ring<Note>(4);
  auto for_reader = again(segment), for_writer = again(segment);
  with_limit(RLIMIT_NOFILE, descriptors_in_use(), [&] {
    expect_refusal(Segment::create(RingSpec::of<Note>("test.ring", 4, false)),
                   "a segment needs a descriptor", "memory file cannot be created");
    expect_refusal(Reader<Note>::attach(std::move(for_reader)),
                   "a reader needs the start time of its process", "start time of this process");
    const auto owner =
        RealAtomics::load(control_words_of(segment).owner(0), std::memory_order_seq_cst);
    insist(owner == 0, "no row was taken with a wrong start time", "");
  });
  with_limit(RLIMIT_NOFILE, descriptors_in_use(), [&] {
    expect_refusal(Writer<Note>::attach(std::move(for_writer)),
                   "a writer needs a descriptor for its lock", "cannot be opened for writing");
  });
  with_limit(RLIMIT_NOFILE, descriptors_in_use(), [] {
    expect_refusal(WakeBridge::start([] { return false; }), "a bridge needs a descriptor",
                   "no eventfd");
  });
}

TEST(Limits, AFileLargerThanAllowedIsAnErrorValue) {
  with_limit(RLIMIT_FSIZE, 1 << 20, [] {
    std::signal(SIGXFSZ, SIG_IGN);
    expect_refusal(Segment::create({"test.ring", 1, 1 << 20, 4, false}), "a segment needs memory",
                   "cannot be allocated");
  });
}

TEST(Limits, WithoutAddressSpaceARingIsNeitherMadeNorOpenedNorLookedAt) {
#ifdef HANDCAST_WITH_SANITIZER
  GTEST_SKIP() << "a sanitizer needs more address space than the limit allows";
#endif
  const RingSpec spec{"test.ring", 1, 4 << 20, 4, false};
  const auto segment = must(Segment::create(spec));
  auto once = duplicate(segment.fd());
  with_limit(RLIMIT_AS, address_space_in_use() + (8 << 20), [&] {
    expect_refusal(Segment::open(std::move(once)), "a mapping needs address space",
                   "cannot be mapped");
    expect_refusal(Segment::create(spec), "a mapping needs address space", "cannot be mapped");
  });
}

TEST(Limits, WithoutMemoryABufferIsNone) {
#ifdef HANDCAST_WITH_SANITIZER
  GTEST_SKIP() << "a sanitizer ends a program that allocates so much";
#endif
  BufferPool pool(std::size_t{1} << 60);
  EXPECT_EQ(pool.take(), nullptr);
}

}  // namespace
}  // namespace handcast::ipc
