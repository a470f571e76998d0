// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/x11.hpp"

#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>
#include <X11/Xatom.h>
#include <X11/Xmd.h>
#include <X11/extensions/Xrandr.h>
#include <X11/extensions/dpms.h>
#ifdef HANDCAST_WITH_XSS
#include <X11/extensions/scrnsaver.h>
#endif

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

std::optional<Blanking> blanking() {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) return std::nullopt;
  Blanking blanking;
  int interval = 0, prefer = 0, allow = 0;
  XGetScreenSaver(display, &blanking.saver_s, &interval, &prefer, &allow);
  CARD16 standby = 0, suspend = 0, off = 0, level = 0;
  BOOL enabled = False;
  int event = 0, error = 0;
  if (DPMSQueryExtension(display, &event, &error) && DPMSCapable(display) &&
      DPMSInfo(display, &level, &enabled) && enabled &&
      DPMSGetTimeouts(display, &standby, &suspend, &off))
    for (const int wait_s : {standby, suspend, off})
      if (wait_s > 0 && (blanking.power_s == 0 || wait_s < blanking.power_s))
        blanking.power_s = wait_s;
  XCloseDisplay(display);
  return blanking;
}

bool keep_awake() {
  Display* display = glfwGetX11Display();
  XResetScreenSaver(display);
#ifdef HANDCAST_WITH_XSS
  int event = 0, error = 0;
  if (XScreenSaverQueryExtension(display, &event, &error)) {
    XScreenSaverSuspend(display, True);
    XFlush(display);
    return true;
  }
#endif
  return false;
}

}  // namespace handcast::renderer::x11
