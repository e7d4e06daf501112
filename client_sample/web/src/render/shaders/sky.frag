// The sky behind everything: the table, the sun and a thin deck of fair-weather clouds.
in vec2 vScreen;
out vec4 colour;
uniform mat3 uCameraAxes;
uniform vec2 uTanHalf;
uniform sampler2D uNoise;
uniform vec2 uCloudShift;

float cloudCover(vec2 at) {
  float shape = texture(uNoise, at * 0.13).a * 0.62 + texture(uNoise, at * 0.41 + 0.3).r * 0.28;
  return shape + texture(uNoise, at * 1.57 + 0.7).r * 0.12;
}

void main() {
  vec3 direction = normalize(uCameraAxes * vec3((vScreen * 2.0 - 1.0) * uTanHalf, -1.0));
  vec3 radiance = skyRadiance(direction);
  float mu = dot(direction, uSunDirection);
  vec3 glow = uSunIrradiance * (0.020 * pow(max(mu, 0.0), 180.0) + 0.10 * pow(max(mu, 0.0), 2600.0));
  float disc = smoothstep(0.99993, 0.99997, mu);

  float above = max(direction.y, 0.0);
  vec2 at = direction.xz / (above + 0.10) + uCloudShift;
  float here = cloudCover(at);
  float thick = smoothstep(0.50, 0.78, here) * smoothstep(0.015, 0.22, above);
  // A second look towards the sun tells the lit edge from the shaded belly.
  float shade = clamp((cloudCover(at + normalize(uSunDirection.xz) * 0.10) - here) * 3.0 + 0.25, 0.0, 1.0);
  vec3 lit = uSunIrradiance * (0.20 + 0.30 * pow(max(mu, 0.0), 8.0)) + skyRadiance(vec3(0.0, 1.0, 0.0)) * 0.6;
  vec3 cloud = mix(lit, lit * vec3(0.58, 0.63, 0.72), shade);
  cloud = mix(radiance, cloud, smoothstep(0.02, 0.35, above));
  radiance = mix(radiance + glow + disc * uSunIrradiance * 12.0, cloud + glow * 0.6, thick * 0.72);
  colour = vec4(min(radiance, vec3(400.0)), 1.0);
}
