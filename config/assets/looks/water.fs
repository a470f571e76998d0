/*{
  "DESCRIPTION": "Water: it fills the hand, sloshes when the hand tilts and runs off when the fingers point down.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "level", "LABEL": "Level", "TYPE": "float", "DEFAULT": 0.62, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "slosh", "LABEL": "Sloshing", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 2.0},
    {"NAME": "shallow", "LABEL": "Light", "TYPE": "color", "DEFAULT": [0.30, 0.95, 1.0, 1.0]},
    {"NAME": "deep", "LABEL": "Depth", "TYPE": "color", "DEFAULT": [0.0, 0.16, 0.75, 1.0]}
  ],
  "PASSES": [
    {"TARGET": "pool", "PERSISTENT": true, "FLOAT": true, "WIDTH": "2", "HEIGHT": "1"},
    {"TARGET": "shape", "ONCE": true, "FLOAT": true},
    {}
  ]
}*/
// pool: texel 0: the direction in which the water hangs (in the axes of the wrist) and its amount,
// 0..1; texel 1: how fast that direction turns. shape: place at rest, mm; a: 1 on the hand.

float hash(vec2 p) {
  p = fract(p * vec2(0.3183, 0.3678));
  p += dot(p, p + 17.13);
  return fract(p.x * p.y * 31.7);
}

// A net of light, as on the ground of a pool.
float caustic(vec2 p, float t) {
  p += 3.0 * vec2(sin(0.17 * p.y + t), cos(0.15 * p.x - 0.8 * t));
  float a = sin(0.30 * p.x + sin(0.23 * p.y + 0.9 * t) * 1.6), b = sin(0.33 * p.y - sin(0.26 * p.x - 1.1 * t) * 1.6);
  float net = 1.0 - min(abs(a), abs(b));
  net *= net;
  net *= net;
  return net * net;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 hangs = texelFetch(pool, ivec2(0, 0), 0);
    vec3 turns = texelFetch(pool, ivec2(1, 0), 0).xyz;
    float dt = min(TIMEDELTA, 0.05);
    if (hangs.a == 0.0) hangs = vec4(hand_gravity, level);
    turns += dt * (55.0 * (hand_gravity - hangs.xyz) - mix(12.0, 2.2, 0.5 * slosh) * turns);
    hangs.xyz += dt * turns;
    float away = smoothstep(0.15, 0.8, -hangs.z);
    hangs.a = clamp(hangs.a + dt * (0.35 * (level - hangs.a) * (1.0 - away) - 0.55 * away), 0.001, 1.0);
    gl_FragColor = texel.x == 0 ? hangs : vec4(turns, 1.0);
  } else if (PASSINDEX == 1) {
    vec4 near = texelFetch(hand_bone, texel, 0);
    vec3 p = texelFetch(hand_rest, texel, 0).xyz;
    float on = near.y < -9.0 || near.w == 0.0 ? 0.0 : 1.0 - smoothstep(10.0, 42.0, p.z);
    gl_FragColor = vec4(p, on * (0.55 + 0.45 * (1.0 - smoothstep(0.0, 16.0, near.y))));
  } else {
    vec4 it = texelFetch(shape, texel, 0);
    vec4 hangs = texelFetch(pool, ivec2(0, 0), 0);
    vec3 turns = texelFetch(pool, ivec2(1, 0), 0).xyz;
    vec3 p = it.xyz - vec3(0.0, 0.0, -75.0), down = normalize(hangs.xyz + 1e-4);
    vec2 flat_down = normalize(down.xz + vec2(1e-3, 0.0));
    float across = dot(p.xz, vec2(-flat_down.y, flat_down.x)), height = -dot(p, down);
    float rough = 0.6 + min(4.0, 1.6 * length(turns)) * slosh;
    float steep = length(down.xz);
    float wave = rough * (sin(0.11 * across + 3.6 * TIME) + 0.6 * sin(0.19 * across - 5.1 * TIME)) * steep;
    // The surface: full, the water stands at the middle of the fingers; empty, below all.
    float reach = mix(26.0, 118.0, steep), surface = mix(-reach, reach, hangs.a) * (0.9 + 0.1 * steep) - 18.0 * steep + wave;
    float below = surface - height;
    float wet = smoothstep(-0.5, 0.5, below);
    float depth = clamp(below / 95.0, 0.0, 1.0);
    float net = caustic(p.xz, 0.9 * TIME) + 0.55 * caustic(1.7 * p.xz + 20.0, -1.2 * TIME);
    vec3 light = mix(shallow.rgb * vec3(0.10, 0.42, 0.62), deep.rgb * 0.75, sqrt(depth)) * wet * (0.55 + 0.6 * it.a);
    light += mix(shallow.rgb, vec3(1.0), 0.25) * net * wet * mix(0.85, 0.30, depth);
    light += mix(shallow.rgb, vec3(1.0), 0.75) * exp(-pow((below - 0.9) / 1.2, 2.0));
    light += shallow.rgb * 0.5 * exp(-max(below, 0.0) / 5.0) * wet;
    // Bubbles that rise, and drops above that run down.
    vec2 run = vec2(across, height);
    vec2 b = (run - vec2(1.5 * sin(0.2 * height + TIME), 34.0 * TIME)) / 15.0, i = floor(b), f = (b - i - 0.25 - 0.5 * hash(i)) * 15.0;
    float bubble = length(f), radius = 1.2 + 1.3 * hash(i + 5.0);
    light += vec3(0.8, 1.0, 1.0) * wet * step(0.70, hash(i + 9.0)) * (1.0 - smoothstep(0.3, 0.9, abs(bubble - radius))) * 0.9;
    float column = floor(across / 6.5), own = hash(vec2(column, 2.0));
    float fall = (height + (26.0 + 60.0 * own) * TIME * (0.25 + steep)) / (46.0 + 30.0 * own), k = floor(fall), along = (fall - k) * (46.0 + 30.0 * own);
    float x = across - 6.5 * (column + 0.5) - 1.4 * sin(0.25 * height + 9.0 * own);
    float there = step(0.35, hash(vec2(column, k))) * (1.0 - wet) * smoothstep(0.05, 0.4, steep);
    float drop = length(vec2(x, (along - 3.0) * 0.75));
    light += shallow.rgb * there * (1.0 - smoothstep(1.3, 2.1, drop)) * 0.8 + vec3(1.0) * there * (1.0 - smoothstep(0.3, 0.9, length(vec2(x + 0.6, along - 3.8))));
    light += shallow.rgb * there * 0.55 * (1.0 - smoothstep(0.4, 1.0, abs(x))) * step(3.0, along) * exp(-along / 16.0);
    gl_FragColor = vec4(it.a > 0.0 ? light * min(1.0, 2.0 * it.a) : vec3(0.0), 1.0);
  }
}
