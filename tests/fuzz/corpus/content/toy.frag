//! common
#extension GL_EXT_x : enable
float half(float x) { return 0.5 * x; }
//! buffer A
//! iChannel0 = buffer A nearest repeat
void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p); }
//! image
//! iChannel0 = buffer A linear mirror
//! iChannel1 = sound
//! iChannel2 = a.png clamp
//! iChannel3 = input
void mainImage(out vec4 c, in vec2 p) { /* no */ c = vec4(half(iTime)); }
