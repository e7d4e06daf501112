// The last pass: what was drawn, the sea in front of it, and the tone curve.
//
// The sea is not a mesh: each pixel meets the plane y = 0 analytically and compares distances with the depth buffer.
// So it has no edge, no seams, and nothing to fight with at any distance.
in vec2 vScreen;
out vec4 colour;
uniform sampler2D uScene;
uniform highp sampler2D uDepth;
uniform sampler2D uNoise;
uniform mat3 uCameraAxes;
uniform vec2 uTanHalf;
uniform vec2 uDepthLine;  // projectionMatrix[2][2], [3][2]
uniform float uDepthReversed;
uniform vec3 uCameraPlace;
uniform vec3 uSkyAbove;
uniform float uTime;
uniform float uExposure;

const vec3 kAbsorbed = vec3(0.36, 0.085, 0.062);  // per metre of coastal water
const vec3 kWhite = vec3(0.97, 1.0, 1.045);  // the eye has got used to a low sun
const float kNothing = 1e9;

// Distance along the unit of `ray` (whose z is -1 in camera space) to what was drawn there.
float drawnDistance(vec2 at, float rayLength) {
  float depth = texture(uDepth, at).r;
  if (uDepthReversed > 0.5 ? depth <= 0.0 : depth >= 1.0) return kNothing;
  float clip = uDepthReversed > 0.5 ? depth : depth * 2.0 - 1.0;
  return uDepthLine.y / (clip + uDepthLine.x) * rayLength;
}

vec2 waveSlope(vec2 at, float distance) {
  vec2 wind = vec2(0.83, 0.56);
  vec2 slope = (texture(uNoise, at / 64.0 + wind * uTime * 0.021).gb - 0.5) * 0.30;
  // Turned against each other, so that no row of crests repeats; both tiles still divide the place's period.
  const mat2 turn = mat2(0.8, 0.6, -0.6, 0.8);
  slope += (texture(uNoise, turn * at / 25.6 - wind * uTime * 0.037).bg - 0.5) * 0.32;
  slope += (texture(uNoise, at * turn / 10.24 - wind.yx * uTime * 0.06).gb - 0.5) * 0.34 * (1.0 - smoothstep(80.0, 500.0, distance));
  slope += (texture(uNoise, at / 512.0 + wind * uTime * 0.004).gb - 0.5) * 0.12;
  return slope;
}

vec3 seaRadiance(vec3 direction, float distance, float floorDistance) {
  vec2 at = uCameraPlace.xz + direction.xz * distance;
  vec2 slope = waveSlope(at, distance);
  float calm = 1.0 - smoothstep(200.0, 9000.0, distance) * 0.65;
  vec3 normal = normalize(vec3(-slope.x * calm, 1.0, -slope.y * calm));
  float facing = max(dot(normal, -direction), 0.02);
  const float kSlope = 0.20;  // of waves too small to draw
  float fresnel = 0.02 + 0.98 * pow(1.0 - facing, 5.0 * exp(-2.69 * kSlope)) / (1.0 + 22.7 * pow(kSlope, 1.5));

  // What lies below, seen through the surface. The bent ray is steeper than the straight one.
  float through = floorDistance - distance;
  float depth = min(-direction.y * through, 400.0);
  vec2 bent = vScreen + slope * 0.05 * smoothstep(0.0, 4.0, depth) / (1.0 + distance * 0.02);
  vec3 below = texture(uScene, clamp(bent, 0.001, 0.999)).rgb;
  float downward = sqrt(1.0 - (1.0 - direction.y * direction.y) / 1.777);
  vec3 clear = exp(-kAbsorbed * depth * (1.0 / downward + 1.15));
  vec3 skyLight = uSkyAbove + uSunIrradiance * 0.3183 * uSunDirection.y;
  vec3 deep = skyLight * mix(vec3(0.010, 0.040, 0.060), vec3(0.030, 0.125, 0.125), exp(-depth * 0.09));
  vec3 body = mix(deep, below, floorDistance < kNothing * 0.5 ? clear : vec3(0.0));

  vec3 mirrored = reflect(direction, normal);
  mirrored.y = abs(mirrored.y) + 0.06;
  vec3 reflection = skyRadiance(normalize(mirrored));
  vec3 halfway = normalize(uSunDirection - direction);
  float roughness = mix(0.05, 0.17, smoothstep(30.0, 4000.0, distance));
  float lobe = max(dot(normal, halfway), 0.0);
  float a2 = roughness * roughness;
  float spread = a2 / (3.1416 * pow(lobe * lobe * (a2 - 1.0) + 1.0, 2.0));
  vec3 glint = uSunIrradiance * min(spread * 0.012 / max(facing, 0.15), 2.2);
  vec3 radiance = mix(body, reflection, fresnel) + glint * (0.35 + fresnel);

  // Foam along the shore: two lines that come and go, torn by noise.
  float torn = texture(uNoise, at / 16.0 + uTime * 0.011).a + texture(uNoise, at / 64.0 - uTime * 0.006).r - 0.62;
  float swash = depth + 0.55 * sin(uTime * 0.55 + texture(uNoise, at / 128.0).r * 12.0);
  float foam = smoothstep(1.6, 0.1, swash) * smoothstep(0.05, 0.55, torn);
  foam += smoothstep(0.7, 0.0, abs(swash - 3.2)) * smoothstep(0.35, 0.8, torn) * 0.45;
  foam *= 1.0 - smoothstep(600.0, 3500.0, distance);
  return mix(radiance, (skyLight) * 0.62, clamp(foam, 0.0, 0.85));
}

