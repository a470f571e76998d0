/*{
  "DESCRIPTION": "Lights what is below it as a surface of the hand: a movable light, gloss, relief, shadows of the fingers, a rim, bones.",
  "CREDIT": "handcast",
  "ISFVSN": "2",
  "CATEGORIES": ["Filter"],
  "INPUTS": [
    {"NAME": "inputImage", "TYPE": "image"},
    {"NAME": "kind", "LABEL": "Light", "TYPE": "long", "VALUES": [0, 1, 2, 3, 4], "LABELS": ["directional", "point", "projector", "palm", "orbit"], "DEFAULT": 4},
    {"NAME": "x", "LABEL": "To the right, m", "TYPE": "float", "DEFAULT": -0.3, "MIN": -2.0, "MAX": 2.0},
    {"NAME": "y", "LABEL": "Down, m", "TYPE": "float", "DEFAULT": -0.4, "MIN": -2.0, "MAX": 2.0},
    {"NAME": "z", "LABEL": "Away from the camera, m", "TYPE": "float", "DEFAULT": 0.2, "MIN": -2.0, "MAX": 3.0},
    {"NAME": "colour", "LABEL": "Colour", "TYPE": "color", "DEFAULT": [1.0, 0.96, 0.88, 1.0]},
    {"NAME": "strength", "LABEL": "Strength", "TYPE": "float", "DEFAULT": 1.1, "MIN": 0.0, "MAX": 4.0},
    {"NAME": "ambient", "LABEL": "Ambient light", "TYPE": "float", "DEFAULT": 0.15, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "specular", "LABEL": "Gloss", "TYPE": "float", "DEFAULT": 0.5, "MIN": 0.0, "MAX": 2.0},
    {"NAME": "roughness", "LABEL": "Roughness", "TYPE": "float", "DEFAULT": 0.35, "MIN": 0.05, "MAX": 1.0},
    {"NAME": "metalness", "LABEL": "Metalness", "TYPE": "float", "DEFAULT": 0.0, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "relief", "LABEL": "Relief by brightness, mm", "TYPE": "float", "DEFAULT": 0.6, "MIN": -3.0, "MAX": 3.0},
    {"NAME": "normals", "LABEL": "Normal map, green is up", "TYPE": "image"},
    {"NAME": "roughnesses", "LABEL": "Roughness map, white is rough", "TYPE": "image"},
    {"NAME": "shadows", "LABEL": "Shadows", "TYPE": "float", "DEFAULT": 0.9, "MIN": 0.0, "MAX": 1.0},
    {"NAME": "softness", "LABEL": "Softness of shadows", "TYPE": "float", "DEFAULT": 0.12, "MIN": 0.01, "MAX": 0.5},
    {"NAME": "rim", "LABEL": "Rim", "TYPE": "float", "DEFAULT": 0.25, "MIN": 0.0, "MAX": 2.0},
    {"NAME": "skeleton", "LABEL": "Bones", "TYPE": "float", "DEFAULT": 0.0, "MIN": 0.0, "MAX": 1.0}
  ],
  "PASSES": [{"TARGET": "bones", "ONCE": true}, {"TARGET": "shade", "WIDTH": "$WIDTH/4", "HEIGHT": "$HEIGHT/4"}, {}]
}*/
// All in camera space: x to the right, y down, z forward, m. The light is directional (x, y, z is
// the direction to it), a point (x, y, z is its place), the projector (taken to stand at the
// camera), fixed 12 cm in front of the palm, or orbiting it. The viewer stands at the camera.
// bones: r: lines along the bones, g: 0 on the arm. shade: r: how much of the light fingers and
// hand take away.

const float kOrbit_m = 0.16;

// From a place to the light, unit length.
vec3 to_light(vec3 at) {
  vec3 palm = hand_joint[0], place = vec3(x, y, z);
  if (kind == 0) return normalize(place + vec3(0.0, 0.0, 1e-6));
  if (kind == 2) place = vec3(0.0);
  if (kind == 3) place = palm + 0.12 * hand_normal;
  if (kind == 4) place = palm + kOrbit_m * vec3(cos(0.9 * TIME), 0.8 * sin(0.9 * TIME), -0.75);
  return normalize(place - at);
}

float radius_of(int joint) {
  if (joint < 6) return joint == 2 ? 0.014 : joint == 5 ? 0.007 : 0.010;
  int k = (joint - 1) % 5;
  return k == 0 ? 0.013 : k == 1 ? 0.0095 : k == 2 ? 0.0085 : 0.0075;
}

