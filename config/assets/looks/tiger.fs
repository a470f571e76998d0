/*{
  "DESCRIPTION": "Tiger: soft fur with black stripes that follow the bones; a breeze and quick moves ruffle it.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "coat", "LABEL": "Coat", "TYPE": "color", "DEFAULT": [1.0, 0.46, 0.07, 1.0]},
    {"NAME": "belly", "LABEL": "Palm and edges", "TYPE": "color", "DEFAULT": [1.0, 0.86, 0.66, 1.0]},
    {"NAME": "stripes", "LABEL": "Stripes", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 1.6},
    {"NAME": "breeze", "LABEL": "Breeze", "TYPE": "float", "DEFAULT": 0.6, "MIN": 0.0, "MAX": 2.0}
  ],
  "PASSES": [{"TARGET": "fur", "ONCE": true}, {}]
}*/
// fur: r: 1 in a stripe, g: hairs, b: 0 coat to 1 belly, a: light on the round of a finger, 0 off
// the hand.

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

// Tapered bands across: s along, d across, each open near the middle or at one side.
float bands(float s, float d, float pitch, float half_width, float seed) {
  float bent = s + 0.30 * abs(d) + 2.2 * (noise(vec2(0.16 * s + seed, 0.22 * d)) - 0.5) * 2.0;
  bent += 0.45 * pitch * (noise(vec2(0.10 * d + seed, 0.06 * s)) - 0.5) * 2.0;
  float i = floor(bent / pitch), f = abs(bent / pitch - i - 0.5) * 2.0;
  float from = (hash(vec2(i, seed)) - 0.5) * 0.9 * half_width;
  float away = abs(d - from) / half_width;
  float thick = 0.46 * smoothstep(0.05, 0.9, away) + 0.03 + 0.22 * (hash(vec2(i, seed + 4.0)) - 0.5);
  float fork = noise(vec2(0.35 * d + 5.0 * i, 0.9 * s + seed)) - 0.5;
  return 1.0 - smoothstep(thick - 0.10, thick + 0.10, f + 0.35 * fork);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    float mirror = hand_side == 0 ? 1.0 : -1.0;
    int joint = int(near.x + 0.5);
    bool is_thumb = joint >= 2 && joint < 6;
    int base = joint < 2 ? 11 : is_thumb ? 2 : joint - (joint - 1) % 5, tip = is_thumb ? 5 : base + 4;
    bool is_finger = joint >= 3 && joint != base;
    vec3 up = is_thumb ? normalize(vec3(mirror * 0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
    vec3 a = hand_rest_joint[is_thumb ? 2 : base + 1], along = normalize(hand_rest_joint[tip] - a);
    vec3 across = normalize(cross(along, up));
    float s = dot(p - a, along), d = dot(p - a, across);
    // On the hand, stripes come from both sides to the line of the middle finger.
    float x = (p.x - hand_rest_joint[11].x) + 0.10 * mirror * (p.z + 40.0), y = -p.z;
    float back = bands(y - 0.45 * abs(x), x, 14.5, 36.0, 3.0);
    float finger = bands(s, d, 11.0, 8.5, float(base));
    float stripe = is_finger ? mix(back, finger, is_thumb ? 1.0 : smoothstep(-6.0, 8.0, s)) : back;
    // Hairs along the bones.
    float warp = 4.0 * noise(0.12 * p.xz);
    vec2 h = is_finger ? vec2(d, s) : vec2(p.x, p.z);
    float hairs = 0.55 * noise(vec2(2.1 * h.x + warp, 0.28 * h.y + warp)) + 0.45 * noise(vec2(3.6 * h.x + 9.0, 0.5 * h.y - warp));
    float edge = 1.0 - smoothstep(2.0, 24.0, near.y);
    float pale = place.w < 0.0 ? 1.0 - 0.55 * edge : 0.75 * edge * edge;
    pale = clamp(pale + 0.5 * (noise(0.10 * p.xz) - 0.5), 0.0, 1.0);
    stripe *= place.w < 0.0 ? mix(1.0, 0.55, smoothstep(8.0, 26.0, near.y)) : 1.0;
    float ragged = clamp(stripe + 1.1 * stripe * (1.0 - stripe) * (hairs - 0.5) * 4.0, 0.0, 1.0);
    float round_light = 0.45 + 0.55 * smoothstep(-3.0, 16.0, near.y);
    gl_FragColor = vec4(ragged, hairs, pale, max(0.02, round_light * (1.0 - smoothstep(14.0, 42.0, p.z))));
    return;
  }
  vec4 it = texelFetch(fur, texel, 0);
  vec3 p = texelFetch(hand_rest, texel, 0).xyz;
  float wind = TIME * (0.9 + 0.0 * breeze), quick = hand_there == 1 ? min(1.5, hand_speed * 2.0) : 0.0;
  float wave = noise(vec2(0.035 * p.x + 0.9 * wind, 0.030 * p.z + 0.45 * wind));
  float ruffle = smoothstep(0.42, 0.72, wave) * (breeze + quick);
  float hair = mix(it.g, smoothstep(0.3, 0.75, it.g), 0.7);
  float shine = 0.50 + 0.50 * hair + ruffle * (0.75 * hair - 0.18);
  vec3 deep = coat.rgb * vec3(0.80, 0.55, 0.45);
  vec3 colour = mix(mix(deep, coat.rgb, hair), belly.rgb * (0.75 + 0.25 * hair), it.b);
  colour *= 1.0 - min(1.0, stripes * it.r);
  gl_FragColor = vec4(it.a > 0.0 ? colour * it.a * shine : vec3(0.0), 1.0);
}
