// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// What libhandcast-film.so offers: films, read by OpenCV. It is loaded when a film is played,
/// because OpenCV's videoio loads a hundred other libraries, which would delay every start of a
/// camera service by about 0.1 s.

extern "C" {

/// A film that is open. One thread at a time.
struct handcast_film;

/// What a film says about itself.
struct handcast_film_about {
  int width_px, height_px;
  long frames;     ///< number of frames; 0 or less: unknown
  double rate_hz;  ///< frames per second; 0 or less: unknown
};

/// Opens a film. Returns null if it is none.
handcast_film* handcast_film_open(const char* file, handcast_film_about* about);
/// Reads frame `index` as grey values, width_px * height_px of them. Returns 0 if it cannot be
/// read.
int handcast_film_read(handcast_film* film, long index, unsigned char* grey);
/// Closes it.
void handcast_film_close(handcast_film* film);
}
