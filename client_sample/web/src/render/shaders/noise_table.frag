// The one texture of the terrain and the sea, made once at the start; it repeats without a seam. r: fractal noise,
// gb: its gradient, a: a second, more billowy noise.
precision highp float;
precision highp int;
in vec2 vScreen;
out vec4 colour;

uint mixBits(uint h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

vec2 latticeGradient(ivec2 at, int period, uint seed) {
  ivec2 wrapped = ((at % period) + period) % period;
  uint h = mixBits(uint(wrapped.x) + 4096u * uint(wrapped.y) + 16777216u * seed);
  float turn = float(h & 0xffffu) * (6.2831853 / 65536.0);
  return vec2(cos(turn), sin(turn));
}

float gradientNoise(vec2 p, int period, uint seed) {
  ivec2 cell = ivec2(floor(p));
  vec2 f = p - vec2(cell);
  vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  float a = dot(latticeGradient(cell, period, seed), f);
  float b = dot(latticeGradient(cell + ivec2(1, 0), period, seed), f - vec2(1, 0));
  float c = dot(latticeGradient(cell + ivec2(0, 1), period, seed), f - vec2(0, 1));
  float d = dot(latticeGradient(cell + ivec2(1, 1), period, seed), f - vec2(1, 1));
  return mix(mix(a, b, u.x), mix(c, d, u.x), u.y);
}

float fractal(vec2 p, uint seed) {
  float sum = 0.0;
  float strength = 0.5;
  int period = 4;
  for (int i = 0; i < 6; ++i) {
    sum += strength * gradientNoise(p * float(period), period, seed + uint(i));
    period *= 2;
    strength *= 0.56;
  }
  return sum;
}

float billow(vec2 p) {
  float sum = 0.0;
  float strength = 0.5;
  int period = 5;
  for (int i = 0; i < 6; ++i) {
    sum += strength * abs(gradientNoise(p * float(period), period, 40u + uint(i)));
    period *= 2;
    strength *= 0.6;
  }
  return sum;
}

void main() {
  const float kStep = 1.0 / 512.0;
  float here = fractal(vScreen, 1u);
  float right = fractal(vScreen + vec2(kStep, 0.0), 1u);
  float beyond = fractal(vScreen + vec2(0.0, kStep), 1u);
  vec2 gradient = vec2(right - here, beyond - here) / kStep;
  colour = vec4(0.5 + 0.85 * here, 0.5 + gradient * 0.06, 1.35 * billow(vScreen));
}
