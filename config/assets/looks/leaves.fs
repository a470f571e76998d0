/*{
  "DESCRIPTION": "Vines that grow along the fingers; their leaves sway, and the year goes by: buds, summer, autumn, bare.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "year", "LABEL": "Seconds of a year", "TYPE": "float", "DEFAULT": 20.0, "MIN": 4.0, "MAX": 600.0},
    {"NAME": "start", "LABEL": "Begins in", "TYPE": "long", "VALUES": [0, 1, 2, 3], "LABELS": ["spring", "summer", "autumn", "winter"], "DEFAULT": 0},
    {"NAME": "sway", "LABEL": "Sway", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 3.0},
    {"NAME": "green", "LABEL": "Summer", "TYPE": "color", "DEFAULT": [0.22, 0.85, 0.16, 1.0]}
  ],
  "PASSES": [{"TARGET": "plant", "ONCE": true, "FLOAT": true}, {}]
}*/
// plant: r: 1 in a leaf, -1 in a stem; g: vein, 0..1; b: way from the wrist, mm; a: number of the
// leaf (whole) and how far from its base (fraction); 0 off the hand.

float hash(float n) { return fract(sin(n * 12.9898) * 43758.5453); }
float hash(vec2 p) {
  p = fract(p * vec2(0.3183, 0.3678));
  p += dot(p, p + 17.13);
  return fract(p.x * p.y * 31.7);
}
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1.0, 0.0)), f.x), mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), f.x), f.y);
}

struct Found {
  float leaf, vein, number, from_base;
};

