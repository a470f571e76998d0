#include "services/projector/inputs.hpp"

namespace handcast::projector {

template <class Message>
static Result<void> drain(ipc::Reader<Message>& reader, renderer::Pipeline& pipeline) {
  for (;;) {
    const auto message = reader.next(Deadline::now());
    if (!message && message.error().code == Errc::timeout) return {};
    if (!message) return tl::make_unexpected(message.error());
    pipeline.push(now_ns(), **message);
  }
}

Result<void> Inputs::deliver(renderer::Pipeline& pipeline, Deadline image_deadline) {
  auto newest = frames_.latest(image_deadline);
  if (newest) image_ = std::move(*newest);
  if (auto drained = drain(poses_, pipeline); !drained) return drained;
  if (auto drained = drain(landmarks_, pipeline); !drained) return drained;
  if (!newest && newest.error().code != Errc::timeout) return tl::make_unexpected(newest.error());
  return {};
}

renderer::GreyView Inputs::image() const {
  if (!image_) return {};
  const msg::CameraFrame& frame = **image_;
  const auto width = static_cast<int>(frame.width_px);
  return {frame.pixels(), width, static_cast<int>(frame.height_px), width};
}

}  // namespace handcast::projector
