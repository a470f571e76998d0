/*{
  "DESCRIPTION": "Frost: crystals grow over the hand; they melt where fingers pinch and when the hand moves fast.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "seconds", "LABEL": "Seconds to freeze", "TYPE": "float", "DEFAULT": 5.0, "MIN": 0.5, "MAX": 60.0},
    {"NAME": "warmth", "LABEL": "Warmth of a pinch", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 3.0},
    {"NAME": "wind", "LABEL": "Melting by moves", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 3.0},
    {"NAME": "ice", "LABEL": "Colour", "TYPE": "color", "DEFAULT": [0.30, 0.70, 1.0, 1.0]}
  ],
  "PASSES": [
    {"TARGET": "crystals", "ONCE": true},
    {"TARGET": "cold", "PERSISTENT": true, "FLOAT": true, "WIDTH": "$WIDTH/4", "HEIGHT": "$HEIGHT/4"},
    {}
  ]
}*/
// crystals: r: brightness, g: when it freezes, 0..1, b: a number of the facet, a: 1 on the hand.
// cold: r: how far it is frozen, 0..1.2; g: water of what has melted.

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
float line(float distance_mm, float width) { return 1.0 - smoothstep(0.5 * width - 0.3, 0.5 * width + 0.35, abs(distance_mm)); }

// A crystal of six arms with branches.
float flake(vec2 p, float radius, float kind) {
  float r = length(p), step = 1.04719755, a = atan(p.x, p.y);
  a -= step * floor(a / step + 0.5);
  float x = abs(r * sin(a)), y = r * cos(a);
  if (y > radius) return 0.0;
  float ink = line(x, 1.5 - 0.6 * y / radius);
  float pitch = 2.9 + 1.2 * kind, u = y - 0.62 * x, k = floor(u / pitch);
  float reach = 0.50 * (radius - y + x * 0.6) * (0.55 + 0.45 * step * hash(vec2(k, kind)));
  ink = max(ink, (u > 1.0 && x < reach) ? line((u - pitch * (k + 0.5)) * 0.85, 1.0) : 0.0);
  float hexagon = r * cos(a);
  return max(ink, max(line(hexagon - 0.22 * radius, 0.9), kind > 0.5 ? line(hexagon - 0.45 * radius, 0.8) * 0.8 : 0.0));
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec2 p = place.xz;
    float bright = 0.0, when = 1.0, facet = 0.0;
    for (int layer = 0; layer < 2; ++layer) {
      float size = layer == 0 ? 27.0 : 13.0;
      vec2 cell = floor(p / size);
      for (int i = 0; i < 9; ++i) {
        vec2 c = cell + vec2(i % 3 - 1, i / 3 - 1);
        float own = hash(c + 31.0 * float(layer));
        vec2 at = (c + 0.5 + 0.75 * (vec2(hash(c + 7.7), hash(c + 3.3)) - 0.5)) * size;
        float turn = 6.2831853 * own, radius = size * (0.52 + 0.30 * hash(c + 9.9));
        vec2 q = p - at;
        q = vec2(cos(turn) * q.x - sin(turn) * q.y, sin(turn) * q.x + cos(turn) * q.y);
        float here = flake(q, radius, own) * (layer == 0 ? 1.0 : 0.55), then = 0.62 * own + 0.38 * length(q) / radius + 0.2 * float(layer);
        if (here > bright) {
          bright = here;
          when = then;
          facet = own;
        }
      }
    }
    float rime = smoothstep(0.35, 0.85, noise(1.1 * p) * 0.6 + noise(0.35 * p) * 0.55);
    float edge = 1.0 - smoothstep(0.0, 9.0, near.y);
    float film = 0.14 + 0.26 * rime + 0.35 * edge;
    if (film > bright) when = 0.45 + 0.5 * noise(0.16 * p) - 0.25 * edge;
    gl_FragColor = vec4(max(bright, film) * (1.0 - smoothstep(14.0, 42.0, place.z)), clamp(when, 0.02, 1.0), facet, 1.0);
  } else if (PASSINDEX == 1) {
    vec4 old = texelFetch(cold, texel, 0);
    vec3 p = texture(hand_rest, isf_FragNormCoord).xyz;
    float to_tip = min(distance(p, hand_rest_joint[5]), distance(p, hand_rest_joint[10]));
    float pinch = hand_there == 1 ? smoothstep(0.55, 0.95, hand_pinch) * warmth : 0.0;
    float warm = pinch * exp(-pow(to_tip / (24.0 + 36.0 * clamp(old.b, 0.0, 1.0)), 2.0));
    float gone = hand_there == 1 ? wind * max(0.0, hand_speed - 0.35) * 0.9 : 0.0;
    float change = TIMEDELTA * (1.0 / seconds - 2.6 * warm - gone * (0.5 + noise(0.08 * p.xz)));
    float now = clamp(old.r + min(change, 1.2 - old.r), 0.0, 1.2);
    float water = clamp(old.g + max(old.r - now, 0.0) * 2.0 - TIMEDELTA * 0.5, 0.0, 1.0);
    gl_FragColor = vec4(now, water, clamp(old.b + TIMEDELTA * (pinch > 0.2 ? 0.7 : -0.5), 0.0, 1.0), 1.0);
  } else {
    vec4 it = texelFetch(crystals, texel, 0), state = texture(cold, isf_FragNormCoord);
    float since = state.r - it.g;
    float frozen = smoothstep(0.0, 0.10, since), front = frozen * exp(-9.0 * max(since, 0.0));
    float glint = pow(0.5 + 0.5 * sin(40.0 * it.b + 1.7 * TIME + 12.0 * isf_FragNormCoord.x), 24.0);
    vec3 white = vec3(0.72, 0.90, 1.0);
    vec3 light = mix(ice.rgb * ice.rgb, mix(ice.rgb, white, 0.55), it.r) * it.r * frozen;
    light += white * it.r * (0.45 * front + 0.6 * glint * frozen * step(0.5, it.r));
    float drops = smoothstep(0.62, 0.80, noise(vec2(isf_FragNormCoord.x * 150.0, isf_FragNormCoord.y * 60.0 + 3.0 * TIME)));
    light += vec3(0.10, 0.42, 0.85) * state.g * (0.25 + 0.9 * drops) * it.a;
    gl_FragColor = vec4(light, 1.0);
  }
}
