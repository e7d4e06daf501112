// The sky's radiance by direction, once at the start: x is the azimuth from the sun, y the root of the direction's
// height. Single scattering on a round planet, and a share for the light scattered more than once.
precision highp float;
in vec2 vScreen;
out vec4 colour;
uniform vec3 uSunDirection;
uniform float uSunPower;

const float kGround = 6360e3;
const float kTop = 6440e3;
const vec3 kRayleigh = vec3(5.8e-6, 13.5e-6, 33.1e-6);
const vec3 kOzone = vec3(0.65e-6, 1.88e-6, 0.085e-6);
const float kMie = 5.0e-6;
const float kForward = 0.78;
const float kManyTimes = 0.042;  // share of the sun's power in light scattered more than once, per steradian
const int kSteps = 40;
const int kLightSteps = 10;

float exitDistance(vec3 from, vec3 direction, float radius) {
  float b = dot(from, direction);
  return -b + sqrt(max(b * b - dot(from, from) + radius * radius, 0.0));
}

vec3 densities(float height) {
  float ozone = max(0.0, 1.0 - abs(height - 25e3) / 15e3);
  return vec3(exp(-height / 8000.0), exp(-height / 1200.0), ozone);
}

vec3 extinction(vec3 depth) { return exp(-(kRayleigh * depth.x + kMie * 1.11 * depth.y + kOzone * depth.z)); }

vec3 sunLightAt(vec3 at) {
  float span = exitDistance(at, uSunDirection, kTop) / float(kLightSteps);
  vec3 depth = vec3(0.0);
  for (int i = 0; i < kLightSteps; ++i) {
    depth += span * densities(length(at + uSunDirection * span * (float(i) + 0.5)) - kGround);
  }
  return extinction(depth);
}

void main() {
  float up = vScreen.y * vScreen.y;
  float azimuth = vScreen.x * 3.14159265;
  vec2 sun = normalize(uSunDirection.xz);
  vec2 level = sun * cos(azimuth) + vec2(-sun.y, sun.x) * sin(azimuth);
  vec3 direction = vec3(level.x * sqrt(1.0 - up * up), up, level.y * sqrt(1.0 - up * up));

  vec3 eye = vec3(0.0, kGround + 300.0, 0.0);
  float reach = exitDistance(eye, direction, kTop);
  float mu = dot(direction, uSunDirection);
  float rayleighPhase = 0.0596831 * (1.0 + mu * mu);
  float g2 = kForward * kForward;
  float miePhase = 0.1193662 * (1.0 - g2) * (1.0 + mu * mu) / ((2.0 + g2) * pow(1.0 + g2 - 2.0 * kForward * mu, 1.5));
  vec3 depth = vec3(0.0);
  vec3 light = vec3(0.0);
  float walked = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // Steps grow with distance: most of the air is near.
    float next = reach * pow(float(i + 1) / float(kSteps), 2.0);
    float span = next - walked;
    vec3 at = eye + direction * (walked + 0.5 * span);
    vec3 density = densities(length(at) - kGround);
    vec3 through = extinction(depth + 0.5 * span * density);
    vec3 sunLight = sunLightAt(at);
    light += span * through * sunLight * (kRayleigh * density.x * rayleighPhase + kMie * density.y * miePhase);
    // Light scattered before comes from everywhere and is spent more slowly: it keeps the horizon pale and blue.
    light += span * sqrt(through) * kManyTimes * (kRayleigh * density.x * vec3(0.84, 0.96, 1.10) + kMie * density.y);
    depth += span * density;
    walked = next;
  }
  colour = vec4(light * uSunPower, 1.0);
}
