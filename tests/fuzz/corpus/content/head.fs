/*{
  "ISFVSN": "2", // comment
  "INPUTS": [
    {"NAME": "inputImage", "TYPE": "image"},
    {"NAME": "size", "TYPE": "float", "MIN": .5, "MAX": 10., "DEFAULT": +2},
    {"NAME": "kind", "TYPE": "long", "VALUES": [0, 1], "LABELS": ["a", "b"], "DEFAULT": 1},
    {"NAME": "at", "TYPE": "point2D", "DEFAULT": [0.5, 0.5], "MIN": [0, 0], "MAX": [1, 1]},
    {"NAME": "tint", "TYPE": "color", "DEFAULT": [1, 0, 0]},
    {"NAME": "on", "TYPE": "bool"}, {"NAME": "hit", "TYPE": "event"},
    {"NAME": "bands", "TYPE": "audioFFT", "MAX": 64},
  ],
  "IMPORTED": {"pic": {"PATH": "a.png"}},
  "PERSISTENT_BUFFERS": {"old": {"WIDTH": "$WIDTH", "FLOAT": true}},
  "PASSES": [{"TARGET": "half", "WIDTH": "$WIDTH/$size", "HEIGHT": 10, "PERSISTENT": 1, "ONCE": true}, {}]
}*/
#version 120
void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage); }
