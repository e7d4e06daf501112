// The ground. Vertices say what it is (material) and how water shaped it (ridge map); every pixel adds what a mesh of
// this size cannot carry: strata, stones, tufts, crumbling borders between covers.
in vec3 vRelative;
in vec3 vPlace;
centroid in vec3 vNormal;
centroid in float vRidge;
centroid in vec4 vCoverA;
centroid in vec3 vCoverB;
centroid in vec3 vRock;
out vec4 colour;
uniform sampler2D uNoise;
uniform sampler2D uStrataThick;
uniform sampler2D uStrataThin;
uniform vec3 uPalette[32];  // linear
uniform vec3 uSkyAbove;    // irradiance / pi on a level plane from the sky
uniform vec3 uSkyAround;   // the same on an upright one

// Texture tiles, metres; each divides kPlacePeriod of terrain_material.ts.
const float kTileFine = 4.0;
const float kTileStone = 32.0;
const float kTileBoulder = 256.0;
const float kTileHill = 2048.0;

struct Detail {
  vec3 bump;    // gradient of the relief, in the plane of the surface
  float shape;  // -1 .. 1
  float grain;  // 0 .. 1, billowy
};

// The two planes that face the surface best, after Inigo Quilez, "Biplanar mapping" (2020).
struct Planes {
  ivec3 major;
  ivec3 median;
  vec2 weight;
};

Planes planesOf(vec3 n) {
  vec3 a = abs(n);
  ivec3 major = (a.x > a.y && a.x > a.z) ? ivec3(0, 1, 2) : (a.y > a.z) ? ivec3(1, 2, 0) : ivec3(2, 0, 1);
  ivec3 minor = (a.x < a.y && a.x < a.z) ? ivec3(0, 1, 2) : (a.y < a.z) ? ivec3(1, 2, 0) : ivec3(2, 0, 1);
  ivec3 median = ivec3(3) - minor - major;
  vec2 weight = clamp((vec2(a[major.x], a[median.x]) - 0.5773) / (1.0 - 0.5773), 0.0, 1.0);
  weight = pow(weight, vec2(1.0 / 2.0)) + vec2(1e-3, 0.0);
  return Planes(major, median, weight / (weight.x + weight.y));
}

void addPlane(inout Detail detail, ivec3 axes, float weight, float tile, vec3 px, vec3 py) {
  vec2 at = vec2(vPlace[axes.y], vPlace[axes.z]) / tile;
  vec2 dx = vec2(px[axes.y], px[axes.z]) / tile;
  vec2 dy = vec2(py[axes.y], py[axes.z]) / tile;
  vec4 found = textureGrad(uNoise, at, dx, dy);
  vec3 bump = vec3(0.0);
  bump[axes.y] = found.g - 0.5;
  bump[axes.z] = found.b - 0.5;
  detail.bump += weight * bump;
  detail.shape += weight * (found.r * 2.0 - 1.0);
  detail.grain += weight * found.a;
}

Detail detailAt(Planes planes, float tile, vec3 px, vec3 py) {
  Detail detail = Detail(vec3(0.0), 0.0, 0.0);
  addPlane(detail, planes.major, planes.weight.x, tile, px, py);
  if (planes.weight.y > 0.02) addPlane(detail, planes.median, planes.weight.y, tile, px, py);
  return detail;
}

vec3 rockColour(float warp, float steep, Detail stone, Detail boulder) {
  float height = vPlace.y + warp;
  vec4 thick = texture(uStrataThick, vec2(height / 560.0, 0.5));
  vec4 thin = texture(uStrataThin, vec2((height + boulder.shape * 2.0) / 93.0, 0.5));
  // The layer's own rock gives the hue; the tables add beds that are thinner than a cell.
  vec3 tint = mix(vec3(1.0), thick.rgb * 2.0, 0.5) * mix(vec3(1.0), thin.rgb * 2.0, 0.40 + 0.35 * steep);
  float weathered = 0.66 + 0.52 * boulder.grain + 0.42 * stone.grain + 0.18 * stone.shape;
  // Water stains faces from above: streaks many times as high as wide.
  float along = abs(vNormal.x) > abs(vNormal.z) ? vPlace.z : vPlace.x;
  float stain = texture(uNoise, vec2(along / 64.0, vPlace.y / 1024.0)).a;
  weathered *= 1.0 - smoothstep(0.25, 0.6, steep) * 0.55 * smoothstep(0.38, 0.62, stain);
  return vRock * vec3(1.0, 1.0, 1.03) * tint * weathered;
}

