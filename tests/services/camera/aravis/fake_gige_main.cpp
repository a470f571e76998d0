// SPDX-License-Identifier: Apache-2.0
// A camera in a network namespace of its own, for cable_test.cpp: handcast_fake_gige INTERFACE
#include <sched.h>
#include <unistd.h>

#include "tests/services/camera/aravis/fake_camera.hpp"

int main(int argc, char** argv) {
  char byte = 0;
  if (argc != 2 || unshare(CLONE_NEWNET) != 0 || read(STDIN_FILENO, &byte, 1) != 1) return 1;
  const handcast::test::FakeCamera camera({}, argv[1]);
  if (!camera.is_running()) return 1;
  while (read(STDIN_FILENO, &byte, 1) == 1) {
  }
}