// AgX, after Troy Sobotka; the polynomial is Benjamin Wrensch's fit (2023). A little more contrast and saturation.
vec3 toneCurve(vec3 radiance) {
  const mat3 kInto = mat3(0.842479, 0.0423283, 0.0423756, 0.0784336, 0.878469, 0.0784336, 0.0792237, 0.0791661, 0.879142);
  const mat3 kOut = mat3(1.19688, -0.0528969, -0.0529716, -0.0980209, 1.15190, -0.0980435, -0.0990297, -0.0989612, 1.15107);
  vec3 v = clamp((log2(max(kInto * radiance, 1e-10)) + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
  vec3 v2 = v * v;
  vec3 v4 = v2 * v2;
  v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v - 0.00232;
  float luma = dot(v, vec3(0.2126, 0.7152, 0.0722));
  v = luma + (v - luma) * 1.30;
  v = pow(max(v, 0.0), vec3(1.20));
  return clamp(kOut * v, 0.0, 1.0);
}

void main() {
  vec3 ray = vec3((vScreen * 2.0 - 1.0) * uTanHalf, -1.0);
  float rayLength = length(ray);
  vec3 direction = uCameraAxes * (ray / rayLength);
  float floorDistance = drawnDistance(vScreen, rayLength);
  vec3 radiance = texture(uScene, vScreen).rgb;
  if (uEyeHeight > 0.0) {
    float surface = direction.y < -1e-5 ? -uEyeHeight / direction.y : kNothing;
    if (surface < floorDistance) {
      radiance = surface < uFar ? seaRadiance(direction, surface, floorDistance) : vec3(0.0);
      radiance = throughAir(radiance, direction, surface, uEyeHeight);
    }
  } else {
    // Under the surface: the water's own light by depth.
    float path = min(floorDistance, direction.y > 0.0 ? -uEyeHeight / direction.y : floorDistance);
    vec3 water = (uSkyAbove + uSunIrradiance * 0.1) * vec3(0.02, 0.10, 0.12) * exp(uEyeHeight * 0.04);
    radiance = mix(water, radiance, exp(-kAbsorbed * min(path, 500.0)));
  }
  vec3 shown = toneCurve(radiance * kWhite * uExposure);
  // A grain below one step of the screen hides the bands of smooth skies.
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  // AgX's polynomial ends in display light (gamma 2.2).
  colour = vec4(shown + grain / 255.0, 1.0);
}
