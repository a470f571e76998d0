// SPDX-License-Identifier: Apache-2.0
// libhandcast-film.so.
extern "C" {
#include <libavdevice/version_major.h>
#include <libavutil/pixdesc.h>
}
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <thread>
#include <utility>

#include "renderer/media/av_handles.hpp"
#include "renderer/media/colour_film.hpp"
#include "renderer/media/orientation.hpp"

namespace {

namespace rr = handcast::renderer;
using handcast::Errc;
using handcast::Error;
using handcast::fail;
using handcast::Result;
using rr::FilmOpening;
using rr::Texture;
using Kind = FilmOpening::Kind;
using Clock = std::chrono::steady_clock;

struct Options {
  AVDictionary* entries = nullptr;
  ~Options() { av_dict_free(&entries); }
  void set(const char* name, const std::string& value) {
    av_dict_set(&entries, name, value.c_str(), 0);
  }
};

/// Red, green and blue by alpha.
void premultiply(Texture& picture) {
  const auto over_255 = [](std::uint32_t n) { return (n + 128 + ((n + 128) >> 8)) >> 8; };
  for (auto& pixel : picture.pixels()) {
    const std::uint32_t alpha = pixel >> 24;
    const auto level = [&](int shift) { return over_255((pixel >> shift & 255) * alpha) << shift; };
    pixel = alpha << 24 | level(16) | level(8) | level(0);
  }
}

/// The matrix that made luma and two differences of red, green and blue. If the film does not say
/// it, by the usual rule: BT.709 from 720 rows on, else BT.601.
const int* matrix_of(const AVFrame& frame) {
  if (frame.colorspace == AVCOL_SPC_UNSPECIFIED)
    return sws_getCoefficients(frame.height >= 720 ? SWS_CS_ITU709 : SWS_CS_ITU601);
  return sws_getCoefficients(frame.colorspace);
}

/// YUVJ formats, which are deprecated, are YUV formats of full range.
std::pair<AVPixelFormat, bool> format_and_range_of(const AVFrame& frame) {
  const bool is_full = frame.color_range == AVCOL_RANGE_JPEG;
  switch (frame.format) {
    case AV_PIX_FMT_YUVJ420P:
      return {AV_PIX_FMT_YUV420P, true};
    case AV_PIX_FMT_YUVJ422P:
      return {AV_PIX_FMT_YUV422P, true};
    case AV_PIX_FMT_YUVJ444P:
      return {AV_PIX_FMT_YUV444P, true};
    case AV_PIX_FMT_YUVJ440P:
      return {AV_PIX_FMT_YUV440P, true};
    default:
      return {static_cast<AVPixelFormat>(frame.format), is_full};
  }
}

/// FFmpeg's input for devices, loaded when it is first asked for. Null if it is not installed.
const AVInputFormat* device_format() {
  static const bool is_loaded = [] {
    const auto name = fmt::format("libavdevice.so.{}", LIBAVDEVICE_VERSION_MAJOR);
    void* library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto add = library ? ::dlsym(library, "avdevice_register_all") : nullptr;
    if (add) reinterpret_cast<void (*)()>(add)();
    return add != nullptr;
  }();
  return is_loaded ? av_find_input_format("video4linux2") : nullptr;
}

class AvColourFilm final : public rr::ColourFilm {
 public:
  AvColourFilm(FilmOpening opening, const std::atomic<bool>& is_over)
      : opening_(std::move(opening)), is_over_(is_over) {}

