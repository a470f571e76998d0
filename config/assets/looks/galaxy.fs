/*{
  "DESCRIPTION": "A galaxy around the palm; its arms turn faster when the hand moves fast.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "turns", "LABEL": "Turns a minute at rest", "TYPE": "float", "DEFAULT": 3.0, "MIN": -20.0, "MAX": 20.0},
    {"NAME": "boost", "LABEL": "Turns a minute per m/s", "TYPE": "float", "DEFAULT": 40.0, "MIN": 0.0, "MAX": 200.0},
    {"NAME": "arms", "LABEL": "Arms", "TYPE": "long", "VALUES": [2, 3, 4, 5], "LABELS": ["2", "3", "4", "5"], "DEFAULT": 2},
    {"NAME": "warm", "LABEL": "Core", "TYPE": "color", "DEFAULT": [1.0, 0.72, 0.38, 1.0]},
    {"NAME": "cold", "LABEL": "Arms' colour", "TYPE": "color", "DEFAULT": [0.25, 0.45, 1.0, 1.0]}
  ],
  "PASSES": [
    {"TARGET": "phase", "PERSISTENT": true, "FLOAT": true, "WIDTH": "1", "HEIGHT": "1"},
    {"TARGET": "disc", "ONCE": true, "FLOAT": true},
    {}
  ]
}*/
// phase: r: the angle of the disc, rad; g: speed of the hand, smoothed.
// disc: rg: place on the disc, mm; b: angle of the spiral there, rad; a: brightness, 0 off the hand.

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

vec2 turned(vec2 p, float angle) {
  float c = cos(angle), s = sin(angle);
  return vec2(c * p.x - s * p.y, s * p.x + c * p.y);
}

// Stars of a cell, round, about one of three cells.
float stars(vec2 p, float cell, float radius) {
  vec2 i = floor(p / cell), f = p / cell - i;
  float kind = hash(i + 3.7);
  vec2 d = (f - 0.25 - 0.5 * vec2(hash(i + 11.3), hash(i + 5.9))) * cell;
  return kind > 0.45 ? (0.4 + 0.6 * kind) * smoothstep(radius, 0.25 * radius, length(d)) : 0.0;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 old = texelFetch(phase, ivec2(0), 0);
    float speed = mix(old.g, hand_there == 1 ? hand_speed : 0.0, min(1.0, 3.0 * TIMEDELTA));
    gl_FragColor = vec4(mod(old.r + TIMEDELTA * 0.1047 * (turns + boost * speed), 6.28318531), speed, 0.0, 1.0);
  } else if (PASSINDEX == 1) {
    vec4 near = texelFetch(hand_bone, texel, 0);
    vec3 place = texelFetch(hand_rest, texel, 0).xyz;
    vec2 p = (place.xz - hand_rest_joint[0].xz) * vec2(hand_side == 0 ? 1.0 : -1.0, -1.0);
    float r = length(p) + 0.5;
    float on = near.y < -9.0 || near.w == 0.0 ? 0.0 : 1.0 - smoothstep(10.0, 42.0, place.z);
    gl_FragColor = vec4(p, atan(p.y, p.x) + 2.6 * log(r), on);
  } else {
    vec4 it = texelFetch(disc, texel, 0);
    vec4 state = texelFetch(phase, ivec2(0), 0);
    vec2 p = turned(it.rg, -state.r);
    float r = length(p);
    float cloud = noise(0.11 * p) + 0.5 * noise(0.27 * p + 9.0), fine = noise(0.55 * p + 4.0);
    float wave = 0.5 + 0.5 * cos(float(arms) * (it.b - state.r) + 2.2 * (cloud - 0.75));
    float arm = wave * wave * wave;
    float fade = exp(-0.006 * r);
    float gas = arm * fade * (0.25 + 1.5 * cloud * fine);
    float lane = smoothstep(0.25, 0.75, wave) * (1.0 - smoothstep(0.80, 0.97, wave));
    float core = exp(-r * r / 90.0), halo = exp(-r / 13.0);
    float hot = min(1.0, state.g);
    vec3 hue = mix(cold.rgb, vec3(0.85, 0.28, 0.75), smoothstep(0.5, 1.1, cloud) * 0.75);
    hue = mix(hue, warm.rgb, halo);
    vec3 light = hue * gas * (1.25 + 0.9 * hot) + warm.rgb * halo * 0.75 + vec3(1.0, 0.95, 0.85) * core;
    light += vec3(0.9, 0.35, 0.5) * lane * smoothstep(0.62, 0.9, fine) * fade * 0.9;
    float twinkle = 0.75 + 0.25 * sin(5.0 * TIME + 0.9 * p.x + 1.3 * p.y);
    light += vec3(0.85, 0.92, 1.0) * twinkle * (stars(p, 5.0, 0.9) * (0.25 + arm) + stars(p + 40.0, 11.0, 1.5) * (0.55 + 0.6 * arm));
    gl_FragColor = vec4(light * it.a, 1.0);
  }
}
