/*{
  "DESCRIPTION": "A clock: the hours on a dial on the hand, the seconds run along the fingers, twelve on each.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "dial", "LABEL": "Dial", "TYPE": "color", "DEFAULT": [1.0, 0.80, 0.48, 1.0]},
    {"NAME": "point", "LABEL": "Seconds", "TYPE": "color", "DEFAULT": [0.20, 0.85, 1.0, 1.0]},
    {"NAME": "shift", "LABEL": "Hours ahead of local time", "TYPE": "float", "DEFAULT": 0.0, "MIN": -12.0, "MAX": 14.0},
    {"NAME": "sweeps", "LABEL": "Seconds sweep", "TYPE": "bool", "DEFAULT": true}
  ],
  "PASSES": [{"TARGET": "face", "ONCE": true, "FLOAT": true}, {}]
}*/
// face: rg: place on the dial, mm; b: metal that stands still; a: second on a finger + 1 and how far
// across (0..0.9 of a number), 0 elsewhere, -1 off the hand.

float line(float distance_mm, float width) { return 1.0 - smoothstep(0.5 * width - 0.25, 0.5 * width + 0.3, abs(distance_mm)); }
float disc(float distance_mm, float radius) { return 1.0 - smoothstep(radius - 0.3, radius + 0.3, distance_mm); }

// Strokes of a roman numeral: I 1, V 2, X 3, from the left, three at most.
ivec3 numeral(int hour) {
  if (hour == 1) return ivec3(1, 0, 0);
  if (hour == 2) return ivec3(1, 1, 0);
  if (hour == 3) return ivec3(1, 1, 1);
  if (hour == 4) return ivec3(1, 2, 0);
  if (hour == 5) return ivec3(2, 0, 0);
  if (hour == 6) return ivec3(2, 1, 0);
  if (hour == 7) return ivec3(2, 1, 1);
  if (hour == 8) return ivec3(2, 1, 9);
  if (hour == 9) return ivec3(1, 3, 0);
  if (hour == 10) return ivec3(3, 0, 0);
  if (hour == 11) return ivec3(3, 1, 0);
  return ivec3(3, 1, 1);
}

float glyph(int kind, vec2 p, float high) {
  float inside = step(abs(p.y), 0.5 * high), width = 0.9;
  if (kind == 1) return line(p.x, width) * inside;
  if (kind == 9) return max(line(p.x + 0.85, width), line(p.x - 0.85, width)) * inside;
  if (kind == 2) return line(abs(p.x) - 0.36 * (p.y + 0.5 * high), width) * inside;
  if (kind == 3) return line(abs(p.x) - 0.42 * abs(p.y), width) * inside;
  return 0.0;
}

