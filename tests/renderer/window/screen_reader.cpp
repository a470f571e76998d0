// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/window/screen_reader.hpp"

#include <X11/Xatom.h>
#include <X11/Xutil.h>
#include <X11/extensions/Xrandr.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>

namespace handcast::test {
namespace {

struct Close {
  void operator()(Display* display) const { XCloseDisplay(display); }
};
using Connection = std::unique_ptr<Display, Close>;

Connection connect() { return Connection(XOpenDisplay(nullptr)); }

}  // namespace

std::uint32_t pixel(int x, int y) {
  const auto display = connect();
  XImage* image =
      XGetImage(display.get(), DefaultRootWindow(display.get()), x, y, 1, 1, AllPlanes, ZPixmap);
  if (image == nullptr) return 0;
  const auto rgb = static_cast<std::uint32_t>(XGetPixel(image, 0, 0));
  XDestroyImage(image);
  return 0xff000000u | (rgb & 0xff) << 16 | (rgb & 0xff00) | (rgb >> 16 & 0xff);
}

void paint_the_desktop(unsigned long rgb) {
  const auto display = connect();
  XSetWindowBackground(display.get(), DefaultRootWindow(display.get()), rgb);
  XClearWindow(display.get(), DefaultRootWindow(display.get()));
  XSync(display.get(), False);
}

void set_edid_name(std::string_view output, std::string_view name) {
  std::array<unsigned char, 128> edid{0, 255, 255, 255, 255, 255, 255, 0};
  edid[54 + 3] = 0xFC;
  std::ranges::copy(name, edid.begin() + 54 + 5);
  edid[54 + 5 + name.size()] = '\n';
  edid[127] = static_cast<unsigned char>(256 - std::accumulate(edid.begin(), edid.end(), 0) % 256);

  const auto display = connect();
  auto* resources = XRRGetScreenResourcesCurrent(display.get(), DefaultRootWindow(display.get()));
  const Atom property = XInternAtom(display.get(), RR_PROPERTY_RANDR_EDID, False);
  for (int i = 0; i < resources->noutput; ++i) {
    auto* info = XRRGetOutputInfo(display.get(), resources, resources->outputs[i]);
    if (output == info->name)
      XRRChangeOutputProperty(display.get(), resources->outputs[i], property, XA_INTEGER, 8,
                              PropModeReplace, edid.data(), edid.size());
    XRRFreeOutputInfo(info);
  }
  XRRFreeScreenResources(resources);
  XSync(display.get(), False);
}

}  // namespace handcast::test
