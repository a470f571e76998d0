// SPDX-License-Identifier: Apache-2.0
// The live picture: a stream of packets, each a JSON text and three JPEG files (see picture_feed.hpp).

import {$, setText} from '/dom.js';
import {sharp} from '/chart.js';

const kMostBytes = 8 << 20;        // of what has not been shown yet
const kLandmarksLast_ms = 300;
// The bones of a hand between the 26 joints of OpenXR, and between MediaPipe's 21 landmarks.
const kJointBones = [[1, 2], [2, 3], [3, 4], [4, 5], [1, 6], [6, 7], [7, 8], [8, 9], [9, 10], [1, 11], [11, 12], [12, 13], [13, 14],
  [14, 15], [1, 16], [16, 17], [17, 18], [18, 19], [19, 20], [1, 21], [21, 22], [22, 23], [23, 24], [24, 25]];

/** Takes packets out of the bytes that come, whole ones only. */
class Packets {
  constructor() { this.bytes = new Uint8Array(0); }

  add(chunk) {
    const all = new Uint8Array(this.bytes.length + chunk.length);
    all.set(this.bytes);
    all.set(chunk, this.bytes.length);
    this.bytes = all;
    if (all.length > kMostBytes) throw new Error('the stream makes no sense');
  }

  next() {
    const view = new DataView(this.bytes.buffer, this.bytes.byteOffset, this.bytes.length);
    const parts = [];
    let at = 0;
    for (let i = 0; i < 4; ++i) {
      if (at + 4 > this.bytes.length) return null;
      const size = view.getUint32(at, true);
      if (at + 4 + size > this.bytes.length) return null;
      parts.push(this.bytes.subarray(at + 4, at + 4 + size));
      at += 4 + size;
    }
    this.bytes = this.bytes.slice(at);
    return parts;
  }
}

const decode = (bytes) => createImageBitmap(new Blob([bytes], {type: 'image/jpeg'}));

function drawPoints(context, places, scale, bones, colour, radius) {
  context.strokeStyle = colour;
  context.fillStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const [a, b] of bones) {
    if (places[2 * a] === null || places[2 * b] === null) continue;
    context.moveTo(places[2 * a] * scale, places[2 * a + 1] * scale);
    context.lineTo(places[2 * b] * scale, places[2 * b + 1] * scale);
  }
  context.stroke();
  for (let i = 0; i + 1 < places.length; i += 2) {
    if (places[i] === null) continue;
    context.beginPath();
    context.arc(places[i] * scale, places[i + 1] * scale, radius, 0, 7);
    context.fill();
  }
}

export class Picture {
  constructor() {
    this.stop = null;
    this.times = [];
    this.landmarks = {places: {}, when: 0};
    this.isVisible = false;
    new IntersectionObserver(([entry]) => { this.isVisible = entry.isIntersecting; this.update(); }).observe($('picture'));
    document.addEventListener('visibilitychange', () => this.update());
  }

  /** Reads the stream only while somebody can see it. */
  update() {
    const isWanted = this.isVisible && !document.hidden;
    if (isWanted && !this.stop) this.run();
    if (!isWanted && this.stop) this.stop.abort();
  }

  async run() {
    const stop = this.stop = new AbortController();
    try {
      const answer = await fetch('/api/picture', {signal: stop.signal, cache: 'no-store'});
      if (!answer.ok) throw new Error((await answer.json()).error);
      await this.read(answer.body.getReader());
    } catch (error) {
      if (!stop.signal.aborted) setText($('picture-text'), error.message || 'no picture');
    }
    this.stop = null;
    setTimeout(() => this.update(), 1000);
  }

  async read(reader) {
    const packets = new Packets();
    for (;;) {
      const {done, value} = await reader.read();
      if (done) return;
      packets.add(value);
      let newest = null;
      for (let packet = packets.next(); packet; packet = packets.next()) newest = packet;
      if (newest) await this.show(newest);
    }
  }

  async show([head, camera, light, light2]) {
    if (head.length === 0) {
      setText($('picture-text'), 'no new images');
      return;
    }
    const about = JSON.parse(new TextDecoder().decode(head));
    if (about.landmarks) this.landmarks = {places: about.landmarks, when: performance.now()};
    if (camera.length > 0) this.drawCamera(await decode(camera), about);
    if (about.light) this.drawLight($('light'), light.length > 0 ? await decode(light) : null, about.light);
    if (about.light2) {
      $('second-light').hidden = false;
      this.drawLight($('light2'), light2.length > 0 ? await decode(light2) : null, about.light2);
    }
    this.tellRate(about);
  }

  drawCamera(image, about) {
    const canvas = $('camera');
    canvas.style.aspectRatio = `${about.camera.width} / ${about.camera.height}`;
    const {context, width, height} = sharp(canvas);
    context.drawImage(image, 0, 0, width, height);
    image.close();
    const scale = width / about.camera.width;
    if ($('show-landmarks').checked && performance.now() - this.landmarks.when < kLandmarksLast_ms)
      for (const places of Object.values(this.landmarks.places)) drawPoints(context, places, scale, [], '#ffffff', 1.6);
    if ($('show-joints').checked)
      for (const places of Object.values(about.joints)) drawPoints(context, places, scale, kJointBones, '#f2a33c', 2);
  }

  drawLight(canvas, image, light) {
    canvas.style.aspectRatio = `${light.width} / ${light.height}`;
    const {context, width, height} = sharp(canvas);
    const scale = width / light.width;
    context.clearRect(0, 0, width, height);
    if (!image) return;
    context.drawImage(image, light.x * scale, light.y * scale, light.w * scale, light.h * scale);
    image.close();
  }

  tellRate(about) {
    const now = performance.now();
    this.times.push(now);
    if (this.times.length > 32) this.times.shift();
    if (!about.camera || this.times.length < 8 || this.times.length % 8) return;
    const hz = 1000 * (this.times.length - 1) / (now - this.times[0]);
    if (this.toldAt && now - this.toldAt < 500) return;
    this.toldAt = now;
    setText($('picture-text'), `${hz.toFixed(0)} Hz · ${about.camera.age_ms} ms old`);
  }
}
