// Chunks arrive in lattice steps; the model matrix scales them to metres and places them relative to the camera, so
// that no large number ever reaches the GPU.
precision highp float;
precision highp int;
in vec4 position;  // xyz: steps; w: material
in vec4 normal;    // xyz: unit normal; w: ridge map, -1 .. 1
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 uCameraPlace;  // xz: camera modulo the texture period; y: height above the sea
uniform vec3 uPalette[32];  // linear
out vec3 vRelative;
out vec3 vPlace;
// Where a triangle covers samples of a pixel but not its middle, these are taken inside it: continued beyond its edge,
// thin triangles far away would have colours below black.
centroid out vec3 vNormal;
centroid out float vRidge;
centroid out vec4 vCoverA;  // rock, scree, soil, grass
centroid out vec3 vCoverB;  // sand, snow, stream bed
centroid out vec3 vRock;    // the layer's colour

void main() {
  vec4 relative = modelMatrix * vec4(position.xyz, 1.0);
  vRelative = relative.xyz;
  vPlace = relative.xyz + uCameraPlace;
  vNormal = normal.xyz;
  vRidge = normal.w;
  float material = position.w;
  vCoverA = vec4(equal(vec4(material), vec4(0.0, 1.0, 2.0, 3.0)));
  vCoverB = vec3(equal(vec3(material), vec3(4.0, 5.0, 6.0)));
  bool isRock = material > 6.5;
  if (isRock) vCoverA.x = 1.0;
  vRock = uPalette[isRock ? min(int(material + 0.5), 31) : 0];
  gl_Position = projectionMatrix * (viewMatrix * relative);
}
