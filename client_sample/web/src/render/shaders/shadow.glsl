// Sunlight that reaches a point: three maps around the camera, each drawn anew only when it must be.
uniform highp sampler2DShadow uShadow0;
uniform highp sampler2DShadow uShadow1;
uniform highp sampler2DShadow uShadow2;
uniform mat4 uShadowPlace[3];  // camera-relative metres -> map, depth 0 near the sun
uniform vec3 uShadowTexel;     // metres per texel
uniform float uShadowReversed;

float shadowTap(highp sampler2DShadow map, vec3 at) {
  return texture(map, vec3(at.xy, mix(at.z, 1.0 - at.z, uShadowReversed)));
}

float shadowSoft(highp sampler2DShadow map, vec3 at, float texel) {
  float sum = shadowTap(map, at);
  sum += shadowTap(map, at + vec3(texel, 0.4 * texel, 0.0)) + shadowTap(map, at + vec3(-0.4 * texel, texel, 0.0));
  sum += shadowTap(map, at + vec3(-texel, -0.4 * texel, 0.0)) + shadowTap(map, at + vec3(0.4 * texel, -texel, 0.0));
  return sum * 0.2;
}

bool inside(vec3 at) { return all(greaterThan(at, vec3(0.01))) && all(lessThan(at, vec3(0.99))); }

float sunReaching(vec3 relative, vec3 normal) {
  const float kSpread = 1.3 / 2048.0;
  float lean = 1.0 + 1.5 * (1.0 - clamp(dot(normal, uSunDirection), 0.0, 1.0));
  vec3 at = (uShadowPlace[0] * vec4(relative + normal * uShadowTexel.x * lean, 1.0)).xyz;
  if (inside(at)) return shadowSoft(uShadow0, at, kSpread);
  at = (uShadowPlace[1] * vec4(relative + normal * uShadowTexel.y * lean, 1.0)).xyz;
  if (inside(at)) return shadowSoft(uShadow1, at, kSpread);
  at = (uShadowPlace[2] * vec4(relative + normal * uShadowTexel.z * lean, 1.0)).xyz;
  if (inside(at)) return shadowSoft(uShadow2, at, kSpread);
  return 1.0;
}
