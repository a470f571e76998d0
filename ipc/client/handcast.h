/* SPDX-License-Identifier: Apache-2.0 */
#ifndef HANDCAST_H
#define HANDCAST_H
#include <stdint.h>

/**
 * A rig, for any program, in any language that can call C (-lhandcast, `pkg-config handcast-c`).
 * A program reads the images of its camera and the hands of its tracker, takes the place of its
 * tracker, detector or camera (back end "external"), or draws on its hands. Times are ns of
 * CLOCK_MONOTONIC; lengths are metres.
 *
 *     handcast_rig* rig;
 *     if (handcast_rig_open("", &rig) != HANDCAST_OK) ...
 *     handcast_image image;
 *     while (handcast_wait_image(rig, &image, 1000) == HANDCAST_OK) {
 *       handcast_landmarks found = {0};
 *       found.image = image.number;
 *       found.time_ns = image.time_ns;
 *       detect(image.pixels, &found);
 *       handcast_send_landmarks(rig, &found);
 *     }
 *     handcast_rig_close(rig);
 *
 * The rig checks what it gets, counts what it leaves out and names it in its log. A program that
 * sends nothing, stops or dies is a sensor that is silent.
 *
 * Pictures for the hands are shown where the rig's content says so:
 *
 *     handcast content program: --hand left
 *
 *     handcast_content* content;
 *     if (handcast_open("", HANDCAST_LEFT, 640, 400, &content) != HANDCAST_OK) ...
 *     for (;;) {
 *       uint8_t* pixels = handcast_begin(content);
 *       if (pixels) draw(pixels);
 *       handcast_publish(content, 0);
 *     }
 *     handcast_close(content);
 *
 * Pictures are in the UV space of the hand, as `handcast template` writes it: its proportions are
 * 8 to 5, and other sizes are stretched to it. RGBA, one byte each, row 0 at the top, without
 * padding; colours are sRGB, multiplied by alpha unless handcast_set_straight() says otherwise.
 *
 * Functions return HANDCAST_OK, or an error of which handcast_error() is the sentence. No wrong use
 * of a pointer that an opening function gave, NULL included, ends the program. The program cannot
 * disturb the rig: the rig goes on without it, and its last picture stays as long as it lasts.
 *
 * Threads: a handle belongs to one thread at a time; several may be used on several threads.
 */
