/*{
  "DESCRIPTION": "Stars that stand still in space while the hands move through them; constellations on the joints, and a stream of stars to the other hand.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "density", "LABEL": "Stars", "TYPE": "float", "DEFAULT": 0.4, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "drift", "LABEL": "Drift, mm/s", "TYPE": "float", "DEFAULT": 9.0, "MIN": 0.0, "MAX": 80.0},
    {"NAME": "figures", "LABEL": "Constellations", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 1.5},
    {"NAME": "nebula", "LABEL": "Nebula", "TYPE": "color", "DEFAULT": [0.22, 0.14, 0.75, 1.0]}
  ],
  "PASSES": [{"TARGET": "figure", "ONCE": true}, {"TARGET": "sky", "WIDTH": "$WIDTH/4", "HEIGHT": "$HEIGHT/4"}, {}]
}*/
// sky: the nebula. figure: r: lines of the constellations, g: their stars, b: number of the star, a: 1 on the hand.

float hash(vec2 p) {
  uvec2 q = uvec2(ivec2(p)) * uvec2(1597334673u, 3812015801u);
  uint h = (q.x ^ q.y) * 1597334673u;
  h = (h ^ (h >> 15u)) * 2246822519u;
  return float((h ^ (h >> 13u)) >> 8u) / 16777216.0;
}
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1.0, 0.0)), f.x), mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), f.x), f.y);
}

// A star in some of the cells, mm: a disc with a halo.
vec3 stars(vec2 p, float cell, float radius, float share, float seed) {
  vec2 i = floor(p / cell), f = (p / cell - i - 0.2 - 0.6 * vec2(hash(i + seed), hash(i + seed + 6.0))) * cell;
  float own = hash(i + seed + 37.0), d = length(f);
  float twinkle = 0.75 + 0.25 * sin(TIME * (2.0 + 5.0 * own) + 40.0 * own);
  float size = radius * (0.45 + 0.85 * own / max(share, 0.01) * hash(i + seed + 81.0));
  float light = (1.0 - smoothstep(0.5 * size, size, d)) + 0.35 * exp(-d * d / (5.0 * size * size));
  return mix(vec3(0.60, 0.82, 1.0), vec3(1.0, 0.80, 0.60), step(0.75, hash(i + seed + 13.0))) * light * twinkle * step(own, share);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0);
    vec3 p = texelFetch(hand_rest, texel, 0).xyz;
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    float mirror = hand_side == 0 ? 1.0 : -1.0, lines = 0.0, glow = 0.0, number = 0.0;
    for (int j = 2; j < 26; ++j) {
      bool is_tip = j == 5 || (j > 5 && j % 5 == 0), is_root = j == 6 || j == 11 || j == 16 || j == 21;
      vec3 up = j < 6 ? normalize(vec3(mirror * 0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
      vec3 a = is_root ? hand_rest_joint[1] + vec3(0.0, 0.0, -18.0) : hand_rest_joint[j];
      vec3 end = is_tip ? a : hand_rest_joint[j + 1], along = normalize(end - a + vec3(0.0, 0.0, -1e-3));
      if (is_tip) along = normalize(a - hand_rest_joint[j - 1]);
      vec3 across = normalize(cross(along, up));
      float s = dot(p - a, along), d = dot(p - a, across), size = distance(end, a);
      if (abs(d) > 11.0 || s < -9.0 || s > size + 9.0 || (j > 2 && !is_root && distance(p, a + along * clamp(s, 0.0, size)) > 17.0)) continue;
      if (!is_tip && s > 5.0 && s < size - 5.0) lines = max(lines, (1.0 - smoothstep(0.3, 0.95, abs(d))) * (0.55 + 0.45 * step(0.35, fract(s / 4.5))));
      if (is_root || j == 2) continue;
      float x = abs(d), y = abs(s - (is_tip ? -3.0 : 0.0)), r = length(vec2(x, y));
      float star = 1.0 - smoothstep(1.6, 2.5, r);
      star = max(star, 0.85 * max(exp(-x * 2.2) * max(0.0, 1.0 - y / 7.5), exp(-y * 2.2) * max(0.0, 1.0 - x / 7.5)));
      star = max(star, 0.4 * exp(-r * r / 14.0));
      if (star > glow) {
        glow = star;
        number = float(j) / 26.0;
      }
    }
    float on = 1.0 - smoothstep(14.0, 42.0, p.z);
    gl_FragColor = vec4(lines * on, glow * on, number, on);
    return;
  }
  vec2 move = vec2(drift, 0.35 * drift) * TIME;
  if (PASSINDEX == 1) {
    vec3 here = texture(hand_position, isf_FragNormCoord).xyz;
    vec2 deep = 600.0 * here.xy / max(here.z, 0.1);
    float cloud = noise(mat2(0.6, 0.8, -0.8, 0.6) * (0.022 * deep) + 0.01 * move) * 0.65 + noise(mat2(0.8, -0.6, 0.6, 0.8) * (0.06 * deep) - 0.012 * move) * 0.35;
    gl_FragColor.rgb = nebula.rgb * smoothstep(0.38, 0.85, cloud) * 0.75 + vec3(0.5, 0.06, 0.32) * smoothstep(0.55, 0.9, noise(0.035 * deep + 40.0)) * 0.55;
    gl_FragColor.a = 1.0;
    return;
  }
  vec4 it = texelFetch(figure, texel, 0);
  vec3 at = texture(hand_position, isf_FragNormCoord).xyz;
  vec2 near = 1000.0 * at.xy, far = 600.0 * at.xy / max(at.z, 0.1);
  vec3 light = stars(far + 0.3 * move, 6.5, 0.85, density, 1.0) * 0.7 + stars(mix(near, far, 0.5) + 0.7 * move, 11.0, 1.3, density, 20.0) * 0.9;
  light += stars(near + 1.3 * move, 21.0, 2.1, density, 50.0);
  light += texture(sky, isf_FragNormCoord).rgb;
  float beat = 0.8 + 0.2 * sin(2.0 * TIME + 40.0 * it.b);
  light += figures * (vec3(0.35, 0.6, 1.0) * it.r * 0.75 + vec3(1.0, 0.95, 0.82) * it.g * beat);
  // The stream to the other hand, between hands that are less than 0.8 m apart.
  vec3 way = other_joint[0] - hand_joint[0];
  float gap = length(way), near_by = other_there == 1 && hand_there == 1 ? 1.0 - smoothstep(0.35, 0.8, gap) : 0.0;
  vec3 along = way / max(gap, 0.01), side = normalize(vec3(-along.y, along.x, 1e-4));
  float s = 1000.0 * dot(at - hand_joint[0], along), d = 1000.0 * dot(at - hand_joint[0], side);
  float lean = smoothstep(-30.0, 70.0, s) * near_by;
  vec2 stream = vec2(s - 150.0 * TIME, d + 6.0 * sin(0.03 * s - 2.0 * TIME));
  light += lean * (stars(stream, 7.0, 1.7, 0.9, 70.0) * 1.4 + vec3(0.30, 0.55, 1.0) * 0.20);
  gl_FragColor = vec4(light * it.a, 1.0);
}
