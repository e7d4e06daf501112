// fades.ts: pixels that the other of the two parts has are left to it.
#ifdef FADING
uniform vec2 uFade;  // how far, 0 .. 1; whether this part leaves
void leaveToTheOther() {
  float pattern = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  if ((pattern < uFade.x) == (uFade.y > 0.5)) discard;
}
#else
void leaveToTheOther() {}
#endif