  Result<void> open() {
    av_log_set_level(AV_LOG_QUIET);
    if (auto opened = open_input(); !opened) return opened;
    begin_waiting();
    if (avformat_find_stream_info(format_.get(), nullptr) < 0) return no_film();
    const int stream = av_find_best_stream(format_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (stream < 0)
      return fail(Errc::bad_config, fmt::format("'{}' has no pictures", opening_.address));
    for (unsigned i = 0; i < format_->nb_streams; ++i)
      format_->streams[i]->discard = std::cmp_equal(i, stream) ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
    stream_ = format_->streams[stream];
    return open_codec();
  }

  Result<std::optional<std::int64_t>> next() override {
    for (;;) {
      const int got = avcodec_receive_frame(codec_.get(), frame_.get());
      if (got >= 0 && is_damaged()) continue;
      if (got >= 0) return time_of_frame();
      if (got == AVERROR_EOF || (got == AVERROR(EAGAIN) && is_ending_)) return std::nullopt;
      if (auto sent = send_packet(); !sent) return tl::make_unexpected(sent.error());
    }
  }

  bool read(Texture& out) override try {
    if (!frame_->data[0]) return false;
    const bool swaps = orientation_ >= 5;
    if (orientation_ == 1) return scale(out);
    Texture as_stored(swaps ? out.height() : out.width(), swaps ? out.width() : out.height());
    if (!scale(as_stored)) return false;
    out = rr::turned(std::move(as_stored), orientation_);
    return true;
  } catch (const std::exception&) {
    return false;
  }

  bool seek(std::int64_t time_ns) override {
    if (opening_.kind != Kind::file) return false;
    avcodec_flush_buffers(codec_.get());
    is_ending_ = false;
    last_ns_ = -1;
    const auto stamp =
        av_rescale_q_rnd(time_ns, {1, 1'000'000'000}, stream_->time_base, AV_ROUND_DOWN) +
        first_stamp_.value_or(0);
    return av_seek_frame(format_.get(), stream_->index, stamp, AVSEEK_FLAG_BACKWARD) >= 0;
  }

  std::int64_t period_ns() const override {
    constexpr std::int64_t kUsual_ns = 40'000'000;
    const AVRational rate = stream_->avg_frame_rate;
    return rate.num > 0 && rate.den > 0 ? av_rescale(1'000'000'000, rate.den, rate.num) : kUsual_ns;
  }
  bool is_live() const override { return format_->duration == AV_NOPTS_VALUE; }

 private:
  tl::unexpected<Error> no_film() const {
    return fail(Errc::bad_config,
                fmt::format("'{}' is no film that FFmpeg can read", opening_.address));
  }

  void begin_waiting() { deadline_ = Clock::now() + opening_.patience; }
  /// Once true, it stays so: what FFmpeg has read until then may be half a packet.
  bool is_too_late() {
    if (opening_.kind != Kind::file && Clock::now() > deadline_) was_too_late_ = true;
    return is_over_ || was_too_late_;
  }

  Result<void> open_input() {
    const AVInputFormat* format = nullptr;
    Options options;
    if (opening_.kind == Kind::device) {
      format = device_format();
      if (!format)
        return fail(Errc::bad_config,
                    "video devices cannot be captured: libavdevice is not installed; install it, "
                    "e.g. `apt install libavdevice59`");
      if (opening_.width_px > 0 && opening_.height_px > 0)
        options.set("video_size", fmt::format("{}x{}", opening_.width_px, opening_.height_px));
      if (opening_.rate_hz > 0) options.set("framerate", fmt::format("{}", opening_.rate_hz));
    } else if (opening_.kind == Kind::stream) {
      options.set("rtsp_transport", "tcp");  // without loss
      options.set("analyzeduration", "1000000");
    }
    AVFormatContext* opened = avformat_alloc_context();
    opened->interrupt_callback = {
        [](void* film) { return static_cast<AvColourFilm*>(film)->is_too_late() ? 1 : 0; }, this};
    if (opening_.kind == Kind::device) opened->flags |= AVFMT_FLAG_NONBLOCK;
    begin_waiting();
    const auto address = (opening_.kind == Kind::file ? "file:" : "") + opening_.address;
    const int error = avformat_open_input(&opened, address.c_str(), format, &options.entries);
    if (error < 0) return why_not_opened(error);
    format_.reset(opened);
    return {};
  }

  Result<void> why_not_opened(int error) const {
    const auto& address = opening_.address;
    const auto say = [&](Errc code, std::string_view what) {
      return fail(code, fmt::format("'{}' {}", address, what));
    };
    if (opening_.kind == Kind::file) return no_film();
    if (error == AVERROR(EACCES))
      return say(Errc::unavailable,
                 opening_.kind == Kind::device
                     ? "may not be opened by this user; add the user to the group 'video'"
                     : "refuses access");
    if (opening_.kind == Kind::device) {
      if (error == AVERROR(ENOENT)) return say(Errc::unavailable, "does not exist");
      if (error == AVERROR(EBUSY))
        return say(Errc::unavailable,
                   fmt::format("is used by another program; `fuser {}` shows which one", address));
      if (error == AVERROR(ENOTTY)) return say(Errc::bad_config, "is not a video device");
      if (error == AVERROR(ENODEV)) return say(Errc::unavailable, "captures no video, or is gone");
    }
    if (error == AVERROR_PROTOCOL_NOT_FOUND)
      return say(Errc::bad_config, "has a protocol that this FFmpeg does not know");
    if (error == AVERROR_EXIT || error == AVERROR(ETIMEDOUT))
      return say(Errc::unavailable, "does not answer");
    if (error == AVERROR_INVALIDDATA) return say(Errc::unavailable, "sends no film");
    char text[AV_ERROR_MAX_STRING_SIZE];
    return say(Errc::unavailable,
               fmt::format("cannot be opened: {}", av_make_error_string(text, sizeof text, error)));
  }

  Result<void> open_codec() {
    const AVCodec* decoder = avcodec_find_decoder(stream_->codecpar->codec_id);
    if (!decoder)
      return fail(Errc::bad_config,
                  fmt::format("'{}' is coded in {}, for which this FFmpeg has no decoder; convert "
                              "it, e.g. to H.264",
                              opening_.address, avcodec_get_name(stream_->codecpar->codec_id)));
    codec_.reset(avcodec_alloc_context3(decoder));
    if (avcodec_parameters_to_context(codec_.get(), stream_->codecpar) < 0) return no_film();
    codec_->pkt_timebase = stream_->time_base;
    codec_->thread_count = 2;  // the projector needs the others
    if (opening_.kind != Kind::file) codec_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    if (avcodec_open2(codec_.get(), decoder, nullptr) < 0) return no_film();
    orientation_ = rr::av::orientation_of(*stream_);
    return {};
  }

  bool is_damaged() const {
    return (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame_->decode_error_flags != 0 ||
           frame_->width <= 0 || frame_->height <= 0;
  }

  /// Gives the decoder the next packet of the stream, or tells it that there is none.
  Result<void> send_packet() {
    begin_waiting();
    for (;;) {
      av_packet_unref(packet_.get());
      const int got = av_read_frame(format_.get(), packet_.get());
      if (got >= 0 && packet_->stream_index != stream_->index) continue;
      if (got == AVERROR(EAGAIN) && !is_too_late()) {  // a device without a new frame
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        continue;
      }
      if ((got < 0 || was_too_late_) && opening_.kind != Kind::file) return why_silent(got);
      is_ending_ = got < 0;
      // A damaged packet costs its frame only.
      (void)avcodec_send_packet(codec_.get(), is_ending_ ? nullptr : packet_.get());
      return {};
    }
  }

  Result<void> why_silent(int error) {
    if (is_too_late())
      return fail(Errc::timeout,
                  fmt::format("'{}' has sent nothing for {} s", opening_.address,
                              static_cast<double>(opening_.patience.count()) / 1000));
    if (error == AVERROR(ENODEV))
      return fail(Errc::disconnected, fmt::format("'{}' was unplugged", opening_.address));
    return fail(Errc::disconnected, fmt::format("'{}' has ended", opening_.address));
  }

  /// Of frame_, since the first one. A frame without a time follows the one before.
  std::int64_t time_of_frame() {
    const auto stamp = frame_->best_effort_timestamp;
    if (stamp == AV_NOPTS_VALUE) return last_ns_ = last_ns_ < 0 ? 0 : last_ns_ + period_ns();
    if (!first_stamp_) first_stamp_ = stamp;
    return last_ns_ = av_rescale_q(stamp - *first_stamp_, stream_->time_base, {1, 1'000'000'000});
  }

  bool scale(Texture& out) {
    const auto [format, is_full] = format_and_range_of(*frame_);
    const auto* kind = av_pix_fmt_desc_get(format);
    const bool is_smaller = out.width() < frame_->width || out.height() < frame_->height;
    scaler_.reset(sws_getCachedContext(
        scaler_.release(), frame_->width, frame_->height, format, out.width(), out.height(),
        AV_PIX_FMT_RGBA, is_smaller ? SWS_AREA : SWS_BILINEAR, nullptr, nullptr, nullptr));
    if (!scaler_) return false;
    sws_setColorspaceDetails(scaler_.get(), matrix_of(*frame_), is_full ? 1 : 0,
                             sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
    std::uint8_t* const rows[4]{reinterpret_cast<std::uint8_t*>(out.row(0))};
    const int strides[4]{4 * out.width()};
    if (sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, frame_->height, rows, strides) <
        out.height())
      return false;
    if (kind && (kind->flags & AV_PIX_FMT_FLAG_ALPHA) != 0) premultiply(out);
    return true;
  }

  FilmOpening opening_;
  const std::atomic<bool>& is_over_;
  Clock::time_point deadline_;  ///< of what FFmpeg waits for
  rr::av::Format format_;
  rr::av::Codec codec_;
  AVStream* stream_ = nullptr;  ///< of format_
  rr::av::Packet packet_{av_packet_alloc()};
  rr::av::Frame frame_{av_frame_alloc()};
  rr::av::Scaler scaler_;
  int orientation_ = 1;
  std::optional<std::int64_t> first_stamp_;  ///< in the unit of the stream
  std::int64_t last_ns_ = -1;
  bool is_ending_ = false;  ///< the decoder has all packets
  bool was_too_late_ = false;
};

}  // namespace

rr::ColourFilm* handcast_open_colour_film(const FilmOpening& opening,
                                          const std::atomic<bool>& is_over, Error& error) try {
  auto film = std::make_unique<AvColourFilm>(opening, is_over);
  const auto opened = film->open();
  if (opened) return film.release();
  error = opened.error();
  return nullptr;
} catch (const std::exception& failed) {
  error = {Errc::bad_config, fmt::format("'{}': {}", opening.address, failed.what())};
  return nullptr;
}
