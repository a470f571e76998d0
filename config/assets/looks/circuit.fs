/*{
  "DESCRIPTION": "A circuit: traces along the bones, pads at the joints, a chip on the hand and pulses that run to the tips.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "trace", "LABEL": "Traces", "TYPE": "color", "DEFAULT": [0.0, 0.55, 0.32, 1.0]},
    {"NAME": "pulse", "LABEL": "Pulses", "TYPE": "color", "DEFAULT": [0.35, 1.0, 0.85, 1.0]},
    {"NAME": "speed", "LABEL": "Speed of the pulses, mm/s", "TYPE": "float", "DEFAULT": 130.0, "MIN": -400.0, "MAX": 400.0},
    {"NAME": "traffic", "LABEL": "Traffic", "TYPE": "float", "DEFAULT": 0.6, "MIN": 0.0, "MAX": 1.0}
  ],
  "PASSES": [{"TARGET": "board", "ONCE": true, "FLOAT": true}, {}]
}*/
// board: r: copper; g: way from the chip, mm; b: lane, a number of its own; a: kind of metal: 1
// trace, 2 pad, 3 chip, 0 off the hand.

float line(float distance_mm, float width) { return 1.0 - smoothstep(0.5 * width - 0.25, 0.5 * width + 0.3, abs(distance_mm)); }
float disc(float distance_mm, float radius) { return 1.0 - smoothstep(radius - 0.3, radius + 0.3, distance_mm); }
float hash(float n) { return fract(sin(n * 12.9898) * 43758.5453); }

