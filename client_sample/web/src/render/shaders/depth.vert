// A chunk as the sun sees it.
precision highp float;
in vec4 position;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;

void main() { gl_Position = projectionMatrix * (viewMatrix * (modelMatrix * vec4(position.xyz, 1.0))); }
