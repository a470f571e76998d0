/*{
  "DESCRIPTION": "Henna: a mandala on the back and in the palm, bands and leaves on the fingers, drawn line by line.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "ink", "LABEL": "Colour", "TYPE": "color", "DEFAULT": [1.0, 0.36, 0.06, 1.0]},
    {"NAME": "seconds", "LABEL": "Seconds to draw it", "TYPE": "float", "DEFAULT": 8.0, "MIN": 1.0, "MAX": 120.0},
    {"NAME": "rest", "LABEL": "Seconds it stays", "TYPE": "float", "DEFAULT": 12.0, "MIN": 0.0, "MAX": 120.0},
    {"NAME": "petals", "LABEL": "Petals", "TYPE": "long", "VALUES": [8, 10, 12, 16], "LABELS": ["8", "10", "12", "16"], "DEFAULT": 12}
  ],
  "PASSES": [{"TARGET": "drawing", "ONCE": true}, {}]
}*/
// drawing: r: ink; g: when it is drawn, 0..1; b: fine ornament; a: 1 on the hand.

const float kPi = 3.14159265;

// A line of a width at a distance, mm, with an edge of half a texel.
float line(float distance_mm, float width) { return 1.0 - smoothstep(0.5 * width - 0.25, 0.5 * width + 0.3, abs(distance_mm)); }
float disc(float distance_mm, float radius) { return 1.0 - smoothstep(radius - 0.3, radius + 0.3, distance_mm); }

// Distance to the outline of a petal that points along y from `base` to `tip`, half width w.
float petal(vec2 p, float base, float tip, float w) {
  float t = clamp((p.y - base) / (tip - base), 0.0, 1.0);
  float outline = w * pow(sin(kPi * pow(t, 0.8)), 0.8);
  float over = max(base - p.y, p.y - tip);
  return max(abs(p.x) - outline, over);
}

// The place in one of n equal sectors about a centre, its middle along y.
vec2 sector(vec2 p, float n, float turn) {
  float a = atan(p.x, p.y) + turn, step = 2.0 * kPi / n;
  a = a - step * floor(a / step + 0.5);
  return length(p) * vec2(sin(a), cos(a));
}

// x: ink, y: when.
vec2 mandala(vec2 p, float n) {
  float r = length(p), angle = atan(p.x, p.y) / (2.0 * kPi) + 0.5;
  float half_turn = kPi / n;
  vec2 a = sector(p, n, 0.0), b = sector(p, n, half_turn), few = sector(p, 8.0, 0.0);
  float ink = disc(r, 1.8);
  ink = max(ink, line(petal(few, 2.6, 8.2, 1.9), 0.9));
  ink = max(ink, line(r - 9.6, 1.0));
  float d = petal(a, 10.2, 18.5, 2.6 * 12.0 / n);
  ink = max(ink, line(d, 1.0));
  ink = max(ink, disc(length(a - vec2(0.0, 14.0)), 0.9));
  ink = max(ink, disc(length(b - vec2(0.0, 18.0)), 0.85));
  ink = max(ink, line(r - 20.4, 0.9));
  ink = max(ink, line(r - 22.4, 0.9));
  float big = petal(b, 22.8, 32.5, 4.6 * 12.0 / n);
  ink = max(ink, line(big, 1.1));
  ink = max(ink, big < -0.8 ? line(petal(b, 24.0, 29.8, 2.3 * 12.0 / n), 0.8) : 0.0);
  ink = max(ink, disc(length(b - vec2(0.0, 34.6)), 0.95));
  ink = max(ink, disc(length(a - vec2(0.0, 30.6)), 0.8));
  float ring = r < 9.0 ? 0.0 : r < 19.4 ? 1.0 : r < 22.6 ? 2.0 : 3.0;
  return vec2(ink, (ring + angle) / 4.0);
}