// How much of a ray to the light the bone between two joints takes away.
float shadow_of(vec3 from, vec3 ray, vec3 a, vec3 b, float radius) {
  vec3 way = b - a, r = from - a;
  float e = dot(way, way), f = dot(way, r), c = dot(ray, r), k = dot(ray, way);
  float s = max((k * f - c * e) / max(e - k * k, 1e-9), 0.0);
  float t = clamp((k * s + f) / max(e, 1e-9), 0.0, 1.0);
  s = k * t - c;
  float away = length(r + ray * s - way * t), soft = 0.001 + softness * max(s, 0.0);
  return s < 0.5 * radius ? 0.0 : 1.0 - smoothstep(radius - soft, radius + soft, away);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (PASSINDEX == 0) {
    int j = int(texelFetch(hand_bone, texel, 0).x + 0.5);
    vec3 p = texelFetch(hand_rest, texel, 0).xyz;
    bool is_tip = j == 5 || (j > 5 && j % 5 == 0);
    int from = j < 2 ? 1 : is_tip ? j - 1 : j, to = j < 2 ? 12 : from + 1;
    vec3 up = j > 1 && j < 6 ? vec3(hand_side == 0 ? 0.65 : -0.65, 0.75, -0.1) : vec3(0.0, 1.0, 0.0);
    vec3 begin = hand_rest_joint[from], way = hand_rest_joint[to] - begin;
    float away = dot(p - begin, normalize(cross(way, up))), s = dot(p - begin, normalize(way));
    float bone = j < 2 ? 0.0 : 1.0 - smoothstep(0.8, 1.5, abs(away));
    bone = max(bone, 1.0 - smoothstep(2.4, 3.1, length(vec2(away, min(s, length(way) - s)))));
    gl_FragColor = vec4(bone, 1.0 - smoothstep(14.0, 42.0, p.z), 0.0, 1.0);
    return;
  }
  if (PASSINDEX == 1) {
    vec3 at = texture(hand_position, isf_FragNormCoord).xyz, normal = texture(hand_surface_normal, isf_FragNormCoord).xyz;
    int own = int(texelFetch(hand_bone, min(4 * texel + 2, textureSize(hand_bone, 0) - 1), 0).x + 0.5);
    vec3 ray = to_light(at);
    float taken = 0.0;
    for (int j = 2; j < 25; ++j) {
      bool is_tip = j == 5 || (j > 5 && j % 5 == 0), is_root = j == 2 || (j > 5 && j % 5 == 1);
      // Not its own bone and the next ones; all of the hand is one.
      bool is_own = abs(j - own) < 2 || (is_root && (own < 3 || own % 5 == 1));
      if (is_tip || is_own) continue;
      taken = max(taken, shadow_of(at + 0.002 * normal, ray, hand_joint[j], hand_joint[j + 1], radius_of(j)));
    }
    gl_FragColor = vec4(taken, 0.0, 0.0, 1.0);
    return;
  }
  vec4 base = texelFetch(inputImage, texel, 0), place = texture(hand_position, isf_FragNormCoord);
  gl_FragColor = base;
  if (hand_there == 0 || place.w == 0.0) return;
  vec3 at = place.xyz, smooth_normal = normalize(texture(hand_surface_normal, isf_FragNormCoord).xyz), normal = smooth_normal;

  // Relief: the slope of the brightness along the surface.
  vec3 along_x = dFdx(at), along_y = dFdy(at);
  const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
  ivec2 last = textureSize(inputImage, 0) - 1;
  float height = dot(base.rgb, kLuminance) * base.a;
  vec4 right = texelFetch(inputImage, min(texel + ivec2(1, 0), last), 0), above = texelFetch(inputImage, min(texel + ivec2(0, 1), last), 0);
  float rise_x = 0.001 * relief * (dot(right.rgb, kLuminance) * right.a - height), rise_y = 0.001 * relief * (dot(above.rgb, kLuminance) * above.a - height);
  vec3 r1 = cross(along_y, normal), r2 = cross(normal, along_x);
  float area = dot(along_x, r1);
  vec3 bent = abs(area) * normal - sign(area) * (rise_x * r1 + rise_y * r2);
  if (dot(bent, bent) > 1e-20) normal = normalize(bent);
  vec4 map = texture(normals, isf_FragNormCoord);
  if (map.a > 0.0) {
    vec3 slope = 2.0 * map.xyz - 1.0;
    normal = normalize(slope.x * normalize(along_x + 1e-9) + slope.y * normalize(along_y + 1e-9) + slope.z * normal);
  }

  vec3 ray = to_light(at), view = normalize(-at), middle = normalize(ray + view);
  float shade = shadows * texture(shade, isf_FragNormCoord).r;
  float nl = max(dot(normal, ray), 0.0), nv = max(dot(normal, view), 0.02), nh = max(dot(normal, middle), 0.0), vh = max(dot(view, middle), 0.0);
  nl *= smoothstep(-0.05, 0.1, dot(smooth_normal, ray));
  // GGX: distribution, masking by Smith (height-correlated), Fresnel by Schlick.
  vec4 rough = texture(roughnesses, isf_FragNormCoord);
  float r = roughness * (rough.a > 0.0 ? rough.g : 1.0), a = max(r * r, 0.004), a2 = a * a, spread = nh * nh * (a2 - 1.0) + 1.0;
  float d = a2 / (3.14159265 * spread * spread);
  float v = 0.5 / max(nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2), 1e-4);
  float slant = max(1.0 - vh, 0.0), grazing = slant * slant, edge = max(1.0 - nv, 0.0);
  vec3 f0 = mix(vec3(0.04), base.rgb, metalness), f = f0 + (1.0 - f0) * grazing * grazing * slant;
  vec2 rest = texelFetch(bones, texel, 0).rg;
  float arm = rest.g;
  vec3 gloss = arm * specular * d * v * f * nl * 3.14159265;

  vec3 lamp = strength * (1.0 - shade) * colour.rgb;
  vec3 light = base.rgb * (ambient + (1.0 - metalness) * nl * lamp) + min(gloss, vec3(1.5)) * lamp;
  light += arm * rim * edge * edge * edge * colour.rgb;

  light = mix(light, vec3(0.8, 0.95, 1.0), skeleton * rest.r);
  gl_FragColor = vec4(clamp(light, 0.0, 1.0), base.a);
}
