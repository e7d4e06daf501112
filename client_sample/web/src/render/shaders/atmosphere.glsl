// Light in the air, shared by everything that is seen through it. Distances in metres, y = height above the sea.
uniform sampler2D uSky;       // radiance by direction: sky_table.frag
uniform vec3 uSunDirection;   // towards the sun
uniform vec3 uSunIrradiance;  // at the ground, after the air
uniform float uEyeHeight;     // of the camera, above the sea
uniform float uFar;           // nothing is drawn beyond

const float kRayleighHeight = 8000.0;
const float kHazeHeight = 1100.0;
const vec3 kRayleigh = vec3(5.8e-6, 13.5e-6, 33.1e-6);
const float kHaze = 1.9e-5;

vec2 skyTablePlace(vec3 direction) {
  float azimuth = acos(clamp(dot(normalize(direction.xz + 1e-6), normalize(uSunDirection.xz)), -1.0, 1.0));
  return vec2(azimuth / 3.14159265, sqrt(clamp(direction.y, 0.0, 1.0)));
}

vec3 skyRadiance(vec3 direction) { return texture(uSky, skyTablePlace(direction)).rgb; }

// Mean density along a ray from height `y`, relative to the ground, for an exponential atmosphere.
float meanDensity(float y, float rise, float scaleHeight) {
  float k = rise / scaleHeight;
  float along = abs(k) < 1e-3 ? 1.0 - 0.5 * k : (1.0 - exp(-k)) / k;
  return exp(-max(y, 0.0) / scaleHeight) * along;
}

// What is left of `radiance` after `distance` of air, and what the air adds. Towards uFar everything goes over into the
// air, so that the world has no edge.
vec3 throughAir(vec3 radiance, vec3 direction, float distance, float eyeHeight) {
  float rise = max(direction.y * distance, -eyeHeight);
  vec3 depth = kRayleigh * (1.25 * distance * meanDensity(eyeHeight, rise, kRayleighHeight));
  depth += kHaze * distance * meanDensity(eyeHeight, rise, kHazeHeight);
  vec3 transmittance = exp(-depth);
  float reach = distance / uFar;
  transmittance *= exp(-3.0 * reach * reach * reach * reach) * (1.0 - smoothstep(0.85, 0.995, reach));
  vec3 level = normalize(vec3(direction.x, max(direction.y, 0.012), direction.z));
  // Looking down there is less of the bright horizon's light on the way.
  float down = 1.0 - 0.5 * smoothstep(0.05, 0.9, -direction.y);
  return radiance * transmittance + skyRadiance(level) * (down * (1.0 - transmittance));
}