// Where lane k (-1, 0, 1) of a finger is across at s: it leaves the middle lane by 45 degrees.
float lane_at(float k, float s, float finger) {
  float spread = 3.6 - 1.3 * smoothstep(90.0, 130.0, s);
  float jog = clamp(s - 96.0 - 7.0 * hash(finger + 3.0 * k), 0.0, 1.6) - clamp(s - 118.0, 0.0, 1.6);
  return k * spread * clamp(s / 14.0, 0.55, 1.0) + jog * (hash(finger + 7.0) > 0.5 ? 1.0 : -1.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0), place = texelFetch(hand_rest, texel, 0);
    gl_FragColor = vec4(0.0);
    if (near.y < -9.0 || near.w == 0.0) return;
    vec3 p = place.xyz;
    float mirror = hand_side == 0 ? 1.0 : -1.0;
    vec3 chip = vec3(mirror * 2.0, 0.0, -44.0);
    vec2 q = abs(p.xz - chip.xz);
    float copper = 0.0, way = 0.0, lane = 0.0, kind = 1.0;
    float nearest = 99.0;
    for (int finger = 0; finger < 5; ++finger) {
      int first = finger == 0 ? 3 : 2 + 5 * finger, last = finger == 0 ? 5 : first + 3;
      vec3 knuckle = hand_rest_joint[first];
      vec3 up = finger == 0 ? normalize(vec3(mirror * 0.65, 0.75, -0.1)) : vec3(0.0, 1.0, 0.0);
      float start = 0.0;
      vec3 from = chip + vec3(mirror * (finger == 0 ? 11.0 : 11.0 - 5.5 * float(finger)), 0.0, finger == 0 ? 4.0 : -11.0);
      // The polyline from the chip over the joints to the tip.
      for (int part = 0; part < 4; ++part) {
        vec3 a = part == 0 ? from : hand_rest_joint[first + part - 1];
        if (finger == 0 && part == 3) break;
        vec3 b = part == 0 ? knuckle : hand_rest_joint[first + part];
        if (part == 0 && finger > 0) { a.y = b.y; }
        vec3 along = normalize(b - a);
        float size = distance(a, b), s = dot(p - a, along);
        float d = dot(p - a, normalize(cross(along, up)));
        bool is_last = finger == 0 ? part == 2 : part == 3;
        if (s > (part == 0 ? -1.0 : 0.0) && s < size + (is_last ? -2.0 : 0.0) && abs(d) < 7.5 && abs(d) < nearest) {
          nearest = abs(d);
          float whole = start + s;
          float best = 0.0;
          for (int k = -1; k <= 1; ++k) {
            float end = finger == 0 ? (k == 0 ? 200.0 : 66.0 + 6.0 * float(k)) : (k == 0 ? 300.0 : 118.0 + 9.0 * hash(float(finger * 3 + k)));
            float off = d - lane_at(float(k), whole, float(finger));
            float metal = whole < end ? line(off, k == 0 ? 1.5 : 1.1) : 0.0;
            float via = length(vec2(off, whole - end));
            metal = max(metal, max(line(via - 1.7, 1.0), 0.0));
            if (metal > best) {
              best = metal;
              copper = metal;
              way = whole;
              lane = float(3 * finger + k + 2);
              kind = 1.0;
            }
          }
        }
        start += size;
        float pad = distance(p, b), radius = is_last ? 3.6 : 4.6;
        pad = sqrt(max(pad * pad - pow(dot(p - b, normalize(cross(along, normalize(cross(along, up))))), 2.0), 0.0));
        if (pad < radius + 1.6 && distance(p, b) < 16.0) {
          copper = max(line(pad - radius, 1.3), disc(pad, radius - 2.2));
          way = start;
          lane = float(3 * finger + 2);
          kind = 2.0;
          nearest = 0.0;
        }
      }
    }
    // The chip with its legs.
    if (max(q.x, q.y) < 12.5) {
      float legs = abs(mod(q.x < q.y ? p.x - chip.x : p.z - chip.z, 3.4) - 1.7);
      float body = max(q.x, q.y);
      copper = max(line(body - 8.0, 1.2), body > 8.0 && body < 12.0 && min(q.x, q.y) < 7.6 ? line(legs, 1.3) : 0.0);
      float core = max(abs(q.x), abs(q.y));
      copper = max(copper, line(core - 4.2, 0.9));
      copper = max(copper, disc(length(p.xz - chip.xz), 1.6));
      kind = 3.0;
      way = length(p.xz - chip.xz);
      lane = 17.0;
    }
    // A bus of lanes to the arm.
    if (p.z > -32.0 && max(q.x, q.y) >= 12.5 && copper == 0.0) {
      float bend = clamp((p.z + 26.0) * 0.35, 0.0, 5.0);
      float x = (p.x - chip.x) / (1.0 + 0.06 * bend), k = floor(x / 3.4);
      if (abs(k + 0.5) < 3.0) {
        copper = line(x - 3.4 * (k + 0.5), 1.1);
        way = 30.0 + p.z + 32.0;
        lane = 20.0 + k;
        kind = 1.0;
      }
    }
    // Short stubs elsewhere.
    if (copper == 0.0 && nearest > 8.0) {
      vec2 grid = p.xz / 6.0, i = floor(grid), f = (grid - i - 0.5) * 6.0;
      float n = hash(i.x * 7.0 + i.y * 13.0);
      copper = n > 0.45 ? max(line(length(f) - 1.4, 0.9), n > 0.7 ? line(f.x, 0.9) * step(1.4, abs(f.y)) : 0.0) * 0.8 : 0.0;
      way = length(p.xz - chip.xz);
      lane = 30.0 + n;
      kind = 1.0;
    }
    gl_FragColor = vec4(copper * (1.0 - smoothstep(14.0, 42.0, p.z)), way, lane, kind);
    return;
  }
  vec4 it = texelFetch(board, texel, 0);
  float own = hash(it.b), period = mix(150.0, 55.0, traffic) * (0.7 + 0.6 * own);
  float phase = fract((it.g - speed * TIME * (0.8 + 0.4 * own)) / period + own);
  float packet = it.a == 3.0 ? 0.0 : pow(phase, 10.0);
  float beat = 0.5 + 0.5 * sin(3.0 * TIME), pad = it.a == 2.0 ? 1.0 : 0.0, chip = it.a == 3.0 ? 1.0 : 0.0;
  packet = mix(packet, pow(phase, 3.0), pad);
  vec3 light = trace.rgb * (0.75 + 0.25 * pad) + pulse.rgb * packet * 1.2;
  light += (mix(vec3(1.0), pulse.rgb, 0.5) * (0.35 + 0.4 * beat)) * chip;
  light += vec3(1.0) * pow(packet, 4.0) * 0.6;
  gl_FragColor = vec4(light * it.r, 1.0);
}