#ifdef __cplusplus
extern "C" {
#endif

/** Raised when a program that was compiled with an older header would no longer work. */
#define HANDCAST_ABI 1

/** A writer of pictures for one hand. */
typedef struct handcast_content handcast_content;

/** A rig whose sensors are read or taken the place of. */
typedef struct handcast_rig handcast_rig;

typedef enum handcast_result {
  HANDCAST_OK = 0,
  HANDCAST_TIMEOUT = 1,      /**< nothing came; try again */
  HANDCAST_BAD_DATA = 2,     /**< this item is unusable; go on */
  HANDCAST_DISCONNECTED = 3, /**< the rig is down or was started anew: close, and open again */
  HANDCAST_WRONG_USE = 4,    /**< an argument is wrong; the sentence says which */
  HANDCAST_UNAVAILABLE = 5   /**< no rig is up, or another program draws; try again later */
} handcast_result;

enum {
  HANDCAST_LEFT = 0,
  HANDCAST_RIGHT = 1,
  HANDCAST_JOINTS = 26,
  HANDCAST_LANDMARKS = 21,
  HANDCAST_LARGEST = 1024
};

/** A joint in the space of the tracker. Axes of its orientation as in OpenXR: +x to the right, +y
 *  out of the back of the hand, -z to the tip. */
typedef struct handcast_joint {
  float position_m[3];
  float orientation_xyzw[4]; /**< unit quaternion, from the joint to the tracker */
  float radius_m;            /**< from the joint to the skin */
} handcast_joint;

/** Both hands in one sample of the tracker. */
typedef struct handcast_both_hands {
  int64_t time_ns; /**< when the sample was taken */
  /** 1 if the tracker sees the hand; otherwise 0, and its joints are 0. Left, right. */
  int32_t is_there[2];
  /** In the order of XR_EXT_hand_tracking: palm, wrist, 4 of the thumb, 5 of each finger. */
  handcast_joint joints[2][HANDCAST_JOINTS];
} handcast_both_hands;

/** An image of the rig's camera: 8-bit grey, row 0 at the top, without padding. The pixels are
 *  valid until the next handcast_wait_image() or handcast_rig_close(). */
typedef struct handcast_image {
  const uint8_t* pixels;
  int32_t width, height;
  uint64_t number; /**< counted by the camera */
  int64_t time_ns; /**< the middle of its exposure */
  int32_t camera;  /**< of an image to be sent: 0 the first camera, 1 the second one (camera2) */
} handcast_image;

/** One landmark, px of the image as the lens forms it: x from the centre of the leftmost pixel to
 *  the right, y from that of the topmost one down. */
typedef struct handcast_point {
  float x_px, y_px;
  float confidence; /**< 0 to 1; 0: not seen */
  float sigma_px;   /**< standard deviation of x and of y; 0: unknown */
} handcast_point;

/** The landmarks of both hands in one image. */
typedef struct handcast_landmarks {
  uint64_t image;    /**< handcast_image::number */
  int64_t time_ns;   /**< handcast_image::time_ns */
  float presence[2]; /**< 0 to 1: how likely the hand is there; 0: it is not. Left, right. */
  /** In the order of MediaPipe: wrist, then thumb to little finger, each from palm to tip. */
  handcast_point points[2][HANDCAST_LANDMARKS];
  int32_t camera; /**< whose image it is: 0 the first camera, 1 the second one (landmarks2) */
} handcast_landmarks;

/** The version of the library: "0.1.0". */
const char* handcast_version(void);

/** The HANDCAST_ABI that the library was made with. */
int handcast_abi(void);

/** The time now. */
int64_t handcast_now(void);

/** The sentence of the last error on this thread; "" if there was none. Valid until the next call
 *  on it. */
const char* handcast_error(void);

/** Opens a rig that is up. `name`: its name; "" or NULL: the one that has started this program, or
 *  the only one. On an error `*rig` is NULL. */
handcast_result handcast_rig_open(const char* name, handcast_rig** rig);

/** Waits for an image of the camera, or a sample of the tracker, that is newer than the last one
 *  that was given; older ones are skipped. HANDCAST_TIMEOUT after `timeout_ms`, 0 to 10000: the
 *  result is all 0. HANDCAST_DISCONNECTED about 3 s after the rig went down. */
handcast_result handcast_wait_image(handcast_rig* rig, handcast_image* image, int timeout_ms);
handcast_result handcast_wait_hands(handcast_rig* rig, handcast_both_hands* hands, int timeout_ms);

/** Sends a sample of a tracker, the landmarks of an image, or an image, which must have the size of
 *  the camera in the calibration; does not wait. The rig uses them if the `backend` of its pose,
 *  landmarks or camera (or of landmarks2, camera2) is "external". Times must increase, be at most
 *  1 s old and at most 50 ms of the future. HANDCAST_BAD_DATA: it was not sent; the sentence says
 *  why. HANDCAST_UNAVAILABLE: another program sends. */
handcast_result handcast_send_hands(handcast_rig* rig, const handcast_both_hands* hands);
handcast_result handcast_send_landmarks(handcast_rig* rig, const handcast_landmarks* landmarks);
handcast_result handcast_send_image(handcast_rig* rig, const handcast_image* image);

/** Leaves the rig. NULL is ignored. */
void handcast_rig_close(handcast_rig* rig);

/** Opens a rig that is up, to draw on one of its hands. `rig`: its name; "" or NULL: the only one.
 *  `hand`: HANDCAST_LEFT or HANDCAST_RIGHT. Size of the pictures in pixels, 1 to HANDCAST_LARGEST.
 *  One program at a time draws on a hand. On an error `*content` is NULL. */
handcast_result handcast_open(const char* rig, int hand, int width, int height,
                              handcast_content** content);

/** The pixels of the next picture, width * height * 4 bytes in the memory that the rig reads, to be
 *  drawn in place. They are all 0 at first, and valid until handcast_publish() or
 *  handcast_close(). NULL on an error. A second call gives the same pixels. */
uint8_t* handcast_begin(handcast_content* content);

/** Shows the picture. `time_ns`: what it was drawn for, e.g. handcast_both_hands::time_ns; 0: now.
 *  An error without handcast_begin(). */
handcast_result handcast_publish(handcast_content* content, int64_t time_ns);

/** Changes the size of the next pictures. A picture that was begun is dropped. */
handcast_result handcast_size(handcast_content* content, int width, int height);

/** Whether the colours of the next pictures are not multiplied by alpha (1), or are (0), and how
 *  many ns a picture stays if none follows; 0, which is the default: until another one follows. */
handcast_result handcast_set_straight(handcast_content* content, int is_straight);
handcast_result handcast_set_lasts(handcast_content* content, int64_t lasts_ns);

/** The hands as the tracker saw them last; without waiting. HANDCAST_TIMEOUT before the first
 *  sample: `*hands` is all 0. */
handcast_result handcast_hands(handcast_content* content, handcast_both_hands* hands);

/** Waits until the tracker has a new sample, which is a good time to draw. HANDCAST_TIMEOUT after
 *  `timeout_ms`, 0 to 10000. HANDCAST_DISCONNECTED about 3 s after the rig went down. */
handcast_result handcast_wait(handcast_content* content, int timeout_ms);

/** Leaves the rig; a picture that was begun is dropped. NULL is ignored. */
void handcast_close(handcast_content* content);

#ifdef __cplusplus
}
#endif
#endif
