/*{
  "DESCRIPTION": "Cooling lava: glowing cracks in a dark crust, hotter in the creases, when the hand moves and when it closes.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "heat", "LABEL": "Heat", "TYPE": "float", "DEFAULT": 0.36, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "by_fist", "LABEL": "Heat of a fist", "TYPE": "float", "DEFAULT": 0.45, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "by_speed", "LABEL": "Heat per m/s", "TYPE": "float", "DEFAULT": 0.35, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "flow", "LABEL": "Flow", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 4.0}
  ],
  "PASSES": [
    {"TARGET": "fire", "PERSISTENT": true, "FLOAT": true, "WIDTH": "1", "HEIGHT": "1"},
    {"TARGET": "crust", "ONCE": true},
    {}
  ]
}*/
// fire: r: heat. crust: r: closeness to a large crack, g: to a small one, b: to a crease and the
// palm, a: roughness of the crust, 0 off the hand.

vec3 hash3(vec3 p) {
  p = fract(p * vec3(0.1031, 0.1030, 0.0973));
  p += dot(p, p.yxz + 33.33);
  return fract((p.xxy + p.yxx) * p.zyx);
}

float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  float a = hash3(vec3(i, 1.0)).x, b = hash3(vec3(i + vec2(1.0, 0.0), 1.0)).x;
  float c = hash3(vec3(i + vec2(0.0, 1.0), 1.0)).x, d = hash3(vec3(i + 1.0, 1.0)).x;
  return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}

// Distance to the border of two cells, in cells.
float border(vec3 p) {
  vec3 cell = floor(p), mine = vec3(0.0), to_mine = vec3(0.0);
  float least = 9.0, edge = 9.0;
  for (int i = 0; i < 27; ++i) {
    vec3 at = vec3(i % 3, i / 3 % 3, i / 9) - 1.0;
    vec3 way = at + hash3(cell + at) - p + cell;
    if (dot(way, way) < least) {
      least = dot(way, way);
      to_mine = way;
    }
  }
  for (int i = 0; i < 27; ++i) {
    vec3 at = vec3(i % 3, i / 3 % 3, i / 9) - 1.0;
    vec3 way = at + hash3(cell + at) - p + cell, across = way - to_mine;
    if (dot(across, across) > 1e-4) edge = min(edge, dot(0.5 * (way + to_mine), normalize(across)));
  }
  return edge;
}

// Black, red, orange, yellow, white.
vec3 glow(float t) {
  return clamp(vec3(1.9 * t, 1.25 * (t - 0.34), 0.9 * (t - 1.0)), 0.0, 1.2);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    float old = texelFetch(fire, ivec2(0), 0).r;
    float wanted = heat + (hand_there == 1 ? by_fist * hand_curl + by_speed * hand_speed : 0.0);
    float rate = wanted > old ? 5.0 : 0.7;  // heats fast and cools slowly
    gl_FragColor = vec4(mix(old, min(wanted, 1.3), FRAMEINDEX == 0 ? 1.0 : min(1.0, rate * TIMEDELTA)), 0.0, 0.0, 1.0);
  } else if (PASSINDEX == 1) {
    vec4 near = texelFetch(hand_bone, texel, 0);
    vec4 place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    vec3 warp = vec3(noise(0.09 * p.xz), noise(0.09 * p.zx + 31.0), noise(0.09 * p.xz + 77.0)) - 0.5;
    float large = border((p + 9.0 * warp) / 15.0) * 15.0, small = border((p + 5.0 * warp) / 6.0 + 20.0) * 6.0;
    float crease = 0.0;
    for (int j = 3; j < 25; ++j) {
      bool is_joint = j < 5 ? j > 2 : (j % 5 >= 2 && j % 5 <= 4);
      float d = distance(p, hand_rest_joint[j]);
      if (is_joint) crease = max(crease, exp(-d * d / 130.0));
    }
    float hollow = 0.0;
    if (place.w < 0.0) hollow = exp(-dot(p.xz - hand_rest_joint[0].xz, p.xz - hand_rest_joint[0].xz) / 450.0);
    gl_FragColor = vec4(exp(-large / 2.4), exp(-small / 1.0), max(crease, 0.6 * hollow), 0.15 + 0.85 * noise(0.7 * p.xz) * noise(0.25 * p.xz));
  } else {
    vec4 it = texelFetch(crust, texel, 0);
    vec3 p = texelFetch(hand_rest, texel, 0).xyz;
    float hot = texelFetch(fire, ivec2(0), 0).r;
    float drift = flow * TIME;
    float seethe = noise(0.07 * p.xz + vec2(0.35, -0.6) * drift) * 0.65 + noise(0.16 * p.xz + vec2(-0.5, -0.9) * drift) * 0.35;
    float local = hot * (0.35 + 0.9 * seethe) + it.b * (0.12 + 0.45 * hot);
    float crack = it.r * (0.45 + 1.25 * local) + it.g * it.g * smoothstep(0.35, 1.0, local) * 0.8;
    float melt = smoothstep(0.85, 1.6, local) * seethe;
    float t = max(crack - 0.42, 0.0) * (0.45 + 1.0 * local) + 0.7 * melt;
    vec3 rock = vec3(0.075, 0.05, 0.055) * it.a * (1.0 + 2.0 * local) + vec3(0.20, 0.03, 0.0) * it.r * local;
    float arm = 1.0 - smoothstep(12.0, 44.0, p.z);
    gl_FragColor = vec4((rock + glow(t)) * arm * (it.a > 0.0 ? 1.0 : 0.0), 1.0);
  }
}
