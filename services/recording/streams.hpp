// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "services/recording/packed_image.hpp"

/// What a recording knows about the messages of each stream.
namespace handcast::recording {

/// The properties of a message type.
struct MessageType {
  std::string_view layout;     ///< T::layout
  std::size_t bytes = 0;       ///< sizeof(T)
  std::uint32_t channels = 0;  ///< bytes per pixel of its image; 0: it has none
  /// Its fields in the words of numpy, as JSON: [name, type] or [name, type, shape], where a type
  /// may be such a list.
  std::string fields;
};

/// The type of a message. Defined for all messages of ipc/msg.
template <class T>
const MessageType& type_of();

/// The type of the messages of a stream: "marks.camera" has StageMarks. Null for other names.
const MessageType* type_of_stream(std::string_view stream);

/// The shape of the image of a message; empty for messages without one.
/// @{
ImageShape image_of(const msg::CameraFrame& frame);
ImageShape image_of(const msg::Projection& projection);
inline ImageShape image_of(const msg::HandPoses&) { return {0, 0, 0}; }
inline ImageShape image_of(const msg::Landmarks&) { return {0, 0, 0}; }
inline ImageShape image_of(const msg::StageMarks&) { return {0, 0, 0}; }
/// @}

/// Sets the bytes that have no meaning in a message to 0: hands, vertices and marks behind the last
/// valid one. The rings carry what was there before.
/// @{
void clear_unused(msg::CameraFrame& frame);
void clear_unused(msg::HandPoses& poses);
void clear_unused(msg::Landmarks& landmarks);
void clear_unused(msg::Projection& projection);
void clear_unused(msg::StageMarks& marks);
/// @}

/// Whether the counts and sides of a message that was read are possible. Its numbers may be any.
/// @{
bool is_sound(const msg::CameraFrame& frame);
bool is_sound(const msg::HandPoses& poses);
bool is_sound(const msg::Landmarks& landmarks);
bool is_sound(const msg::Projection& projection);
bool is_sound(const msg::StageMarks& marks);
/// @}

}  // namespace handcast::recording