vec3 grassColour(float damp, Detail fine, Detail stone, Detail boulder, Detail hill) {
  vec3 base = mix(uPalette[3], vec3(dot(uPalette[3], vec3(0.3, 0.6, 0.1))), 0.34);
  vec3 lush = base * vec3(0.86, 0.95, 0.74);
  vec3 dry = base * vec3(1.28, 1.08, 0.98);
  float patches = hill.shape * 1.1 + boulder.shape * 0.4 + stone.shape * 0.2 + fine.shape * 0.15;
  float dryness = clamp(0.44 + vPlace.y / 1700.0 + patches - damp * 0.5, 0.0, 1.0);
  vec3 blade = mix(lush, dry, dryness);
  // Scrub in the damp hollows: dark, mottled.
  float mottle = stone.grain * 0.45 + boulder.grain * 0.35 + fine.grain * 0.12;
  float scrub = smoothstep(0.46, 0.86, mottle + damp * 0.30 + hill.shape * 0.45 - vPlace.y / 4000.0);
  blade = mix(blade, base * vec3(0.58, 0.66, 0.52), scrub * 0.55);
  return blade * (0.72 + 0.40 * fine.grain + 0.18 * stone.grain + 0.12 * fine.shape);
}

void main() {
  leaveToTheOther();
  vec3 n = normalize(vNormal);
  float distance = length(vRelative);
  vec3 toEye = -vRelative / distance;
  vec3 px = dFdx(vPlace);
  vec3 py = dFdy(vPlace);
  Planes planes = planesOf(n);
  Detail fine = detailAt(planes, kTileFine, px, py);
  Detail stone = detailAt(planes, kTileStone, px, py);
  Detail boulder = detailAt(planes, kTileBoulder, px, py);
  // From afar its repetition would show.
  float near = 1.0 - smoothstep(1500.0, 6000.0, distance);
  boulder.bump *= 0.35 + 0.65 * near;
  boulder.shape *= 0.25 + 0.75 * near;
  boulder.grain = mix(0.4, boulder.grain, 0.25 + 0.75 * near);
  Detail hill = detailAt(Planes(ivec3(1, 2, 0), ivec3(0), vec2(1.0, 0.0)), kTileHill, px, py);

  // Covers crumble into one another: each competes with its own noise.
  float crumble = stone.shape * 0.55 + boulder.shape * 0.45 + fine.shape * 0.2;
  vec4 coverA = vCoverA;
  vec3 coverB = vCoverB;
  float steep = 1.0 - n.y;
  float damp = 1.0 - smoothstep(-0.95, 0.25, vRidge);
  float bare = smoothstep(0.24, 0.44, steep + crumble * 0.11 - damp * 0.03);
  coverA.x += bare * 1.2;
  coverA.yzw *= vec3(1.0 - 0.6 * bare, 1.0 - bare, 1.0 - bare);
  coverB *= vec3(1.0 - bare, 1.0 - smoothstep(0.36, 0.60, steep + crumble * 0.16), 1.0 - 0.5 * bare);
  coverA *= exp(vec4(1.0, 0.5, -0.5, -0.8) * crumble * 1.6);
  coverB *= exp(vec3(-0.4, -1.1, 0.3) * crumble * 1.6);
  coverA = coverA * coverA * coverA;
  coverB = coverB * coverB * coverB;
  float total = dot(coverA, vec4(1.0)) + dot(coverB, vec3(1.0)) + 1e-5;
  coverA /= total;
  coverB /= total;

  float warp = hill.shape * 70.0 + boulder.shape * 7.0 + stone.shape * 0.8;
  vec3 rock = rockColour(warp, steep, stone, boulder);
  vec3 scree = uPalette[1] * (0.62 + 0.62 * fine.grain + 0.18 * stone.shape) * mix(vec3(1.0), rock / max(uPalette[0], 0.05), 0.4);
  vec3 grass = grassColour(damp, fine, stone, boulder, hill);
  // Soil is never quite bare: withered stalks take its red away, more on gentle ground.
  vec3 earth = mix(uPalette[2], vec3(dot(uPalette[2], vec3(0.3, 0.6, 0.1))), 0.30);
  vec3 soil = mix(earth * (0.78 + 0.25 * stone.shape + 0.25 * fine.grain), grass, 0.42 * smoothstep(0.30, 0.05, steep));
  float wet = 1.0 - smoothstep(0.3, 2.2, vPlace.y + stone.shape * 0.8);
  vec3 sand = uPalette[4] * (0.90 + 0.05 * stone.shape + 0.05 * fine.shape) * mix(1.0, 0.52, wet);
  vec3 snow = uPalette[5] * (0.93 + 0.05 * boulder.shape);
  vec3 bed = uPalette[6] * (0.60 + 0.65 * fine.grain);
  vec3 albedo = rock * coverA.x + scree * coverA.y + soil * coverA.z + grass * coverA.w;
  albedo += sand * coverB.x + snow * coverB.y + bed * coverB.z;

  // Drainage: where water runs, pale debris lies in the creases of rock and the grass is greener.
  float streak = smoothstep(-0.72, -0.97, vRidge + boulder.shape * 0.10 + stone.shape * 0.06);
  float stony = coverA.x + coverA.y + coverA.z + coverB.z;
  albedo = mix(albedo, albedo * 0.6 + vec3(0.155, 0.145, 0.13), streak * stony * 0.75);
  albedo *= 0.92 + 0.16 * (hill.grain - 0.4) + 0.10 * boulder.shape;

  float rough = coverA.x * 1.5 + coverA.y * 1.0 + coverA.z * 0.6 + coverA.w * 0.6 + coverB.x * 0.10 + coverB.y * 0.13 + coverB.z * 0.8;
  vec3 bump = boulder.bump * 1.5 + stone.bump * 1.6 + fine.bump * 1.1 * (1.0 - smoothstep(20.0, 90.0, distance));
  // Wind lays dry sand in ripples: long across it, steep along it.
  vec2 across = vec2(0.6, -0.8);
  vec2 ripple = vec2(dot(vPlace.xz, vec2(0.8, 0.6)) / 5.12, dot(vPlace.xz, across) / 40.96);
  float rippled = coverB.x * (1.0 - wet) * (1.0 - smoothstep(15.0, 140.0, distance));
  bump += vec3(0.8, 0.0, 0.6) * ((texture(uNoise, ripple).g - 0.5) * 9.0 * rippled);
  bump -= n * dot(bump, n);
  vec3 bumped = normalize(n - bump * rough);

  // Grass stands up and lets light through: where the sun grazes, its bumps are not what decides between light and shade.
  float flatToSun = dot(n, uSunDirection);
  float toSun = mix(dot(bumped, uSunDirection), flatToSun * 0.8 + 0.2, 0.7 * coverA.w);
  float sun = max(toSun, 0.0) * smoothstep(-0.06, 0.10, flatToSun);
  if (sun > 0.0) sun *= sunReaching(vRelative, n);
  float hollow = mix(0.62, 1.0, smoothstep(-1.0, 0.1, vRidge)) * mix(0.82 + 0.18 * smoothstep(-0.5, 0.3, stone.shape + fine.shape * 0.5), 1.0, coverB.y);
  float upward = bumped.y * 0.5 + 0.5;
  vec3 ambient = mix(uSkyAround * 0.75, uSkyAbove, upward) * hollow;
  // Light off the sunlit ground around: warm, from below and the side.
  vec3 bounce = uSunIrradiance * 0.3183 * (0.055 + 0.075 * (1.0 - upward)) * vec3(1.0, 0.92, 0.78) * hollow;
  vec3 light = uSunIrradiance * (0.3183 * sun) + ambient + bounce;
  vec3 radiance = albedo * light;

  // Snow and wet sand answer the sun at grazing angles.
  vec3 halfway = normalize(toEye + uSunDirection);
  float sheen = pow(max(dot(bumped, halfway), 0.0), 24.0) * (0.10 * coverB.y + 0.22 * wet * coverB.x);
  radiance += uSunIrradiance * sheen * sun * 0.3183;

  // Below the sea the water takes over, and sea.frag adds the air in front of it. The margin is what depth may round. Far
  // away a pixel holds both sides of a shore, and one without its air would be a bright line: the sea's floor has it there.
  float submerged = vPlace.y > -0.05 - 2e-4 * distance ? 0.0 : 1.0 - smoothstep(1000.0, 4000.0, distance);
  if (submerged < 1.0) radiance = mix(throughAir(radiance, -toEye, distance, uEyeHeight), radiance, submerged);
  colour = vec4(radiance, 1.0);
}
