// SPDX-License-Identifier: Apache-2.0
#include "services/watch/black_box.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>

#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/recording/about.hpp"

namespace handcast::watch {

namespace fs = std::filesystem;

BlackBoxes::BlackBoxes(fs::path folder, int most, config::Rig rig, std::string calibration)
    : folder_(std::move(folder)),
      most_(most),
      rig_(std::move(rig)),
      calibration_(std::move(calibration)) {
  rig_.watch = {};  // whoever plays a box alarms nobody; and a command may hold a password
  rig_.calibration = calibration_.empty() ? "" : recording::kCalibrationFile;
}

void BlackBoxes::write(const std::string& name, BoxContents contents) {
  if (thread_.joinable()) thread_.join();
  thread_ = std::jthread([this, name, contents = std::move(contents)] {
    if (::nice(10) == -1) log::debug("the priority of a thread cannot be lowered");
    if (const auto written = write_now(name, contents); !written)
      log::warning("no black box: {}", written.error().what);
    else
      log::info("black box: {}", place_of(name).string());
    remove_old();
  });
}

Result<void> BlackBoxes::write_now(const std::string& name, const BoxContents& contents) const {
  std::vector<std::string> streams;
  streams.reserve(contents.streams.size());
  for (const auto& [stream, kept] : contents.streams) streams.push_back(stream);
  auto writer = recording::RecordingWriter::create(
      place_of(name), {rig_.name, config::print_rig(rig_), calibration_, {}}, streams);
  if (!writer) return tl::make_unexpected(writer.error());
  for (std::size_t i = 0; i < streams.size(); ++i)
    if (auto done = contents.streams[i].second->write(*writer, i); !done) return done;
  for (const auto& [file, text] :
       {std::pair("fault.txt", contents.fault + "\n"), std::pair("changes.txt", contents.changes)})
    if (auto done = write_whole(place_of(name) / file, text, Durable::no); !done) return done;
  return writer->finish(contents.fault, std::vector<std::uint64_t>(streams.size()));
}

void BlackBoxes::remove_old() const {
  std::vector<fs::path> boxes;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder_, absent))
    if (recording::is_recording(entry.path())) boxes.push_back(entry.path());
  std::ranges::sort(boxes);  // their names begin with the time
  for (std::size_t i = 0; i + static_cast<std::size_t>(most_) < boxes.size(); ++i)
    fs::remove_all(boxes[i], absent);
}

}  // namespace handcast::watch
