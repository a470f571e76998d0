/*{
  "DESCRIPTION": "Ink: the other hand's index finger draws; alone, ink wells from the finger tips. It flows and fades.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "first", "LABEL": "Ink", "TYPE": "color", "DEFAULT": [0.05, 0.55, 1.0, 1.0]},
    {"NAME": "second", "LABEL": "Second ink", "TYPE": "color", "DEFAULT": [1.0, 0.08, 0.55, 1.0]},
    {"NAME": "lasts", "LABEL": "Seconds it lasts", "TYPE": "float", "DEFAULT": 7.0, "MIN": 0.5, "MAX": 60.0},
    {"NAME": "swirl", "LABEL": "Swirl", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 3.0},
    {"NAME": "nib", "LABEL": "Width of the finger's line, mm", "TYPE": "float", "DEFAULT": 9.0, "MIN": 2.0, "MAX": 30.0}
  ],
  "PASSES": [
    {"TARGET": "fluid", "PERSISTENT": true, "FLOAT": true, "WIDTH": "$WIDTH/2", "HEIGHT": "$HEIGHT/2"},
    {}
  ]
}*/
// fluid: r: the first ink, g: the second; b: the fresh line of the finger.

float hash(vec2 p) {
  p = fract(p * vec2(0.3183, 0.3678));
  p += dot(p, p + 17.13);
  return fract(p.x * p.y * 31.7);
}
// Noise and its gradient.
vec3 noise(vec2 p) {
  vec2 i = floor(p), f = fract(p), u = f * f * (3.0 - 2.0 * f), du = 6.0 * f * (1.0 - f);
  float a = hash(i), b = hash(i + vec2(1.0, 0.0)), c = hash(i + vec2(0.0, 1.0)), d = hash(i + vec2(1.0, 1.0));
  float k = a - b - c + d;
  return vec3(a + (b - a) * u.x + (c - a) * u.y + k * u.x * u.y, du * (vec2(b - a, c - a) + k * u.yx));
}

void main() {
  if (PASSINDEX == 0) {
    vec4 place = texture(hand_rest, isf_FragNormCoord);
    gl_FragColor = vec4(0.0);
    if (place.w == 0.0) return;
    vec3 p = place.xyz;
    // Swirls that turn slowly, mm/s, without sources; ink from the tips flows to the arm.
    vec2 big = noise(0.045 * p.xz + vec2(0.0, -0.10 * TIME)).zy, small = noise(0.09 * p.xz + vec2(0.13 * TIME, 5.0)).zy;
    vec2 flow = swirl * vec2(1.0, -1.0) * (42.0 * big + 30.0 * small);
    float drawn = other_there == 1 && hand_there == 1 ? 1.0 - smoothstep(0.13, 0.19, distance(other_joint[10], hand_joint[12])) : 0.0;
    flow.y += mix(30.0, 4.0, drawn);
    float mm = (hand_back_uv[14].y - hand_back_uv[11].y) / (hand_rest_joint[11].z - hand_rest_joint[14].z);
    vec2 uv_flow = flow * vec2(sign(place.w) * RENDERSIZE.y / RENDERSIZE.x, -1.0) * mm;
    vec4 old = texture(fluid, isf_FragNormCoord - uv_flow * min(TIMEDELTA, 0.05));
    old *= exp(-TIMEDELTA / lasts);
    float well = 0.0, other_well = 0.0;
    for (int finger = 0; finger < 5; ++finger) {
      float d = distance(p, hand_rest_joint[5 + 5 * finger]), here = exp(-d * d / 60.0);
      float beat = smoothstep(-0.3, 0.6, sin(0.9 * TIME + 2.4 * float(finger)));
      if (finger % 2 == 0) well = max(well, here * beat);
      else other_well = max(other_well, here * (1.0 - beat));
    }
    if (drawn > 0.0) {
      float d = 1000.0 * distance(texture(hand_position, isf_FragNormCoord).xyz, other_joint[10]);
      float line = 1.0 - smoothstep(0.35 * nib, 1.1 * nib, max(d - 9.0, 0.0));
      float mixing = 0.5 + 0.5 * sin(0.8 * TIME);
      well = mix(well, line * mixing, drawn);
      other_well = mix(other_well, line * (1.0 - mixing), drawn);
      old.b = max(old.b * exp(-3.0 * TIMEDELTA), line);
    } else {
      old.b *= exp(-3.0 * TIMEDELTA);
    }
    gl_FragColor = vec4(clamp(old.rg + TIMEDELTA * 7.0 * vec2(well, other_well), 0.0, 1.3), old.b, 1.0);
    return;
  }
  vec4 it = texture(fluid, isf_FragNormCoord);
  vec4 place = texelFetch(hand_rest, ivec2(gl_FragCoord.xy), 0);
  float here = it.r + it.g, slope = 1.5 * length(vec2(dFdx(here), dFdy(here)));
  vec2 dense = smoothstep(vec2(0.03), vec2(0.75), it.rg);
  vec3 light = first.rgb * dense.r * 1.05 + second.rgb * dense.g * 1.05;
  light += mix(first.rgb, second.rgb, it.g / (here + 0.01)) * min(1.0, slope * 7.0) * 0.9;
  light += vec3(1.0, 0.95, 0.9) * it.b * it.b * 0.8 + vec3(1.0) * 0.35 * dense.r * dense.g;
  float arm = 1.0 - smoothstep(14.0, 42.0, place.z);
  gl_FragColor = vec4(place.w == 0.0 ? vec3(0.0) : light * arm, 1.0);
}
