// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/trace.hpp"

#include <fmt/format.h>

#include "ipc/base/clock.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::simulate {

Result<Trace> Trace::open(const std::filesystem::path& file) {
  if (auto possible = check_result_file(file); !possible)
    return tl::make_unexpected(possible.error());
  std::ofstream stream(file);
  if (!stream) return fail(Errc::bad_config, fmt::format("{}: cannot be written", file.string()));
  stream << "time_s,hand,landmark,true_x_px,true_y_px,tracker_x_px,tracker_y_px,corrected_x_px,"
            "corrected_y_px\n";
  return Trace(file, std::move(stream));
}

void Trace::add(std::int64_t display_ns, const renderer::FrameHand& hand,
                const std::array<glm::vec2, msg::kLandmarks>& truth) {
  for (std::size_t i = 0; i < truth.size(); ++i)
    stream_ << fmt::format(
        "{:.6f},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", ns_to_seconds(display_ns),
        hand.side == msg::Side::left ? "left" : "right", i, truth[i].x, truth[i].y,
        hand.tracker[i].x, hand.tracker[i].y, hand.corrected[i].x, hand.corrected[i].y);
}

Result<void> Trace::close() {
  stream_.close();
  if (!stream_)
    return fail(Errc::unavailable,
                fmt::format("{}: could not be written completely", file_.string()));
  return {};
}

}  // namespace handcast::simulate
