// Strips as the overlay shows them.
precision highp float;
out vec4 colour;
void main() {
  colour = gl_FrontFacing ? vec4(6.0, 0.3, 3.2, 1.0) : vec4(0.3, 2.0, 6.0, 1.0);
}
