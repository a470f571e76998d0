// SPDX-License-Identifier: Apache-2.0
// libhandcast-film.so.
extern "C" {
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "renderer/media/av_handles.hpp"
#include "renderer/media/film_reader.hpp"
#include "renderer/media/orientation.hpp"

namespace {

namespace av = handcast::renderer::av;
using handcast::renderer::Image;

/// Frames up to so far ahead are passed over; others are searched for.
constexpr std::int64_t kNear = 50;

class AvFilm final : public handcast::renderer::FilmReader {
 public:
  bool open(const char* file) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* opened = nullptr;
    if (avformat_open_input(&opened, file, nullptr, nullptr) < 0) return false;
    format_.reset(opened);
    if (avformat_find_stream_info(opened, nullptr) < 0) return false;
    const AVCodec* decoder = nullptr;
    const int stream = av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (stream < 0 || !decoder) return false;
    for (unsigned i = 0; i < opened->nb_streams; ++i)
      opened->streams[i]->discard = std::cmp_equal(i, stream) ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
    stream_ = opened->streams[stream];
    codec_.reset(avcodec_alloc_context3(decoder));
    if (avcodec_parameters_to_context(codec_.get(), stream_->codecpar) < 0) return false;
    codec_->pkt_timebase = stream_->time_base;
    codec_->thread_count = 0;  // as many as there are cores
    if (avcodec_open2(codec_.get(), decoder, nullptr) < 0) return false;
    orientation_ = av::orientation_of(*stream_);
    return codec_->width > 0 && codec_->height > 0 && read_times();
  }

  int width_px() const override { return orientation_ < 5 ? codec_->width : codec_->height; }
  int height_px() const override { return orientation_ < 5 ? codec_->height : codec_->width; }
  const std::vector<std::int64_t>& times_ns() const override { return times_ns_; }

  bool read(std::int64_t index, std::uint8_t* grey) override try {
    if (index < 0 || index >= std::ssize(stamps_) || !go_to(index)) return false;
    if (frame_->width != codec_->width || frame_->height != codec_->height) return false;
    const auto image = turned(grey_of(*frame_), orientation_);
    std::ranges::copy(image.pixels(), grey);
    return image.pixels().size() > 0;
  } catch (const std::exception&) {
    return false;
  }

 private:
  /// The next packet of the film. False at its end.
  bool next_packet() {
    do av_packet_unref(packet_.get());
    while (av_read_frame(format_.get(), packet_.get()) >= 0 &&
           packet_->stream_index != stream_->index);
    return packet_->data != nullptr;
  }
  bool rewind(std::int64_t stamp) {
    avcodec_flush_buffers(codec_.get());
    is_ending_ = false;
    return av_seek_frame(format_.get(), stream_->index, stamp, AVSEEK_FLAG_BACKWARD) >= 0;
  }

  /// Reads the times of all frames, without decoding them.
  bool read_times() {
    while (next_packet()) {
      if (packet_->flags & AV_PKT_FLAG_DISCARD) continue;  // before the beginning of the film
      const auto stamp = packet_->pts != AV_NOPTS_VALUE ? packet_->pts : packet_->dts;
      if (stamp != AV_NOPTS_VALUE) stamps_.push_back(stamp);
    }
    std::ranges::sort(stamps_);  // packets are in the order of decoding
    const auto again = std::unique(stamps_.begin(), stamps_.end());  // the second halves of frames
    stamps_.erase(again, stamps_.end());
    for (const auto stamp : stamps_)
      times_ns_.push_back(
          av_rescale_q(stamp - stamps_.front(), stream_->time_base, {1, 1'000'000'000}));
    return stamps_.empty() || rewind(stamps_.front());
  }

  /// Decodes the next frame in the order in which they are shown.
  bool next_frame() {
    for (;;) {
      const int got = avcodec_receive_frame(codec_.get(), frame_.get());
      if (got >= 0) return true;
      if (got != AVERROR(EAGAIN) || is_ending_) return false;
      is_ending_ = !next_packet();
      // A damaged packet costs its frame only.
      (void)avcodec_send_packet(codec_.get(), is_ending_ ? nullptr : packet_.get());
    }
  }
  /// Puts the frame of this index into frame_.
  bool go_to(std::int64_t index) {
    const auto wanted = stamps_[static_cast<std::size_t>(index)];
    if (frame_->data[0] && frame_->best_effort_timestamp == wanted) {
      next_ = index + 1;
      return true;
    }
    if ((index < next_ || index > next_ + kNear) && !rewind(wanted)) return false;
    for (next_ = index + 1; next_frame();)
      if (frame_->best_effort_timestamp >= wanted) return frame_->best_effort_timestamp == wanted;
    next_ = std::ssize(stamps_) + 1;  // nothing more comes: search next time
    return false;
  }

  /// The luma of a frame, over black if it has an alpha channel.
  Image<std::uint8_t> grey_of(const AVFrame& frame) {
    const auto format = static_cast<AVPixelFormat>(frame.format);
    const auto* kind = av_pix_fmt_desc_get(format);
    const bool has_alpha = kind && (kind->flags & AV_PIX_FMT_FLAG_ALPHA) != 0;
    scaler_.reset(sws_getCachedContext(
        scaler_.release(), frame.width, frame.height, format, frame.width, frame.height,
        has_alpha ? AV_PIX_FMT_YA8 : AV_PIX_FMT_GRAY8, SWS_POINT, nullptr, nullptr, nullptr));
    if (!scaler_) return {};
    const auto* bt601 = sws_getCoefficients(SWS_CS_ITU601);
    const bool is_full = frame.color_range == AVCOL_RANGE_JPEG;
    sws_setColorspaceDetails(scaler_.get(), bt601, is_full, bt601, 1, 0, 1 << 16, 1 << 16);
    Image<std::uint8_t> out(frame.width * (has_alpha ? 2 : 1), frame.height);
    std::uint8_t* const rows[4]{out.row(0)};
    const int strides[4]{out.width()};
    sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, rows, strides);
    if (!has_alpha) return out;
    Image<std::uint8_t> grey(frame.width, frame.height);
    for (std::size_t i = 0; i < grey.pixels().size(); ++i)
      grey.pixels()[i] =
          static_cast<std::uint8_t>((out.pixels()[2 * i] * out.pixels()[2 * i + 1] + 127) / 255);
    return grey;
  }

  av::Format format_;
  av::Codec codec_;
  AVStream* stream_ = nullptr;  ///< of format_
  av::Packet packet_{av_packet_alloc()};
  av::Frame frame_{av_frame_alloc()};
  av::Scaler scaler_;
  int orientation_ = 1;
  std::vector<std::int64_t> stamps_;    ///< of all frames, in the unit of the stream
  std::vector<std::int64_t> times_ns_;  ///< since the first
  std::int64_t next_ = 0;               ///< the frame that comes next
  bool is_ending_ = false;              ///< the decoder has all packets
};

}  // namespace

handcast::renderer::FilmReader* handcast_open_film(const char* file) try {
  auto film = std::make_unique<AvFilm>();
  return film->open(file) ? film.release() : nullptr;
} catch (const std::exception&) {
  return nullptr;
}