// The hand of a clock at an angle from the top, rad.
float needle(vec2 p, float angle, float length_mm, float width) {
  vec2 q = vec2(cos(angle) * p.x - sin(angle) * p.y, sin(angle) * p.x + cos(angle) * p.y);
  float t = q.y / length_mm;
  float half_width = 0.5 * width * (t < 0.0 ? 0.8 : mix(0.8, 1.25, smoothstep(0.0, 0.55, t)) * (1.0 - smoothstep(0.62, 1.0, t)));
  return (1.0 - smoothstep(half_width - 0.2, half_width + 0.4, abs(q.x))) * step(-0.22, t) * step(t, 1.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(99.0, 99.0, 0.0, -1.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    float mirror = hand_side == 0 ? 1.0 : -1.0, seen = place.w < 0.0 ? -1.0 : 1.0;
    vec2 q = vec2(seen * (p.x - mirror * -1.0), -p.z - 50.0);
    float r = length(q), metal = 0.0;
    metal = max(line(r - 32.5, 1.4), line(r - 30.0, 0.8));
    float angle = atan(q.x, q.y), minute = angle * 9.5492966, tick = (minute - floor(minute + 0.5)) / 9.5492966 * r;
    metal = max(metal, line(tick, 0.7) * step(30.0, r) * step(r, 32.0));
    float hours = angle * 1.9098593, hour = floor(hours + 0.5), off = (hours - hour) / 1.9098593;
    int which = int(mod(hour + 11.0, 12.0)) + 1;
    vec2 local = r * vec2(sin(off), cos(off)) - vec2(0.0, 25.0);
    ivec3 strokes = numeral(which);
    int count = strokes.y == 0 ? 1 : strokes.z == 0 ? 2 : 3;
    float x = -0.5 * float(count - 1) * 2.6;
    for (int i = 0; i < 3; ++i) {
      int kind = i == 0 ? strokes.x : i == 1 ? strokes.y : strokes.z;
      metal = max(metal, glyph(kind, local - vec2(x + 2.6 * float(i), 0.0), 6.0));
    }
    if (r > 34.0) metal = 0.0;
    metal = max(metal, disc(r, 2.2));
    float second = 0.0;
    // Beads on the fingers, twelve a finger from the knuckle to the tip.
    int joint = int(near.x + 0.5), base = joint < 6 ? 3 : joint - (joint - 1) % 5 + 1, tip = joint < 6 ? 5 : base + 3;
    if (joint >= 3 && joint != base - 1 && r > 34.0 && p.z < -20.0) {
      vec3 a = hand_rest_joint[base], along = hand_rest_joint[tip] - a;
      vec3 up = joint < 6 ? normalize(vec3(mirror * 0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
      float first = joint < 6 ? 10.0 : 13.0, pitch = (length(along) + 1.0 - first) / 11.5;
      along = normalize(along);
      float s = dot(p - a, along) - first, d = dot(p - a, normalize(cross(along, up)));
      float i = clamp(floor(s / pitch + 0.5), 0.0, 11.0);
      float away = length(vec2(s - i * pitch, d));
      int finger = joint < 6 ? 0 : (joint - 1) / 5;
      second = 1.0 + float(finger) * 12.0 + i + 0.9 * clamp(away / 9.0, 0.0, 1.0);
    }
    gl_FragColor = vec4(q, metal * (1.0 - smoothstep(14.0, 42.0, p.z)), second);
    return;
  }
  vec4 it = texelFetch(face, texel, 0);
  float now = DATE.w + 3600.0 * shift, second = mod(now, 60.0), minutes = now / 60.0, hours = now / 3600.0;
  const float kTurn = 6.28318531;
  float shown = needle(it.rg, kTurn * hours / 12.0, 17.0, 3.4);
  shown = max(shown, needle(it.rg, kTurn * minutes / 60.0, 26.5, 2.6));
  float glow = exp(-max(0.0, 32.5 - length(it.rg)) / 2.5) * step(length(it.rg), 32.5);
  vec3 light = dial.rgb * it.b + vec3(1.0, 0.97, 0.9) * shown + 0.16 * dial.rgb * glow;
  float ahead = kTurn * (sweeps ? second : floor(second)) / 60.0;
  vec2 tip = 31.2 * vec2(sin(ahead), cos(ahead));
  light += point.rgb * 1.2 * exp(-dot(it.rg - tip, it.rg - tip) / 5.0);
  if (it.a >= 1.0) {
    float bead = floor(it.a) - 1.0, away = (it.a - 1.0 - bead) * 10.0;
    float since = mod(second - bead, 60.0), runs = exp(-since * (sweeps ? 0.45 : 0.9));
    float done = bead <= second ? 1.0 : 0.0;
    float radius = 1.9 + 1.1 * runs;
    light += point.rgb * disc(away, radius) * (0.22 + 0.55 * done + runs) + vec3(1.0) * disc(away, radius * 0.6) * runs;
    light += point.rgb * runs * 0.6 * exp(-away * away / 14.0);
  }
  gl_FragColor = vec4(it.a < 0.0 ? vec3(0.0) : light, 1.0);
}
