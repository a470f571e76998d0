/*{
  "DESCRIPTION": "An X-ray: our own bones under glowing flesh, and a beam that sweeps over them.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "tint", "LABEL": "Colour", "TYPE": "color", "DEFAULT": [0.22, 0.66, 1.0, 1.0]},
    {"NAME": "flesh", "LABEL": "Flesh", "TYPE": "float", "DEFAULT": 0.6, "MIN": 0.0, "MAX": 1.5},
    {"NAME": "sweep", "LABEL": "Sweeps a minute", "TYPE": "float", "DEFAULT": 12.0, "MIN": 0.0, "MAX": 60.0},
    {"NAME": "negative", "LABEL": "Negative", "TYPE": "bool", "DEFAULT": false}
  ],
  "PASSES": [{"TARGET": "bones", "ONCE": true}, {}]
}*/
// The buffer: r: bone, g: flesh, b: place along the hand.

float side() { return hand_side == 0 ? 1.0 : -1.0; }

// A bone from a to b, seen along `up`: half widths of shaft, base and head, mm. 0..1.
float bone(vec3 p, vec3 a, vec3 b, vec3 up, float shaft, float base, float head) {
  vec3 axis = normalize(b - a), across = normalize(cross(axis, up));
  float length_mm = distance(a, b) - 1.6, s = dot(p - a, axis) - 0.8, d = dot(p - a, across);
  float to_base = max(s, 0.0), to_head = max(length_mm - s, 0.0);
  float width = shaft + (base - shaft) * exp(-pow(to_base / 6.5, 2.0)) + (head - shaft) * exp(-pow(to_head / 5.5, 2.0));
  float over = max(max(-s, s - length_mm), 0.0);
  float inside = 1.0 - (d * d) / (width * width) - over * over / (0.06 * base * base);
  // Two condyles at the head.
  float notch = exp(-pow((length_mm - s) / 1.8, 2.0)) * exp(-pow(d / (0.35 * head), 2.0));
  return clamp(inside - 0.7 * notch, 0.0, 1.0);
}

float pebble(vec3 p, vec3 at, vec2 size, float turn) {
  vec2 d = p.xz - at.xz;
  d = vec2(cos(turn) * d.x - sin(turn) * d.y, sin(turn) * d.x + cos(turn) * d.y) / size;
  vec2 q = d * d;
  return clamp(1.0 - q.x * q.x - q.y * q.y - 0.9 * q.x * q.y, 0.0, 1.0);
}

// An edge that is brighter than the inside, as cortical bone is.
float cortex(float inside) {
  return inside <= 0.0 ? 0.0 : smoothstep(0.0, 0.30, inside) * (0.62 + 0.46 * exp(-pow((inside - 0.32) / 0.20, 2.0)));
}

float wrist(vec3 p) {
  float s = side(), most = 0.0;
  most = max(most, pebble(p, vec3(s * 13.0, 0.0, -5.5), vec2(7.0, 5.0), s * 0.6));
  most = max(most, pebble(p, vec3(s * 3.5, 0.0, -4.2), vec2(5.2, 4.4), 0.0));
  most = max(most, pebble(p, vec3(s * -6.5, 0.0, -7.0), vec2(5.0, 4.2), s * -0.4));
  most = max(most, pebble(p, vec3(s * -11.5, 0.0, -11.0), vec2(3.4, 3.6), 0.0));
  most = max(most, pebble(p, vec3(s * 20.0, 0.0, -15.0), vec2(5.2, 4.6), s * 0.5));
  most = max(most, pebble(p, vec3(s * 12.2, 0.0, -17.5), vec2(3.4, 4.4), 0.0));
  most = max(most, pebble(p, vec3(s * 4.0, 0.0, -16.0), vec2(4.5, 7.2), s * -0.1));
  most = max(most, pebble(p, vec3(s * -5.8, 0.0, -16.8), vec2(5.2, 5.6), s * 0.3));
  vec3 up = vec3(0.0, 1.0, 0.0);
  most = max(most, bone(p, vec3(s * 9.0, 0.0, 90.0), vec3(s * 7.0, 0.0, 1.5), up, 6.0, 8.0, 13.0));
  most = max(most, bone(p, vec3(s * -11.0, 0.0, 90.0), vec3(s * -11.5, 0.0, 3.0), up, 4.6, 6.0, 6.6));
  return most;
}

float skeleton(vec3 p) {
  vec3 up = vec3(0.0, 1.0, 0.0), thumb_up = normalize(vec3(side() * 0.65, 0.75, -0.1));
  float most = p.z > -30.0 ? wrist(p) : 0.0;
  most = max(most, bone(p, hand_rest_joint[2], hand_rest_joint[3], thumb_up, 4.2, 7.2, 6.4));
  most = max(most, bone(p, hand_rest_joint[3], hand_rest_joint[4], thumb_up, 3.4, 6.6, 5.2));
  most = max(most, bone(p, hand_rest_joint[4], mix(hand_rest_joint[4], hand_rest_joint[5], 0.9), thumb_up, 2.4, 5.6, 4.2));
  for (int finger = 0; finger < 4; ++finger) {
    int j = 6 + 5 * finger;
    float thick = finger == 3 ? 0.84 : 1.0;
    most = max(most, bone(p, hand_rest_joint[j], hand_rest_joint[j + 1], up, 3.3 * thick, 6.0 * thick, 6.2 * thick));
    most = max(most, bone(p, hand_rest_joint[j + 1], hand_rest_joint[j + 2], up, 3.1 * thick, 6.0 * thick, 5.0 * thick));
    most = max(most, bone(p, hand_rest_joint[j + 2], hand_rest_joint[j + 3], up, 2.7 * thick, 5.2 * thick, 4.4 * thick));
    most = max(most, bone(p, hand_rest_joint[j + 3], mix(hand_rest_joint[j + 3], hand_rest_joint[j + 4], 0.92), up, 1.9 * thick, 4.4 * thick, 3.6 * thick));
  }
  return most;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec4 near = texelFetch(hand_bone, texel, 0);
    if (near.y < -9.0 || near.w == 0.0) {
      gl_FragColor = vec4(0.0, 0.0, 0.0, 1.0);
      return;
    }
    vec3 place = texelFetch(hand_rest, texel, 0).xyz;
    float soft = 1.0 - smoothstep(0.0, 26.0, near.y);
    gl_FragColor = vec4(cortex(skeleton(place)), 0.3 + 0.7 * soft * soft, clamp(0.5 - place.z / 400.0, 0.0, 1.0), 1.0);
    return;
  }
  vec4 it = texelFetch(bones, texel, 0);
  float arm = smoothstep(0.385, 0.445, it.b);
  float beam = fract(sweep * TIME / 60.0) * 1.5 - 0.1, behind = beam - it.b;
  float lit = exp(-1500.0 * behind * behind) + (behind > 0.0 ? 0.45 * exp(-8.0 * behind) : 0.0);
  float body = flesh * it.g * arm * (1.05 + 1.3 * lit);
  float hard = it.r * arm * (0.95 + 0.45 * lit);
  vec3 deep = tint.rgb * tint.rgb, pale = mix(tint.rgb, vec3(1.0), 0.10 + 0.65 * it.r * it.r);
  vec3 light = deep * body * (1.0 - 0.7 * it.r) + pale * hard;
  if (negative) light = deep * it.g * flesh * arm * (0.9 + lit) + tint.rgb * arm * max(0.0, 0.85 - hard);
  gl_FragColor = vec4(it.g > 0.0 ? light : vec3(0.0), 1.0);
}
