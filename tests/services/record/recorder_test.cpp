// SPDX-License-Identifier: Apache-2.0
#include "services/record/recorder.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/scratch.hpp"

namespace handcast::record {
namespace {

// Its threads would go on for ever.
TEST(Recorder, EndsEvenIfItsProgressCannotBeShown) {
  const test::Scratch scratch;
  auto writer = recording::RecordingWriter::create(scratch.path() / "recording", {}, {});
  ASSERT_TRUE(writer) << writer.error().what;
  Recorder recorder({}, std::move(*writer));
  const auto show = [](const Recorder::Totals&) { throw std::runtime_error("no terminal"); };
  EXPECT_THROW((void)recorder.run([] { return false; }, show), std::runtime_error);
}

}  // namespace
}  // namespace handcast::record
