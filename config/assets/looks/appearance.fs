/*{
  "DESCRIPTION": "Makes a picture look alike on all skin: evens out what is far or faces away, and takes the colour of the skin and the light of the room out of it by a photo.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Filter"],
  "INPUTS": [
    {"NAME": "inputImage", "TYPE": "image"},
    {"NAME": "evenness", "LABEL": "Even brightness", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "reach", "LABEL": "Least share of light that is evened", "TYPE": "float", "DEFAULT": 0.5, "MIN": 0.1, "MAX": 1.0},
    {"NAME": "photo", "LABEL": "A hand and paper in white light", "TYPE": "image"},
    {"NAME": "skin", "LABEL": "Where the photo shows lit skin, from the lower left", "TYPE": "point2D", "DEFAULT": [0.5, 0.5], "MIN": [0, 0], "MAX": [1, 1]},
    {"NAME": "paper", "LABEL": "Where it shows lit paper", "TYPE": "point2D", "DEFAULT": [0.5, 0.9], "MIN": [0, 0], "MAX": [1, 1]},
    {"NAME": "room", "LABEL": "Where it shows paper in the light of the room alone", "TYPE": "point2D", "DEFAULT": [0.1, 0.9], "MIN": [0, 0], "MAX": [1, 1]},
    {"NAME": "lift", "LABEL": "Black becomes a grey that hides the skin", "TYPE": "float", "DEFAULT": 0.0, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "compensation", "LABEL": "How much of the photo is used", "TYPE": "float", "DEFAULT": 1.0, "MIN": 0.0, "MAX": 1.0}
  ],
  "PASSES": [{"TARGET": "tone", "FLOAT": true, "ONCE": true, "WIDTH": 2, "HEIGHT": 1}, {}]
}*/
// All light is linear, in parts of the projector's white on a sheet of paper that faces it as far
// away as the palm. tone: of the photo: the reflectance of the skin, of that of paper, and the
// light of the room.
//
// Light p on skin of reflectance k looks like k (c p + r), c the share of the light that skin gets
// by its angle and distance, r the light of the room. It shall look like the wanted colour does on
// grey paper: white as bright as the light makes the weakest colour of the skin, black, if it is
// lifted, like its strongest colour in the light of the room.

vec3 light_of(vec3 level) {
  return mix(level / 12.92, pow((level + 0.055) / 1.055, vec3(2.4)), step(0.04045, level));
}
vec3 level_of(vec3 light) {
  return mix(12.92 * light, 1.055 * pow(max(light, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, light));
}

// The mean of 2 % of the photo.
vec3 seen_at(vec2 place) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 25; ++i) sum += light_of(texture(photo, place + 0.005 * vec2(float(i % 5 - 2), float(i / 5 - 2))).rgb);
  return sum / 25.0;
}

void main() {
  if (PASSINDEX == 0) {
    bool is_there = texture(photo, vec2(0.5)).a > 0.0;
    vec3 lit = max(seen_at(paper), 0.001), dark = min(seen_at(room), 0.9 * lit);
    vec3 reflectance = clamp(seen_at(skin) / lit, 0.05, 1.0), ambient = dark / (lit - dark);
    if (!is_there) reflectance = vec3(1.0), ambient = vec3(0.0);
    bool is_room = gl_FragCoord.x > 1.0;
    gl_FragColor = vec4(is_room ? compensation * ambient : mix(vec3(1.0), reflectance, compensation), 1.0);
    return;
  }
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 base = texelFetch(inputImage, texel, 0), place = texture(hand_position, isf_FragNormCoord);
  float share = 1.0;
  if (hand_there == 1 && place.w != 0.0) {
    vec3 normal = normalize(texture(hand_surface_normal, isf_FragNormCoord).xyz);
    float nearness = dot(hand_joint[0], hand_joint[0]) / max(dot(place.xyz, place.xyz), 1e-6);
    share = max(-dot(normal, normalize(place.xyz)), 0.0) * nearness;
  }
  vec3 reflectance = texelFetch(tone, ivec2(0, 0), 0).rgb, ambient = texelFetch(tone, ivec2(1, 0), 0).rgb;
  float most = mix(1.0, reach, evenness);
  vec3 whites = reflectance * (most + ambient), blacks = reflectance * ambient;
  float white = min(whites.r, min(whites.g, whites.b)), black = lift * min(max(blacks.r, max(blacks.g, blacks.b)), white);
  vec3 wanted = mix(vec3(black), vec3(white), light_of(base.rgb));
  vec3 light = (wanted / reflectance - ambient) / mix(1.0, max(share, reach), evenness);
  gl_FragColor = vec4(level_of(clamp(light, 0.0, 1.0)), base.a);
}
