/*{
  "DESCRIPTION": "A transition: the first picture burns away in patches, with a bright edge.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Transition"],
  "INPUTS": [
    {"NAME": "startImage", "TYPE": "image"},
    {"NAME": "endImage", "TYPE": "image"},
    {"NAME": "progress", "TYPE": "float", "DEFAULT": 0.0, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "edge", "LABEL": "Edge", "TYPE": "color", "DEFAULT": [1.0, 0.62, 0.2, 1.0]},
    {"NAME": "size", "LABEL": "Size of the patches, mm", "TYPE": "float", "DEFAULT": 14.0, "MIN": 2.0, "MAX": 60.0}
  ],
  "PASSES": [{"TARGET": "order", "ONCE": true}, {}]
}*/
// order: r: when a texel turns, 0..1.

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

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    vec2 p = texelFetch(hand_rest, texel, 0).xz / size;
    float when = 0.55 * noise(p) + 0.3 * noise(2.3 * p + 9.0) + 0.15 * noise(5.1 * p + 30.0);
    gl_FragColor = vec4(clamp(1.5 * when - 0.25, 0.0, 1.0), 0.0, 0.0, 1.0);
    return;
  }
  float since = mix(-0.12, 1.12, progress) - texelFetch(order, texel, 0).r;
  vec4 mixed = mix(texelFetch(startImage, texel, 0), texelFetch(endImage, texel, 0), smoothstep(-0.01, 0.01, since));
  float glow = exp(-since * since / 0.0016) * mixed.a;
  gl_FragColor = mix(mixed, vec4(edge.rgb, 1.0), glow * edge.a);
}
