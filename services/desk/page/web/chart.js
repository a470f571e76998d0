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
  for (const [name, value] of marks) {
    if (value === null) continue;
    const x = Math.min(value, bins.length - 1) * step;
    context.fillRect(Math.round(x), 12, 1, floor - 12);
    context.textAlign = x > width - 60 ? 'right' : 'left';
    context.fillText(name, x + (x > width - 60 ? -4 : 4), 11);
  }
}
