/*{
  "DESCRIPTION": "Waves of light that run from the wrist to the finger tips.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Generator"],
  "INPUTS": [
    {"NAME": "speed", "LABEL": "Speed", "TYPE": "float", "DEFAULT": 60.0, "MIN": 0.0, "MAX": 300.0},
    {"NAME": "length", "LABEL": "Length of a wave, mm", "TYPE": "float", "DEFAULT": 38.0, "MIN": 5.0, "MAX": 200.0},
    {"NAME": "tint", "LABEL": "Colour", "TYPE": "color", "DEFAULT": [0.1, 0.75, 1.0, 1.0]}
  ]
}*/
void main() {
  vec4 place = texture(hand_rest, isf_FragNormCoord);
  float bend = 6.0 * sin(0.09 * place.x + 0.7 * TIME);
  float phase = (-place.z + bend - speed * TIME) / length;
  float crest = pow(0.5 + 0.5 * cos(6.2832 * phase), 5.0);
  vec3 colour = mix(0.10 * tint.rgb, tint.rgb, crest) + vec3(0.85) * pow(crest, 6.0);
  gl_FragColor = vec4(colour * (1.0 - smoothstep(14.0, 42.0, place.z)), 1.0);
}
