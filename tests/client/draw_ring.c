/* SPDX-License-Identifier: Apache-2.0
 * Draws a ring that grows and shrinks on the left hand of a rig, one picture for each sample of the
 * tracker, and prints which hands it sees.
 *   draw_ring PICTURES [RIG] */
#include <handcast.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 200 };

static int complain(void) {
  fprintf(stderr, "draw_ring: %s\n", handcast_error());
  return 1;
}

static void draw(uint8_t* pixels, int number) {
  const double radius = 60 + 30 * sin(0.1 * number);
  for (int y = 0; y < HEIGHT; ++y)
    for (int x = 0; x < WIDTH; ++x) {
      const double away = fabs(hypot(x - WIDTH / 2.0, y - HEIGHT / 2.0) - radius);
      if (away < 8)
        for (int k = 0; k < 4; ++k) pixels[4 * (y * WIDTH + x) + k] = k == 2 ? 64 : 255;
    }
}

int main(int argc, char** argv) {
  const int pictures = argc > 1 ? atoi(argv[1]) : 100;
  handcast_content* content = NULL;
  if (handcast_open(argc > 2 ? argv[2] : "", HANDCAST_LEFT, WIDTH, HEIGHT, &content) != HANDCAST_OK)
    return complain();
  for (int number = 0; number < pictures; ++number) {
    const handcast_result waited = handcast_wait(content, 1000);
    if (waited != HANDCAST_OK && waited != HANDCAST_TIMEOUT) return complain();
    handcast_both_hands hands;
    handcast_hands(content, &hands);
    uint8_t* pixels = handcast_begin(content);
    if (!pixels) continue; /* the rig still reads the last ones */
    draw(pixels, number);
    if (handcast_publish(content, hands.time_ns) != HANDCAST_OK) return complain();
    printf("picture %d: left %d right %d\n", number, hands.is_there[0], hands.is_there[1]);
    fflush(stdout);
  }
  handcast_close(content);
  return 0;
}
