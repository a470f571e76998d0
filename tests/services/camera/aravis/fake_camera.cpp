// SPDX-License-Identifier: Apache-2.0
#include "tests/services/camera/aravis/fake_camera.hpp"

#include <arv.h>

#include <fstream>
#include <utility>

namespace handcast::test {

struct FakeCamera::State {
  Fill fill;
  ArvGvFakeCamera* camera = nullptr;

  ArvFakeCamera* inner() const { return arv_gv_fake_camera_get_fake_camera(camera); }

  /// Aravis has not yet set the size of the buffer's data when it calls this.
  static void on_fill(ArvBuffer* buffer, void* state, guint32, guint32, ArvPixelFormat) {
    auto& self = *static_cast<State*>(state);
    std::size_t bytes = 0;
    const auto* data = arv_buffer_get_data(buffer, &bytes);
    self.fill(static_cast<std::uint8_t*>(const_cast<void*>(data)),
              arv_fake_camera_get_payload(self.inner()));
  }
};

void FakeCamera::offer(const std::vector<std::pair<std::string, std::uint32_t>>& formats,
                       const std::string& file) {
  auto* camera = arv_fake_camera_new("description");
  std::size_t bytes = 0;
  std::string description(arv_fake_camera_get_genicam_xml(camera, &bytes));
  g_object_unref(camera);
  const std::string list_end = "<pValue>PixelFormatRegister</pValue>";
  for (const auto& [name, value] : formats)
    description.insert(description.find(list_end),
                       "<EnumEntry Name=\"" + name + "\" NameSpace=\"Standard\"><Value>" +
                           std::to_string(value) + "</Value></EnumEntry>\n");
  std::ofstream(file) << description;
  arv_set_fake_camera_genicam_filename(file.c_str());
}

void FakeCamera::offer_the_usual() { arv_set_fake_camera_genicam_filename(nullptr); }

FakeCamera::FakeCamera(Fill fill, const std::string& interface, const std::string& serial)
    : state_(std::make_unique<State>()) {
  state_->fill = std::move(fill);
  state_->camera = arv_gv_fake_camera_new(interface.c_str(), serial.c_str());
  if (state_->fill) arv_fake_camera_set_fill_pattern(state_->inner(), State::on_fill, state_.get());
}

FakeCamera::~FakeCamera() { g_object_unref(state_->camera); }

bool FakeCamera::is_running() const { return arv_gv_fake_camera_is_running(state_->camera); }

void FakeCamera::lose(double share) {
  g_object_set(state_->camera, "gvsp-lost-ratio", share, nullptr);
}

std::uint32_t FakeCamera::read(std::uint32_t address) const {
  guint32 value = 0;
  arv_fake_camera_read_register(state_->inner(), address, &value);
  return value;
}

}  // namespace handcast::test