// A leaf whose base is at the origin, that points along y.
void add_leaf(inout Found found, vec2 p, float size, float number) {
  float t = p.y / size;
  if (t < 0.0 || t > 1.0) return;
  float teeth = 0.05 * size * (abs(fract(t * 6.0) - 0.5));
  float half_width = 0.40 * size * pow(sin(3.14159265 * pow(t, 0.72)), 0.85) - teeth;
  float x = abs(p.x);
  if (x > half_width) return;
  float rib = 1.0 - smoothstep(0.25, 0.75, x);
  float side = abs(fract((t * size - 0.75 * x) / (0.19 * size)) - 0.5) * 0.19 * size;
  float outline = 1.0 - smoothstep(0.2, 0.8, half_width - x);
  found = Found(1.0, max(max(rib, 0.75 * (1.0 - smoothstep(0.15, 0.5, side))), 0.55 * outline), number, t);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    float mirror = hand_side == 0 ? 1.0 : -1.0;
    vec3 root = vec3(mirror * 2.0, 0.0, 40.0);
    Found found = Found(0.0, 0.0, 0.0, 0.0);
    float stem = 0.0, way = 0.0;
    int joint = int(near.x + 0.5), own = joint < 2 ? -1 : joint < 6 ? 0 : (joint - 1) / 5;
    for (int finger = 0; finger < 5; ++finger) {
      // Fingers bear their own vine only; the hand bears the beginnings of all.
      bool on_finger = joint >= 3 && joint != 6 && joint != 11 && joint != 16 && joint != 21;
      if (on_finger && finger != own && p.z < hand_rest_joint[7 + 5 * max(own - 1, 0)].z + 6.0) continue;
      int first = finger == 0 ? 3 : 2 + 5 * finger, last = finger == 0 ? 5 : first + 3;
      vec3 up = finger == 0 ? normalize(vec3(mirror * 0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
      float start = 0.0;
      for (int part = 0; part < 3; ++part) {
        vec3 a = part == 0 ? root : part == 1 ? hand_rest_joint[first - 1] : hand_rest_joint[first];
        vec3 b = part == 0 ? hand_rest_joint[first - 1] : part == 1 ? hand_rest_joint[first] : hand_rest_joint[last];
        if (part < 2) {
          a.y = p.y;
          b.y = p.y;
        }
        vec3 along = normalize(b - a);
        float size = distance(a, b), s = dot(p - a, along), d = dot(p - a, normalize(cross(along, part < 2 ? vec3(0.0, 1.0, 0.0) : up)));
        if (s < -4.0 || s > size + 5.0 || abs(d) > 16.0) {
          start += size;
          continue;
        }
        float whole = start + s, seed = float(finger);
        float curve = 1.5 * sin(0.16 * whole + 2.0 * seed);
        if (s > 0.0 && s < size - (part == 2 ? 2.0 : 0.0)) {
          float metal = 1.0 - smoothstep(0.55, 1.05, abs(d - curve));
          if (metal > stem) {
            stem = metal;
            way = whole;
          }
        }
        if (part == 0) {
          start += size;
          continue;
        }
        float pitch = part == 2 ? 9.0 : 12.0, k = floor(whole / pitch);
        for (int i = -1; i <= 0; ++i) {
          float n = k + float(i), at = n * pitch, turn = mod(n, 2.0) < 0.5 ? 1.0 : -1.0;
          if (at < start || at > start + size - 3.0) continue;
          float lean = (part == 2 ? 0.62 : 0.80) + 0.25 * (hash(n + 9.0 * seed) - 0.5);
          vec2 q = vec2(turn * (d - 1.5 * sin(0.16 * at + 2.0 * seed)), whole - at);
          q = vec2(cos(lean) * q.x - sin(lean) * q.y, sin(lean) * q.x + cos(lean) * q.y);
          float long_mm = (part == 2 ? 12.5 : 17.0) * (0.85 + 0.3 * hash(n * 3.0 + seed));
          float before = found.leaf;
          float number = 1.0 + n + 24.0 * seed;
          Found one = Found(0.0, 0.0, 0.0, 0.0);
          add_leaf(one, q, long_mm, number);
          if (one.leaf > 0.0 && (before == 0.0 || number > found.number)) {
            found = one;
            way = at;
          }
        }
        start += size;
      }
    }
    float kind = found.leaf > 0.0 ? 1.0 : -stem;
    gl_FragColor = vec4(kind, found.vein, way, found.leaf > 0.0 ? found.number + 0.9 * found.from_base : 0.5);
    gl_FragColor.r *= 1.0 - smoothstep(14.0, 42.0, p.z);
    return;
  }
  vec3 p = texelFetch(hand_rest, texel, 0).xyz;
  float gust = 0.5 + noise(vec2(0.7 * TIME, 0.02 * p.z));
  vec2 push = sway * gust * vec2(sin(2.1 * TIME + 0.05 * p.z + 0.09 * p.x), 0.6 * sin(1.7 * TIME + 0.11 * p.x)) * 1.6;
  ivec2 from = clamp(texel + ivec2(round(push)), ivec2(0), ivec2(RENDERSIZE) - 1);
  vec4 it = texelFetch(plant, from, 0);
  // The season, 0..4: spring, summer, autumn, winter. A leaf has its own calendar.
  float season = mod(4.0 * TIME / year + float(start), 4.0);
  float own = hash(floor(it.a)), at = it.b / 220.0;
  float grown = clamp(season * 1.35 - at * 0.75 - 0.12 * own, 0.0, 1.0);
  float turn_red = smoothstep(1.7 + 0.5 * own, 2.2 + 0.5 * own, season), fall = smoothstep(2.75 + 0.45 * own, 3.0 + 0.45 * own, season);
  float die = smoothstep(3.6, 3.95, season);
  float leaf = it.r > 0.0 ? it.r : 0.0, stem = it.r < 0.0 ? -it.r : 0.0;
  float unfolded = smoothstep(0.15, 0.75, grown);
  float there = leaf * step(fract(it.a) / 0.9, unfolded + 0.001) * step(0.16, grown);
  there *= fall > 0.0 ? smoothstep(fall - 0.08, fall + 0.02, noise(0.5 * p.xz + own * 40.0) * 0.999) : 1.0;
  float flutter = 0.78 + 0.22 * sin(3.0 * TIME + 40.0 * own) * sway;
  vec3 spring = mix(green.rgb, vec3(0.75, 1.0, 0.25), 0.6), autumn = mix(vec3(1.0, 0.55, 0.04), vec3(0.95, 0.10, 0.03), hash(own * 7.0));
  vec3 colour = mix(mix(spring, green.rgb, smoothstep(0.6, 1.3, season)), autumn, turn_red);
  vec3 lit = colour * (0.34 + 0.28 * own) * flutter * (0.6 + 0.4 * fract(it.a));
  lit = mix(lit, mix(colour, vec3(1.0, 1.0, 0.7), 0.45), it.g * 0.9);
  float stem_there = stem * step(0.02, season * 1.5 - at - 0.02) * (1.0 - die);
  vec3 light = lit * there + mix(vec3(0.45, 0.60, 0.16), vec3(0.60, 0.34, 0.16), smoothstep(1.5, 3.0, season)) * stem_there;
  gl_FragColor = vec4(it.a > 0.0 ? light : vec3(0.0), 1.0);
}