// An ornament along a finger: s along it from the knuckle, d across, of `length_mm` to the tip.
float finger(float s, float d, float length_mm, float half_width) {
  float ink = 0.0;
  float x = abs(d);
  // The tip is dipped, its border scalloped.
  float dip = length_mm - 15.0 + 1.6 * abs(sin(kPi * d / 5.2));
  ink = max(ink, smoothstep(dip - 0.3, dip + 0.3, s) * (1.0 - line(s - dip - 2.6, 0.9)));
  ink = max(ink, line(s - dip + 2.4, 0.8));
  // Bands with lozenges below it.
  float band = s - (length_mm - 31.0);
  ink = max(ink, max(line(band - 7.0, 0.9), line(band + 1.0, 0.9)));
  float column = d / 5.0, lozenge = abs(column - floor(column) - 0.5) * 5.0 + abs(band - 3.0);
  ink = max(ink, max(line(lozenge - 2.4, 0.8), disc(lozenge, 0.9)));
  // A vine with leaves from the knuckle to the bands.
  float top = length_mm - 34.0;
  if (s < top && s > 2.0) {
    float sway = 1.5 * sin(2.0 * kPi * s / 16.0);
    ink = max(ink, line(d - sway, 0.9));
    float k = s / 8.0, i = floor(k), way = mod(i, 2.0) < 0.5 ? 1.0 : -1.0;
    vec2 leaf = vec2(s - 8.0 * i - 1.0, way * (d - 1.5 * sin(2.0 * kPi * (8.0 * i + 4.0) / 16.0)));
    leaf = vec2(0.6 * leaf.x - 0.8 * leaf.y, 0.8 * leaf.x + 0.6 * leaf.y).yx;
    float shape = petal(leaf.yx, 0.6, 7.2, 1.5);
    ink = max(ink, disc(shape, 0.0) * (x < half_width ? 1.0 : 0.0));
  }
  return ink;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    vec3 middle = 0.25 * (hand_rest_joint[12] + hand_rest_joint[17] + hand_rest_joint[11] + hand_rest_joint[16]);
    middle.x = hand_rest_joint[0].x * 0.4;
    vec2 drawn = mandala((p.xz - middle.xz - vec2(0.0, -2.0)) * vec2(1.0, -1.0), float(petals));
    float r = length(p.xz - middle.xz - vec2(0.0, -2.0));
    if (r > 35.8) drawn.x = 0.0;
    float wrist = p.z - 6.0;
    drawn = wrist > -9.0 ? vec2(0.0, 0.0) : drawn;
    // The wrist: a bracelet of scallops between lines.
    if (p.z > -6.0) {
      float u = p.x / 7.0, c = (u - floor(u) - 0.5) * 7.0;
      float ink = max(line(p.z - 3.0, 1.1), line(p.z - 14.0, 1.1));
      ink = max(ink, line(p.z - 16.5, 0.7));
      ink = max(ink, line(length(vec2(c, p.z - 3.0)) - 3.5, 0.9) * step(p.z, 3.0));
      ink = max(ink, disc(length(vec2(c, p.z - 1.6)), 0.8) * step(p.z, 3.0));
      ink = max(ink, line(abs(c) * 1.1 + abs(p.z - 8.5) - 3.6, 0.9));
      ink = max(ink, disc(length(vec2(c, p.z - 8.5)), 1.1));
      ink = max(ink, disc(length(vec2(abs(c) - 3.5, p.z - 18.6)), 0.8));
      drawn = vec2(ink, clamp(0.5 + p.x / 60.0, 0.0, 1.0));
    }
    // The fingers.
    int joint = int(near.x + 0.5), base = joint < 6 ? 3 : 7 + 5 * ((joint - 6) / 5);
    int last = joint < 6 ? 5 : base + 3;
    if (joint >= 3 && joint != 6 && joint != 11 && joint != 16 && joint != 21 && r > 33.0) {
      vec3 a = hand_rest_joint[base], along = hand_rest_joint[last] - a;
      float length_mm = length(along) + 5.0;
      along = normalize(along);
      vec3 up = joint < 6 ? normalize(vec3(hand_side == 0 ? 0.65 : -0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
      float s = dot(p - a, along), d = dot(p - a, normalize(cross(along, up)));
      float ink = finger(s - 12.0, d, length_mm - 12.0, 7.5);
      if (s > 12.0 || drawn.x < ink) drawn = vec2(ink, clamp(s / length_mm, 0.0, 1.0));
    }
    gl_FragColor = vec4(drawn.x, drawn.y, 0.0, 1.0);
    return;
  }
  vec4 it = texelFetch(drawing, texel, 0);
  float circle = seconds + rest + 3.0, now = mod(TIME, circle);
  float drawn = now / seconds * 1.15, leave = 1.0 - smoothstep(circle - 3.0, circle - 0.5, now);
  float since = drawn - it.g;
  float shown = smoothstep(0.0, 0.02, since);
  float wet = exp(-max(since, 0.0) * 14.0) * shown;
  float gleam = pow(0.5 + 0.5 * sin(1.3 * TIME - 9.0 * isf_FragNormCoord.y + 5.0 * isf_FragNormCoord.x), 8.0);
  vec3 gold = vec3(1.0, 0.78, 0.35);
  vec3 light = mix(ink.rgb * 0.92, gold, clamp(1.2 * wet + 0.55 * gleam, 0.0, 1.0));
  gl_FragColor = vec4(light * it.r * shown * leave, 1.0);
}
