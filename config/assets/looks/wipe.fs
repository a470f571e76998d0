/*{
  "DESCRIPTION": "A transition: a glowing edge runs from the wrist to the finger tips.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Transition"],
  "INPUTS": [
    {"NAME": "startImage", "TYPE": "image"},
    {"NAME": "endImage", "TYPE": "image"},
    {"NAME": "progress", "TYPE": "float", "DEFAULT": 0.0, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "edge", "LABEL": "Edge", "TYPE": "color", "DEFAULT": [1.0, 0.85, 0.55, 1.0]},
    {"NAME": "width", "LABEL": "Width of the edge, mm", "TYPE": "float", "DEFAULT": 9.0, "MIN": 1.0, "MAX": 60.0}
  ]
}*/
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 from = texelFetch(startImage, texel, 0), to = texelFetch(endImage, texel, 0), place = texelFetch(hand_rest, texel, 0);
  const float kArm_mm = 60.0, kTips_mm = 190.0;
  float margin = 4.0 * width, front = mix(-kArm_mm - margin, kTips_mm + margin, progress);
  float behind = front + place.z + 3.0 * sin(0.16 * place.x);
  vec4 mixed = mix(from, to, smoothstep(-0.5 * width, 0.5 * width, behind));
  float glow = exp(-behind * behind / (width * width)) * (place.w == 0.0 ? 0.0 : 1.0);
  gl_FragColor = mix(mixed, vec4(edge.rgb, 1.0), glow * edge.a);
}
