// Strips as the overlay shows them.
precision highp float;
out vec4 colour;
void main() {
  colour = vec4(6.0, 0.3, 3.2, 1.0);
}
