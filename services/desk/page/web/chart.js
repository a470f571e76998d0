// SPDX-License-Identifier: Apache-2.0
// A histogram on a canvas.

/** Makes a canvas as sharp as the screen; returns its context, and its size in CSS px. */
export function sharp(canvas) {
  const width = canvas.clientWidth, height = canvas.clientHeight, scale = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const context = canvas.getContext('2d');
  context.setTransform(scale, 0, 0, scale, 0, 0);
  return {context, width, height};
}

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Draws counts by bins of 1 ms, of which the last one holds all that is more, and marks values. */
export function drawHistogram(canvas, bins, marks) {
  const {context, width, height} = sharp(canvas);
  if (width === 0) return;
  const floor = height - 18, most = Math.max(1, ...bins), step = width / bins.length;
  context.clearRect(0, 0, width, height);
  context.fillStyle = colour('--line');
  context.fillRect(0, floor, width, 1);
  context.fillStyle = colour('--accent');
  bins.forEach((count, i) => {
    if (count === 0) return;
    const high = Math.max(1.5, (floor - 16) * count / most);
    context.fillRect(i * step + 0.5, floor - high, Math.max(1, step - 1), high);
  });
  context.font = '11px system-ui, sans-serif';
  context.fillStyle = colour('--dim');
  for (let ms = 0; ms < bins.length; ms += 10) {
    context.textAlign = ms === 0 ? 'left' : 'center';
    context.fillText(ms === 0 ? '0 ms' : String(ms), ms * step, height - 4);
  }
  // The smaller one is named at its left, the larger one at its right.
  marks.forEach(([name, value], i) => {
    if (value === null) return;
    const x = Math.min(value, bins.length - 1) * step, isLeft = i === 0 ? x > 40 : x > width - 40;
    context.fillRect(Math.round(x), 2, 1, floor - 2);
    context.textAlign = isLeft ? 'right' : 'left';
    context.fillText(name, x + (isLeft ? -5 : 5), 11);
  });
}
