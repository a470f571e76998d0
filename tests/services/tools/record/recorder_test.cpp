// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/recorder.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/scratch.hpp"

namespace handcast::record {
namespace {

/// A ring in which nothing is published; its thread ends with the recording.
class SilentFeed : public Feed {
 public:
  SilentFeed() : Feed(true, {}) {}
  Result<void> read(MessageQueue&, Deadline) override {
    sleep_until_ns(now_ns() + 1'000'000);
    return {};
  }
};

// Its threads, one for each ring and one that writes, would go on for ever.
TEST(Recorder, EndsEvenIfItsProgressCannotBeShown) {
  const test::Scratch scratch;
  auto writer = recording::RecordingWriter::create(scratch.path() / "recording", {}, {});
  ASSERT_TRUE(writer) << writer.error().what;
  std::vector<std::unique_ptr<Feed>> feeds;
  feeds.push_back(std::make_unique<SilentFeed>());
  Recorder recorder(std::move(feeds), std::move(*writer));
  const auto show = [](const Recorder::Totals&) { throw std::runtime_error("no terminal"); };
  EXPECT_THROW((void)recorder.run([] { return false; }, show), std::runtime_error);
}

}  // namespace
}  // namespace handcast::record
