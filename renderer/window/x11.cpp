// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/x11.hpp"

#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>
#include <X11/Xatom.h>
#include <X11/extensions/Xrandr.h>

namespace handcast::renderer::x11 {
namespace {

std::function<void()> reaction_to_loss;

int on_loss(Display*) {
  if (reaction_to_loss) reaction_to_loss();
  return 0;
}

}  // namespace

std::vector<std::uint8_t> edid_of(GLFWmonitor* monitor) {
  constexpr long kLongest = 64;  // in units of 4 bytes; the name is in the first 128 bytes
  Display* display = glfwGetX11Display();
  const RROutput output = glfwGetX11Monitor(monitor);
  const Atom property = XInternAtom(display, RR_PROPERTY_RANDR_EDID, True);
  if (output == None || property == None) return {};
  Atom type = None;
  int bits = 0;
  unsigned long count = 0, left = 0;
  unsigned char* data = nullptr;
  std::vector<std::uint8_t> edid;
  if (XRRGetOutputProperty(display, output, property, 0, kLongest, False, False, XA_INTEGER, &type,
                           &bits, &count, &left, &data) == Success &&
      type == XA_INTEGER && bits == 8)
    edid.assign(data, data + count);
  if (data != nullptr) XFree(data);
  return edid;
}

void when_display_is_lost(std::function<void()> reaction) {
  reaction_to_loss = std::move(reaction);
  XSetIOErrorHandler(on_loss);
}

}  // namespace handcast::renderer::x11
