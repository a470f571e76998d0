// SPDX-License-Identifier: Apache-2.0
#pragma once
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>

/// Of libhandcast-film.so: what FFmpeg allocates, owned.
namespace handcast::renderer::av {

template <auto free>
struct Freeing {
  template <class T>
  void operator()(T* owned) const {
    if constexpr (requires { free(&owned); })
      free(&owned);
    else
      free(owned);
  }
};
using Format = std::unique_ptr<AVFormatContext, Freeing<avformat_close_input>>;
using Codec = std::unique_ptr<AVCodecContext, Freeing<avcodec_free_context>>;
using Packet = std::unique_ptr<AVPacket, Freeing<av_packet_free>>;
using Frame = std::unique_ptr<AVFrame, Freeing<av_frame_free>>;
using Scaler = std::unique_ptr<SwsContext, Freeing<sws_freeContext>>;

/// The orientation 1..8 that a stream asks for by a matrix of 16.16 numbers.
inline int orientation_of(const AVStream& stream) {
  std::size_t bytes = 0;
  const auto* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &bytes);
  std::int32_t m[9];
  if (!data || bytes < sizeof m) return 1;
  std::memcpy(m, data, sizeof m);
  const bool right = m[0] > 0, down = m[4] > 0, down_by_x = m[1] > 0, right_by_y = m[3] > 0;
  if (std::abs(m[0]) > std::abs(m[1])) return right ? (down ? 1 : 4) : (down ? 2 : 3);
  return down_by_x ? (right_by_y ? 5 : 6) : (right_by_y ? 8 : 7);
}

}  // namespace handcast::renderer::av
